// Text on the wire is UTF-8 on one line: no control characters, so that a peer's words can be shown in a terminal or a
// log as they are. In: any bytes. Out: whether they are such text, or the nearest that is.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace framelet {

inline constexpr std::size_t max_name_bytes = 1024;
inline constexpr std::size_t max_token_bytes = 4096;
inline constexpr std::size_t max_failure_bytes = 4096;

/// True for well-formed UTF-8 ([RFC 3629]) without control characters (U+0000..001F, U+007F..009F).
bool is_one_line(std::string_view text);

/// `text` with every byte that is not part of such text replaced by '?', cut to at most `max_bytes` between characters.
std::string to_one_line(std::string_view text, std::size_t max_bytes);

} // namespace framelet
