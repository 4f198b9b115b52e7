// Whether files have changed, and whoever writes them has finished. In: their names, times at which to look. Out: yes
// or no. It looks by asking for size and times, not by a service of the kernel: so it sees changes on network drives,
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
    /// As long nothing must change for a file to count as written.
    static constexpr std::chrono::milliseconds quiet{500};

    /// From now on these are watched, folders for what is added to and removed from them; those that were before keep
    /// what is known of them.
    void watch(std::span<std::filesystem::path const> files);
    /// True once for all that has changed until `quiet` ago.
    bool look(Time now);

private:
    /// All zero where there is no such file.
    struct Stamp {
        std::uint64_t device = 0, number = 0;
        std::int64_t bytes = 0, seconds = 0, nanoseconds = 0;
        bool operator==(Stamp const&) const = default;
    };
    static Stamp stamp_of(std::filesystem::path const& file);

    std::map<std::filesystem::path, Stamp> stamps_;
    std::optional<Time> changed_; ///< when that was seen last; nothing: it has been told
};

} // namespace framelet
