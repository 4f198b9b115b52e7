// Tells whether files have changed and their writer has finished. In: their names, times at which to look. Out: yes or
// no. It looks by asking for size and times, not by a service of the kernel: so it sees changes on network drives,
// files that are replaced by others and folders that are removed and made again.
#pragma once

#include <chrono>
#include <compare>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>

namespace framelet {

class FileWatch {
public:
    using Time = std::chrono::steady_clock::time_point;
    /// Time for which nothing must change for a file to count as written.
    static constexpr std::chrono::milliseconds quiet{500};

    /// Watches these files from now on, and folders for what is added to and removed from them; what is known of those
    /// that were watched before is kept.
    void watch(std::span<std::filesystem::path const> files);
    /// True once for all changes until `quiet` ago.
    bool look(Time now);

private:
    /// State of a file; all zero where there is no such file.
    struct Stamp {
        std::uint64_t device = 0, number = 0;
        std::int64_t bytes = 0, seconds = 0, nanoseconds = 0;
        bool operator==(Stamp const&) const = default;
    };
    static Stamp stamp_of(std::filesystem::path const& file);

    std::map<std::filesystem::path, Stamp> stamps_;
    std::optional<Time> changed_; ///< when a change was seen last; nothing once `look` has told it
};

} // namespace framelet
