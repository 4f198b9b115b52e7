// Numbers on a command line. CLI11's own range lets "nan" through, which is neither below nor above anything.
#pragma once

#include <sstream>
#include <string>

#include <CLI/Validators.hpp>

namespace framelet {

/// A number of [low, high]; neither NaN nor, so, infinite.
inline CLI::Validator number_in(double low, double high) {
    std::ostringstream range;
    range << "[" << low << " - " << high << "]";
    return {[low, high, text = range.str()](std::string& input) {
                double value = 0;
                bool const good = CLI::detail::lexical_cast(input, value) && value >= low && value <= high;
                return good ? std::string() : "Value " + input + " is not a number in " + text;
            },
            "NUMBER in " + range.str()};
}

} // namespace framelet
