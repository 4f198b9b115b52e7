// Other programs: the path of one, and one of them at work.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace framelet {

/// The path of a program: beside this one, else in PATH. Throws InputError where it is in neither.
std::filesystem::path find_program(std::string const& name);

/// Makes this process that of another program. Throws std::system_error where that fails.
[[noreturn]] void become(std::filesystem::path const& program, std::vector<std::string> const& arguments);

/// Descriptors that a child gets for its own; nothing: where this program's goes.
struct ChildFiles {
    std::optional<int> output, errors;
    bool is_alone = false; ///< whatever else this program has open is not handed on
    std::optional<int> input = {};
    std::optional<int> news = {}; ///< becomes `news_descriptor` there
};
inline constexpr int news_descriptor = 3;

/// Another program at work. It is ended when this goes out of scope, and with the thread that started it, which is this
/// program's main thread, however that ends.
class Child {
public:
    /// Starts the program. Throws std::system_error where no process can be made.
    Child(std::filesystem::path const& program, std::vector<std::string> const& arguments,
          ChildFiles const& files = {});
    ~Child();
    Child(Child const&) = delete;
    Child& operator=(Child const&) = delete;

    pid_t pid() const { return pid_; }
    /// True while it has not ended; looks whether it has.
    bool running();
    void signal(int number);
    /// Tells it to end, waits so long and then kills it.
    void end(std::chrono::milliseconds patience);

    // The following is for a child that has ended.
    bool failed() const; ///< it ended neither well nor because the terminal's Ctrl-C or somebody else told it to end
    bool ended_by_signal() const;
    /// Its exit code, as a shell has it: 128 and the signal's number where one ended it.
    int exit_code() const;
    /// A phrase that says how it ended, such as "has ended with exit code 1".
    std::string how_it_ended() const;

private:
    pid_t pid_;
    std::optional<int> status_; ///< from waitpid; nothing while it runs
};

} // namespace framelet
