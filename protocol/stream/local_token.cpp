#include "protocol/stream/local_token.h"

#include <array>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/error.h"
#include "protocol/stream/token.h"
#include "protocol/stream/user_folders.h"

namespace framelet {
namespace {

/// First part of a file's name. The machine is in it because several may share a home folder.
std::string name_prefix() {
    std::array<char, 256> machine{};
    ::gethostname(machine.data(), machine.size() - 1);
    return "token-" + std::string(machine.data()) + "-";
}

/// Lock of a folder: while it lives, no other server of this user changes the folder. It is a file that nobody else can
/// open: whoever may read the folder could lock that for good.
class FolderLock {
public:
    explicit FolderLock(std::filesystem::path const& folder)
        : descriptor_(::open((folder / "lock").c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, S_IRUSR | S_IWUSR)) {
        ::flock(descriptor_, LOCK_EX);
    }
    ~FolderLock() { ::close(descriptor_); }
    FolderLock(FolderLock const&) = delete;
    FolderLock& operator=(FolderLock const&) = delete;

private:
    int const descriptor_;
};

/// Removes the files of servers that were killed. Must be called under the folder's lock.
void remove_abandoned(std::filesystem::path const& folder) {
    std::error_code ignored;
    for (auto const& entry : std::filesystem::directory_iterator(folder, ignored)) {
        if (!entry.path().filename().string().starts_with(name_prefix())) {
            continue;
        }
        int const descriptor = ::open(entry.path().c_str(), O_RDONLY | O_NONBLOCK | O_NOFOLLOW | O_CLOEXEC);
        if (descriptor >= 0 && ::flock(descriptor, LOCK_EX | LOCK_NB) == 0) {
            ::unlink(entry.path().c_str());
        }
        ::close(descriptor);
    }
}

bool is_of_this_user_alone(std::filesystem::path const& file) {
    struct stat found {};
    return ::lstat(file.c_str(), &found) == 0 && S_ISREG(found.st_mode) && found.st_uid == ::geteuid() &&
           (found.st_mode & (S_IRWXG | S_IRWXO)) == 0;
}

} // namespace

LocalToken::LocalToken(std::vector<std::string> const& addresses) : token_(make_token()) {
    bool written = false;
    for (std::filesystem::path const& folder : runtime_folders()) {
        if (!written && make_private_folder(folder)) {
            written = write(folder, addresses);
        } else if (is_private_folder(folder)) {
            FolderLock const lock(folder);
            remove_abandoned(folder);
        }
    }
    if (!written) {
        throw InputError("there is no folder of yours for the file that tells your viewers the token (tried last: '" +
                         runtime_folders().back().string() +
                         "'): set XDG_RUNTIME_DIR to one, or give --token-file, or --insecure to let everybody in");
    }
}

LocalToken::~LocalToken() {
    remove_files();
}

bool LocalToken::write(std::filesystem::path const& folder, std::vector<std::string> const& addresses) {
    FolderLock const lock(folder);
    remove_abandoned(folder);
    for (std::string const& address : addresses) {
        std::filesystem::path const path = folder / (name_prefix() + address);
        ::unlink(path.c_str()); // left by a server that listened there before: none else can listen there now
        int const descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR);
        if (descriptor < 0) {
            remove_files();
            return false;
        }
        files_.push_back({path, descriptor});
        ::flock(descriptor, LOCK_EX | LOCK_NB);
        std::string const line = token_ + "\n";
        if (::write(descriptor, line.data(), line.size()) != static_cast<ssize_t>(line.size())) {
            remove_files();
            return false;
        }
    }
    return true;
}

void LocalToken::remove_files() {
    for (File const& file : files_) {
        ::unlink(file.path.c_str());
        ::close(file.descriptor);
    }
    files_.clear();
}

std::string read_local_token(std::string const& address) {
    for (std::filesystem::path const& folder : runtime_folders()) {
        std::filesystem::path const file = folder / (name_prefix() + address);
        if (is_private_folder(folder) && is_of_this_user_alone(file)) {
            try {
                return read_token_file(file);
            } catch (InputError const&) { // the file has gone meanwhile
            }
        }
    }
    return {};
}

} // namespace framelet
