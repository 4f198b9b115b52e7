#include "tests/evaluation/report/report_text.h"

#include <cstdarg>
#include <cstdio>
#include <sstream>

namespace framelet::bench {

namespace {

constexpr std::size_t most_columns = 120;

bool is_prose(std::string const& line) {
    return !line.empty() && line.find_first_of("|#!") != 0 && !line.starts_with("    ");
}

} // namespace

std::string printed(char const* format, ...) {
    char text[512];
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(text, sizeof(text), format, arguments);
    va_end(arguments);
    return text;
}

std::string bold_if(bool is_bold, std::string const& text) {
    return is_bold ? "**" + text + "**" : text;
}

std::string wrapped(std::string const& page) {
    std::string text;
    std::size_t column = 0; // in a paragraph; 0: outside
    std::istringstream lines(page);
    for (std::string line; std::getline(lines, line);) {
        if (!is_prose(line)) {
            text += (column > 0 ? "\n" : "") + line + "\n";
            column = 0;
            continue;
        }
        std::istringstream words(line);
        for (std::string word; words >> word;) {
            bool const fits = column > 0 && column + 1 + word.size() <= most_columns;
            text += (fits ? " " : column > 0 ? "\n" : "") + word;
            column = fits ? column + 1 + word.size() : word.size();
        }
    }
    return text + (column > 0 ? "\n" : "");
}

bool is_rival(std::string const& method) {
    return !method.starts_with("framelet");
}

} // namespace framelet::bench
