// Helpers that the report's tables and charts share: the setting of text, and who is a rival.
#pragma once

#include <string>

namespace framelet::bench {

/// Mean squared errors below this are due to rounding to bytes.
inline constexpr double least_mse = 1e-9;

[[gnu::format(printf, 1, 2)]] std::string printed(char const* format, ...);

/// The text in bold, or as it is.
std::string bold_if(bool is_bold, std::string const& text);

/// The Markdown page with the lines of each paragraph filled up to 120 characters; tables, headings, pictures and code
/// stay as they are.
std::string wrapped(std::string const& page);

/// True if the method is not the project's.
bool is_rival(std::string const& method);

} // namespace framelet::bench
