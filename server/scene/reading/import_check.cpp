#include "server/scene/reading/import_check.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common/counted.h"
#include "common/error.h"
#include "common/pipe.h"

namespace framelet {
namespace {

constexpr int look_milliseconds = 100; ///< between reports of progress
constexpr std::size_t most_text = 4096;

/// Adds what is there to `text`, of which the end is kept; false at the end.
bool read(int descriptor, std::string& text) {
    std::array<char, 4096> some;
    ssize_t const bytes = ::read(descriptor, some.data(), some.size());
    text.append(some.data(), static_cast<std::size_t>(std::max<ssize_t>(bytes, 0)));
    text.erase(0, text.size() - std::min(text.size(), most_text));
    return bytes > 0;
}

/// A program at work, which is killed where it has not ended at the end of the scope. Its errors are read, and that it
/// says something else.
class Program {
public:
    /// Throws std::system_error where it cannot be started.
    Program(std::filesystem::path const& program, std::vector<std::string> words) {
        words.insert(words.begin(), "framelet-server");
        std::vector<char*> arguments;
        arguments.reserve(words.size() + 1);
        for (std::string& word : words) {
            arguments.push_back(word.data());
        }
        arguments.push_back(nullptr);
        if (int const error = spawn(program, arguments.data())) {
            throw std::system_error(error, std::generic_category());
        }
        signs_.close_writing();
        errors_.close_writing();
    }
    ~Program() {
        if (!has_ended_) {
            ::kill(id_, SIGKILL);
            wait();
        }
    }
    Program(Program const&) = delete;
    Program& operator=(Program const&) = delete;

    /// The end of what it writes to stderr until it closes that. Throws InputError where it goes on for longer than
    /// `patience` and says nothing on stdout.
    std::string read_errors(Progress const& progress, std::chrono::milliseconds patience) const {
        using std::chrono::steady_clock;
        std::string text, ignored;
        std::array<pollfd, 2> wanted{{{errors_.reading(), POLLIN, 0}, {signs_.reading(), POLLIN, 0}}};
        auto last_sign = steady_clock::now();
        for (;;) {
            progress("reading", 0);
            if (steady_clock::now() - last_sign > patience) {
                throw InputError("nothing has come of reading it for " +
                                 counted(static_cast<std::size_t>(patience / std::chrono::seconds(1)), "second"));
            }
            if (::poll(wanted.data(), wanted.size(), look_milliseconds) <= 0) {
                continue;
            }
            if (wanted[0].revents != 0 && !read(errors_.reading(), text)) {
                return text;
            }
            if (wanted[1].revents != 0) {
                last_sign = steady_clock::now();
                wanted[1].fd =
                    read(signs_.reading(), ignored) ? wanted[1].fd : -1; // at its end it is looked at no more
            }
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
    /// Starts the program. Returns an error number, 0 where it runs.
    int spawn(std::filesystem::path const& program, char* const* arguments) {
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
            then([&] { return ::posix_spawn_file_actions_adddup2(&files, signs_.writing(), STDOUT_FILENO); });
            then([&] { return ::posix_spawn_file_actions_adddup2(&files, errors_.writing(), STDERR_FILENO); });
            // Connections must not outlive us there.
            then([&] { return ::posix_spawn_file_actions_addclosefrom_np(&files, STDERR_FILENO + 1); });
            then([&] { return ::posix_spawn(&id_, program.c_str(), &files, &how, arguments, environ); });
            ::posix_spawnattr_destroy(&how);
        }
        ::posix_spawn_file_actions_destroy(&files);
        return error;
    }

    Pipe signs_, errors_; ///< its stdout and stderr
    pid_t id_ = 0;
    bool has_ended_ = false;
};

/// What the program says of the file in its last line, without what is said of each: its own name and the file's.
std::string complaint(std::string text, std::filesystem::path const& file) {
    text.erase(text.find_last_not_of('\n') + 1);
    text.erase(0, text.rfind('\n') + 1);
    for (std::string const& start : {std::string("framelet-server: "), "cannot load scene '" + file.string() + "': "}) {
        text.erase(0, text.starts_with(start) ? start.size() : 0);
    }
    return text;
}

} // namespace

void check_import(std::filesystem::path const& file, ImportOptions const& options, Progress const& progress) {
    std::vector<std::string> words{
        "--info",  "--news",         "1",
        "--quiet", "--scene-memory", std::to_string(std::max<std::uint64_t>(options.memory_bytes >> 20, 1))};
    if (options.allow_outside) {
        words.emplace_back("--allow-outside");
    }
    words.insert(words.end(), {"--up", options.up, "--unit", options.unit});
    if (!options.scene.empty()) {
        words.push_back("--scene=" + options.scene);
    }
    words.insert(words.end(), {"--", file.string()});
    std::optional<Program> program;
    try {
        program.emplace(options.checker, std::move(words));
    } catch (std::system_error const& error) {
        throw InputError("no process can be started that would read it first: " + error.code().message());
    }
    std::string const text = complaint(program->read_errors(progress, options.checker_patience), file);
    int const status = program->wait();
    if (WIFSIGNALED(status)) {
        throw InputError(std::string("it ends the process that reads it: ") + ::strsignal(WTERMSIG(status)));
    }
    if (WEXITSTATUS(status) != 0) {
        throw InputError(text.empty() ? "the process that reads it first ends and does not say why" : text);
    }
}

} // namespace framelet
