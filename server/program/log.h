// The server's log on standard error: text for people, or JSON for programs that collect logs.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <spdlog/common.h>

namespace framelet {

enum class LogFormat : std::uint8_t { text, json };

/// Reads `text` or `json`. Throws InputError of anything else.
LogFormat parse_log_format(std::string const& text);

/// A line of the log as one JSON object, with its end of line: "time" (ISO 8601, UTC), "level", "message". Bytes that
/// are no UTF-8 are replaced.
std::string json_log_line(spdlog::log_clock::time_point time, std::string_view level, std::string_view message);

/// From now on what is logged is printed so; `quiet`: warnings and errors alone.
void open_log(LogFormat format, bool quiet);

/// Prints why the program ends: the line that everybody looks for, and the last one. The log need not be open.
void log_end(LogFormat format, std::string_view why);

} // namespace framelet
