// Says which lines of a text file could not be read. In: lines. Out: one warning each, of many the first.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace framelet {

class LineRemarks {
public:
    /// `name` of the file; warnings go to `warnings`.
    LineRemarks(std::string name, std::vector<std::string>& warnings) : name_(std::move(name)), warnings_(warnings) {}
    LineRemarks(LineRemarks const&) = delete;
    LineRemarks& operator=(LineRemarks const&) = delete;
    ~LineRemarks() {
        if (count_ > most) {
            warnings_.push_back(name_ + ": " + std::to_string(count_ - most) + " more such lines");
        }
    }

    /// "NAME, PLACE: WHAT; passed over".
    void add(std::string const& place, std::string_view what) {
        if (++count_ <= most) {
            warnings_.push_back(name_ + ", " + place + ": " + std::string(what) + "; passed over");
        }
    }
    void add(std::size_t line, std::string_view what) { add("line " + std::to_string(line), what); }
    void cannot_read(std::size_t line, std::string_view text) {
        constexpr std::size_t longest = 80;
        add(line,
            "'" + std::string(text.substr(0, longest)) + (text.size() > longest ? "...' " : "' ") + "cannot be read");
    }

private:
    static constexpr std::size_t most = 50;

    std::string name_;
    std::vector<std::string>& warnings_;
    std::size_t count_ = 0;
};

} // namespace framelet
