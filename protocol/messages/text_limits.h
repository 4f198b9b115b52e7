// How long texts on the wire may be, which are UTF-8 on one line (`common/one_line.h`).
#pragma once

#include <cstddef>

namespace framelet {

inline constexpr std::size_t max_name_bytes = 1024;
inline constexpr std::size_t max_token_bytes = 4096;
inline constexpr std::size_t max_failure_bytes = 4096;

} // namespace framelet
