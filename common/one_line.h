// Text that is UTF-8 on one line: no control characters, so that what a peer says and how a file is called can be shown
// in a terminal or a log as it is. In: any bytes. Out: whether they are such text, or the nearest that is.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace framelet {

/// True for well-formed UTF-8 ([RFC 3629]) without control characters (U+0000..001F, U+007F..009F).
bool is_one_line(std::string_view text);

/// `text` with every byte that is not part of such text replaced by '?', cut to at most `max_bytes` between characters.
std::string to_one_line(std::string_view text, std::size_t max_bytes = std::string_view::npos);

} // namespace framelet
