// Another program: where it is, and one of them at work.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace framelet {

/// Beside this program, else in PATH. Throws InputError where it is in neither.
std::filesystem::path find_program(std::string const& name);

/// Ended with this program, however that ends, and when it goes out of scope.
class Child {
public:
    /// `output`: a descriptor for what it prints; nothing: where this program's goes. Throws std::system_error.
    Child(std::filesystem::path const& program, std::vector<std::string> const& arguments,
          std::optional<int> output = {});
    ~Child();
    Child(Child const&) = delete;
    Child& operator=(Child const&) = delete;

    /// Looks whether it has ended.
    bool running();
    void signal(int number);

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
