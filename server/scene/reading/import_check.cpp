#include "server/scene/reading/import_check.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <string>
#include <vector>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common/error.h"

namespace framelet {
namespace {

constexpr int look_milliseconds = 100; ///< between reports of progress
constexpr std::size_t most_text = 4096;

/// A program at work, which is killed where it has not ended at the end of the scope. Only its errors are read.
class Program {
public:
    /// Throws InputError where it cannot be started.
    Program(std::filesystem::path const& program, std::vector<std::string> words) {
        words.insert(words.begin(), "framelet-server");
        std::vector<char*> arguments;
        for (std::string& word : words) {
            arguments.push_back(word.data());
        }
        arguments.push_back(nullptr);
        int ends[2];
        if (::pipe2(ends, O_CLOEXEC) != 0) {
            throw not_started(errno);
        }
        errors_ = ends[0];
        int const error = spawn(program, ends[1], arguments.data());
        ::close(ends[1]);
        if (error != 0) {
            ::close(errors_);
            throw not_started(error);
        }
    }
    ~Program() {
        ::close(errors_);
        if (!has_ended_) {
            ::kill(id_, SIGKILL);
            wait();
        }
    }
    Program(Program const&) = delete;
    Program& operator=(Program const&) = delete;

    /// The end of what it writes to stderr until it closes that.
    std::string read_errors(Progress const& progress) const {
        std::string text;
        std::array<char, 512> some;
        for (;;) {
            progress("reading", 0);
            pollfd wanted{errors_, POLLIN, 0};
            if (::poll(&wanted, 1, look_milliseconds) <= 0) {
                continue;
            }
            ssize_t const bytes = ::read(errors_, some.data(), some.size());
            if (bytes <= 0) {
                return text;
            }
            text.append(some.data(), static_cast<std::size_t>(bytes));
            text.erase(0, text.size() - std::min(text.size(), most_text));
        }
    }

    /// How it ended, as from waitpid; where nobody can say that, as if it had failed.
    int wait() {
        constexpr int failed = 0xff00;
        int status = 0;
        pid_t ended = 0;
        while ((ended = ::waitpid(id_, &status, 0)) < 0 && errno == EINTR) {
        }
        has_ended_ = true;
        return ended == id_ ? status : failed;
    }

private:
    /// Starts the program with `errors` as its stderr. Returns an error number, 0 where it runs.
    int spawn(std::filesystem::path const& program, int errors, char* const* arguments) {
        posix_spawn_file_actions_t files;
        posix_spawnattr_t how;
        if (int const error = ::posix_spawn_file_actions_init(&files)) {
            return error;
        }
        int error = ::posix_spawnattr_init(&how);
        if (error == 0) {
            // A process group of its own: what a terminal sends is for us, who end it.
            error = ::posix_spawnattr_setflags(&how, POSIX_SPAWN_SETPGROUP);
            auto const then = [&error](auto const& step) { error = error == 0 ? step() : error; };
            then([&] { return ::posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0); });
            then([&] { return ::posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0); });
            then([&] { return ::posix_spawn_file_actions_adddup2(&files, errors, STDERR_FILENO); });
            // Connections must not outlive us there.
            then([&] { return ::posix_spawn_file_actions_addclosefrom_np(&files, STDERR_FILENO + 1); });
            then([&] { return ::posix_spawn(&id_, program.c_str(), &files, &how, arguments, environ); });
            ::posix_spawnattr_destroy(&how);
        }
        ::posix_spawn_file_actions_destroy(&files);
        return error;
    }

    static InputError not_started(int error) {
        return InputError(std::string("no process can be started that would read it first: ") + std::strerror(error));
    }

    pid_t id_ = 0;
    int errors_ = -1;
    bool has_ended_ = false;
};

/// What the program says of the file in its last line, without what is said of each: its own name and the file's.
std::string complaint(std::string text, std::filesystem::path const& file) {
    text.erase(text.find_last_not_of("\n") + 1);
    text.erase(0, text.rfind('\n') + 1);
    for (std::string const& start : {std::string("framelet-server: "), "cannot load scene '" + file.string() + "': "}) {
        text.erase(0, text.starts_with(start) ? start.size() : 0);
    }
    return text;
}

} // namespace

void check_import(std::filesystem::path const& file, ImportOptions const& options, Progress const& progress) {
    std::vector<std::string> words{"--info", "--quiet", "--scene-memory",
                                   std::to_string(std::max<std::uint64_t>(options.memory_bytes >> 20, 1))};
    if (options.allow_outside) {
        words.emplace_back("--allow-outside");
    }
    words.insert(words.end(), {"--", file.string()});
    Program program(options.checker, std::move(words));
    std::string const text = complaint(program.read_errors(progress), file);
    int const status = program.wait();
    if (WIFSIGNALED(status)) {
        throw InputError(std::string("it ends the process that reads it: ") + ::strsignal(WTERMSIG(status)));
    }
    if (WEXITSTATUS(status) != 0) {
        throw InputError(text.empty() ? "the process that reads it first ends and does not say why" : text);
    }
}

} // namespace framelet
