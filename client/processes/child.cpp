#include "client/processes/child.h"

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <system_error>
#include <thread>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common/error.h"

namespace framelet {
namespace {

bool is_program(std::filesystem::path const& file) {
    std::error_code ignored;
    return std::filesystem::is_regular_file(file, ignored) && ::access(file.c_str(), X_OK) == 0;
}

/// What `execv` takes: pointers into the strings, which have to stay.
std::vector<char*> argv_of(std::filesystem::path const& program, std::vector<std::string> const& arguments) {
    std::vector<char*> out{const_cast<char*>(program.c_str())};
    for (std::string const& argument : arguments) {
        out.push_back(const_cast<char*>(argument.c_str()));
    }
    out.push_back(nullptr);
    return out;
}

} // namespace

std::filesystem::path find_program(std::string const& name) {
    std::error_code ignored;
    std::filesystem::path beside = std::filesystem::read_symlink("/proc/self/exe", ignored).replace_filename(name);
    if (is_program(beside)) {
        return beside;
    }
    char const* const path = std::getenv("PATH");
    std::istringstream folders(path == nullptr ? "" : path);
    for (std::string folder; std::getline(folders, folder, ':');) {
        if (is_program(std::filesystem::path(folder) / name)) {
            return std::filesystem::path(folder) / name;
        }
    }
    throw InputError("cannot find " + name + ", neither beside this program nor in PATH: install it");
}

void become(std::filesystem::path const& program, std::vector<std::string> const& arguments) {
    ::execv(program.c_str(), argv_of(program, arguments).data());
    throw std::system_error(errno, std::generic_category(), "cannot start " + program.string());
}

Child::Child(std::filesystem::path const& program, std::vector<std::string> const& arguments, ChildFiles const& files) {
    std::vector<char*> const argv = argv_of(program, arguments);
    pid_t const parent = ::getpid();
    pid_ = ::fork(); // posix_spawn cannot ask for the signal of the parent's death
    if (pid_ < 0) {
        throw std::system_error(errno, std::generic_category(), "cannot start " + program.string());
    }
    if (pid_ == 0) {
        ::prctl(PR_SET_PDEATHSIG, SIGTERM);
        if (::getppid() != parent) { // the parent has ended before that
            ::_exit(1);
        }
        if (files.input) {
            ::dup2(*files.input, STDIN_FILENO);
        }
        if (files.output) {
            ::dup2(*files.output, STDOUT_FILENO);
        }
        if (files.errors) {
            ::dup2(*files.errors, STDERR_FILENO);
        }
        if (files.is_alone) {
            ::close_range(STDERR_FILENO + 1, ~0u, CLOSE_RANGE_CLOEXEC);
        }
        if (files.news) {
            ::dup2(*files.news, news_descriptor);
            ::fcntl(news_descriptor, F_SETFD, 0); // it may have been that one
        }
        ::signal(SIGPIPE, SIG_DFL); // whatever this program does on it
        ::execv(program.c_str(), argv.data());
        ::_exit(127);
    }
}

Child::~Child() {
    end(std::chrono::milliseconds(0));
}

bool Child::running() {
    int status = 0;
    if (!status_ && ::waitpid(pid_, &status, WNOHANG) == pid_) {
        status_ = status;
    }
    return !status_;
}

void Child::signal(int number) {
    if (running()) {
        ::kill(pid_, number);
    }
}

void Child::end(std::chrono::milliseconds patience) {
    signal(SIGTERM);
    auto const deadline = std::chrono::steady_clock::now() + patience;
    while (running() && std::chrono::steady_clock::now() < deadline) {
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    if (running()) {
        signal(SIGKILL);
        int status = 0;
        ::waitpid(pid_, &status, 0);
        status_ = status;
    }
}

bool Child::ended_by_signal() const {
    return WIFSIGNALED(*status_);
}

bool Child::failed() const {
    int const signal = ended_by_signal() ? WTERMSIG(*status_) : 0;
    return exit_code() != 0 && signal != SIGINT && signal != SIGTERM && signal != SIGHUP;
}

int Child::exit_code() const {
    return ended_by_signal() ? 128 + WTERMSIG(*status_) : WEXITSTATUS(*status_);
}

std::string Child::how_it_ended() const {
    return ended_by_signal() ? std::string("was ended by a signal: ") + ::strsignal(WTERMSIG(*status_))
                             : "has ended with exit code " + std::to_string(exit_code());
}

} // namespace framelet
