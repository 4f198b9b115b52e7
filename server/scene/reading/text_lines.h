// Takes text files apart: lines, words, numbers. In: text. Out: parts of it, without copies. Line ends may be of any
// system, numbers are read as in "C", whatever the locale.
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string_view>

namespace framelet {

inline constexpr std::string_view blanks = " \t\v\f\r";

inline std::string_view trimmed(std::string_view text) {
    std::size_t const first = text.find_first_not_of(blanks);
    return first == text.npos ? std::string_view() : text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/// Takes the first word off the text, which is trimmed then.
inline std::string_view take_word(std::string_view& text) {
    text = trimmed(text);
    std::size_t const end = std::min(text.find_first_of(blanks), text.size());
    std::string_view const word = text.substr(0, end);
    text = trimmed(text.substr(end));
    return word;
}

/// The word as a number, which may be "nan" or "inf".
inline std::optional<double> any_number_of(std::string_view word) {
    double value = 0;
    word.remove_prefix(word.starts_with('+') ? 1 : 0);
    auto const [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    return error == std::errc() && end == word.data() + word.size() ? std::optional(value) : std::nullopt;
}

/// The word as a finite number.
inline std::optional<double> number_of(std::string_view word) {
    std::optional<double> const number = any_number_of(word);
    return number && std::isfinite(*number) ? number : std::nullopt;
}

/// Takes numbers off the text, as many as it begins with and `out` has room for; returns how many.
template <class Numbers>
std::size_t take_numbers(std::string_view& text, Numbers& out) {
    std::size_t count = 0;
    while (count < std::size(out)) {
        std::string_view rest = text;
        std::optional<double> const number = number_of(take_word(rest));
        if (!number) {
            break;
        }
        out[count++] = *number;
        text = rest;
    }
    return count;
}

/// The lines of a text, one after the other.
class TextLines {
public:
    explicit TextLines(std::string_view text) : rest_(text.starts_with("\xef\xbb\xbf") ? text.substr(3) : text) {}

    /// Puts the next line into `line`, trimmed; false at the end.
    bool next(std::string_view& line) {
        if (rest_.empty()) {
            return false;
        }
        std::size_t const end = std::min(rest_.find_first_of("\n\r"), rest_.size());
        line = trimmed(rest_.substr(0, end));
        bool const two = rest_.substr(end).starts_with("\r\n");
        rest_.remove_prefix(std::min(end + (two ? 2 : 1), rest_.size()));
        ++number_;
        return true;
    }
    std::size_t number() const { return number_; } ///< of the line read last, from 1
    std::string_view rest() const { return rest_; } ///< what has not been read

private:
    std::string_view rest_;
    std::size_t number_ = 0;
};

} // namespace framelet
