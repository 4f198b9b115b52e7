#include "tests/evaluation/figure_table.h"

#include <cstdio>

#include <nlohmann/json.hpp>

namespace framelet::bench {

FigureTable::FigureTable(std::vector<Column> columns) : columns_(std::move(columns)) {
    for (Column const& column : columns_) {
        std::printf("%*s ", column.width, column.title);
    }
    std::printf("\n");
}

void FigureTable::print(nlohmann::json const& row) const {
    for (Column const& column : columns_) {
        nlohmann::json const figure = row.value(nlohmann::json::json_pointer(column.figure), nlohmann::json());
        if (figure.is_number()) {
            std::printf(column.scientific ? "%*.*e " : "%*.*f ", column.width, column.digits,
                        column.scale * figure.get<double>());
        } else {
            std::printf("%*s ", column.width, figure.is_string() ? figure.get<std::string>().c_str() : "-");
        }
    }
    std::printf("\n");
    std::fflush(stdout); // a reader of a pipe sees the table grow
}

} // namespace framelet::bench
