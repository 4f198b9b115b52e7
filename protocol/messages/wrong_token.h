// The words of a Failure by which a viewer knows that it is the token that is to be given, or given anew.
#pragma once

namespace framelet {

inline constexpr char const* wrong_token_text = "wrong or missing token";

} // namespace framelet
