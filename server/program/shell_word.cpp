#include "server/program/shell_word.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <string_view>

namespace framelet {
namespace {

bool is_plain(unsigned char c) {
    constexpr std::string_view others = "_-./+:,@%=";
    return c >= 0x80 || std::isalnum(c) != 0 || others.find(static_cast<char>(c)) != others.npos;
}

bool is_control(unsigned char c) {
    return c < 0x20 || c == 0x7f;
}

} // namespace

std::string shell_word(std::string const& text) {
    if (!text.empty() && std::ranges::all_of(text, is_plain)) {
        return text;
    }
    bool const has_controls = std::ranges::any_of(text, is_control);
    std::string word = has_controls ? "$'" : "'";
    for (char const c : text) {
        if (is_control(static_cast<unsigned char>(c))) {
            std::array<char, 8> escape{};
            std::snprintf(escape.data(), escape.size(), "\\%03o", static_cast<unsigned>(c)); // octal ends by itself
            word += escape.data();
        } else if (has_controls && (c == '\'' || c == '\\')) {
            word += std::string("\\") + c;
        } else if (c == '\'') {
            word += "'\\''";
        } else {
            word += c;
        }
    }
    return word + "'";
}

} // namespace framelet
