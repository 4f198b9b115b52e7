// Opens files before they are judged: what was asked of a name may be of another file when that is opened. In: a path.
// Out: an open file, its size, where it lies, its bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

#include <sys/types.h>

namespace framelet {

/// A regular file that is open for reading, or why there is none. Where something else is in its place (a pipe, a
/// device) that is not opened, which could wait or do something.
class RegularFile {
public:
    explicit RegularFile(std::filesystem::path const& file);
    ~RegularFile();
    RegularFile(RegularFile&& other) noexcept;
    RegularFile& operator=(RegularFile&&) = delete;

    explicit operator bool() const { return descriptor_ >= 0; }
    /// Why it is not open, a phrase; empty where it is.
    std::string const& problem() const { return problem_; }
    /// A name of this very file, for libraries that open files by themselves; valid while this lives. Where it is not
    /// open, there is nothing of that name.
    std::string name() const;

    // The following is for an open file.
    std::uint64_t bytes() const { return bytes_; }
    mode_t mode() const { return mode_; }
    /// Where it lies, without links.
    std::filesystem::path canonical() const;
    /// Reads what comes next; false where the file has less than that.
    bool read(void* to, std::size_t count) const;

private:
    int descriptor_ = -1;
    std::uint64_t bytes_ = 0;
    mode_t mode_ = 0;
    std::string problem_;
};

} // namespace framelet
