#include "common/files/regular_file.h"

#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace framelet {
namespace {

std::string name_of(int descriptor) {
    return "/proc/self/fd/" + std::to_string(descriptor);
}

} // namespace

RegularFile::RegularFile(std::filesystem::path const& file) {
    int const place = ::open(file.c_str(), O_PATH | O_CLOEXEC); // which opens nothing yet
    struct stat found {};
    if (place < 0 || ::fstat(place, &found) != 0) {
        problem_ = errno == ENOENT ? "there is no such file" : std::strerror(errno);
    } else if (!S_ISREG(found.st_mode)) {
        problem_ = S_ISDIR(found.st_mode) ? "it is a folder" : "it is not a file";
    } else if (descriptor_ = ::open(name_of(place).c_str(), O_RDONLY | O_CLOEXEC); descriptor_ < 0) {
        problem_ = std::strerror(errno);
    } else {
        bytes_ = static_cast<std::uint64_t>(found.st_size);
        mode_ = found.st_mode;
    }
    if (place >= 0) {
        ::close(place);
    }
}

RegularFile::~RegularFile() {
    if (descriptor_ >= 0) {
        ::close(descriptor_);
    }
}

RegularFile::RegularFile(RegularFile&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)), bytes_(other.bytes_), mode_(other.mode_),
      problem_(std::move(other.problem_)) {}

std::filesystem::path RegularFile::canonical() const {
    std::error_code ignored; // what lies nowhere lies in no folder
    return std::filesystem::read_symlink(name(), ignored);
}

std::string RegularFile::name() const {
    return name_of(descriptor_);
}

bool RegularFile::read(void* to, std::size_t count) const {
    auto* at = static_cast<char*>(to);
    while (count > 0) {
        ssize_t const taken = ::read(descriptor_, at, count);
        if (taken < 0 && errno == EINTR) {
            continue;
        }
        if (taken <= 0) {
            return false;
        }
        at += taken;
        count -= static_cast<std::size_t>(taken);
    }
    return true;
}

} // namespace framelet
