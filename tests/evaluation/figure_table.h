// Prints figures that a verb returns as a table on stdout: a column says where in a row's JSON its figure is, and how
// it is printed.
#pragma once

#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace framelet::bench {

struct Column {
    char const* title;
    char const* figure; ///< JSON pointer within the row; where nothing is there, a dash is printed
    int width; ///< least width, characters; < 0: text, aligned to the left
    int digits = 2; ///< digits after the point
    double scale = 1; ///< factor on the figure before it is printed
    bool scientific = false;
};

class FigureTable {
public:
    /// Prints the titles.
    explicit FigureTable(std::vector<Column> columns);

    void print(nlohmann::json const& row) const;

private:
    std::vector<Column> const columns_;
};

} // namespace framelet::bench
