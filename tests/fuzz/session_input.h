// The form of what fuzz_session takes: fuzz_seeds writes it, the target reads it. One byte, what the server asks for;
// then what is said, each message behind two bytes, the lower first: its length, where 0 means that nothing is said,
// and what happens before it. For fuzz targets only.
#pragma once

#include <cstdint>

namespace framelet::session_input {

/// Bits of the first byte.
inline constexpr unsigned asks_for_token = 1, has_control_token = 2, shares_control = 4;

/// Bits of the two bytes in front of a message.
inline constexpr unsigned length_bits = 0x1fff;
inline constexpr unsigned is_repeated = 0x2000; ///< what was said over the connection is said over many more, at once
inline constexpr unsigned is_cut = 0x4000; ///< the connection is cut
inline constexpr unsigned connects = 0x8000; ///< another one is opened, over which all that follows is said

/// What the server's tokens are, where it has any.
inline constexpr char token[] = "a token for all to see";
inline constexpr char control_token[] = "a token for the few who may";

} // namespace framelet::session_input
