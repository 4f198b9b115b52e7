// Numbers of things in sentences for people.
#pragma once

#include <cstddef>
#include <string>

namespace framelet {

/// A number and a word in the right form: "1 camera", "2 cameras", "0 cameras"; digits in groups of three, as in
/// "1,234,567 triangles". `plural` is for a word whose plural is not the word with an s.
inline std::string counted(std::size_t number, std::string const& word, std::string const& plural = "") {
    std::string digits = std::to_string(number);
    for (std::size_t i = digits.size(); i > 3; i -= 3) {
        digits.insert(i - 3, ",");
    }
    return digits + " " + (number == 1 ? word : plural.empty() ? word + "s" : plural);
}

} // namespace framelet
