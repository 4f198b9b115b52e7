// Numbers on a command line. CLI11's own range lets "nan" through, which is neither below nor above anything.
#pragma once

#include <sstream>
#include <string>
#include <type_traits>

#include <CLI/Validators.hpp>

namespace framelet {

/// Accepts a number in [low, high], so neither NaN nor infinity; a whole number where the bounds are of an integral
/// type.
template <typename T>
CLI::Validator number_in(T low, T high) {
    std::ostringstream range;
    range.precision(10);
    range << low << " to " << high;
    return {[low, high, text = range.str()](std::string& input) {
                T value{};
                bool const good = CLI::detail::lexical_cast(input, value) && value >= low && value <= high;
                char const* const kind =
                    std::is_integral_v<T> ? "' is not a whole number from " : "' is not a number from ";
                return good ? std::string() : "'" + input + kind + text;
            },
            range.str()};
}

} // namespace framelet
