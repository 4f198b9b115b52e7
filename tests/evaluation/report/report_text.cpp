#include "tests/evaluation/report/report_text.h"

#include <cstdarg>
#include <cstdio>

namespace framelet::bench {

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

bool is_rival(std::string const& method) {
    return !method.starts_with("framelet") && method != "oracle";
}

} // namespace framelet::bench
