// Another program: where it is, and one of them at work.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace framelet {

/// Beside this program, else in PATH. Throws InputError where it is in neither.
std::filesystem::path find_program(std::string const& name);

/// Descriptors; nothing: where this program's goes.
struct ChildFiles {
    std::optional<int> output, errors;
    bool is_alone = false; ///< whatever else this program has open is not handed on
    std::optional<int> input = {};
};

/// Ended with the thread that started it, which is this program's main thread, however that ends, and when it goes out
/// of scope.
class Child {
public:
    /// Throws std::system_error.
    Child(std::filesystem::path const& program, std::vector<std::string> const& arguments,
          ChildFiles const& files = {});
    ~Child();
    Child(Child const&) = delete;
    Child& operator=(Child const&) = delete;

    pid_t pid() const { return pid_; }
    /// Looks whether it has ended.
    bool running();
    void signal(int number);
    /// Tells it to end, waits so long and then kills it.
    void end(std::chrono::milliseconds patience);

    // Of one that has ended.
    bool failed() const; ///< neither well nor because the terminal's Ctrl-C or somebody else told it to end
    bool ended_by_signal() const;
    /// That of a shell: 128 and the signal's number where one ended it.
    int exit_code() const;
    /// As "has ended with exit code 1".
    std::string how_it_ended() const;

private:
    pid_t pid_;
    std::optional<int> status_; ///< of waitpid; nothing while it runs
};

} // namespace framelet
