// Runs the real programs as child processes and reads what they say.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <sys/types.h>

#include "client/processes/child.h"

namespace framelet::test {

/// A fresh folder under the system's temporary one, removed with its content at the end of its scope.
class TemporaryFolder {
public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(TemporaryFolder const&) = delete;
    TemporaryFolder& operator=(TemporaryFolder const&) = delete;

    std::filesystem::path const& path() const { return path_; }
    /// Writes a text file there and gives its name.
    std::string write(std::string const& name, std::string const& text) const;
    std::string read(std::string const& name) const;

private:
    std::filesystem::path path_;
};

/// Makes a certificate for 127.0.0.1, signed with its own key; returns the files of both. `kind`: of key, as OpenSSL
/// names it.
std::pair<std::string, std::string> make_certificate(TemporaryFolder const& folder, std::string const& name,
                                                     std::string const& kind = "rsa:2048");

/// A child with its stdout and stderr in files, and nothing on stdin. Killed when it goes out of scope.
class Process {
public:
    Process(std::string const& program, std::vector<std::string> const& arguments);

    /// Exit code, or -signal; -1000 when it does not end in time.
    int wait(std::chrono::seconds timeout);
    void signal(int number) { child_.signal(number); }
    bool running() { return child_.running(); }
    pid_t pid() const { return child_.pid(); }
    std::string output() const;
    std::string errors() const;

private:
    TemporaryFolder folder_;
    Child child_;
};

/// Waits until a condition holds; false where it does not within two minutes.
bool eventually(std::function<bool()> const& holds);

/// framelet-server on a free port of 127.0.0.1, or another program that says where it listens as that does, ready for
/// connections.
class ServerProcess {
public:
    explicit ServerProcess(std::string const& scene, std::vector<std::string> options = {});
    static ServerProcess of_program(std::string const& program, std::vector<std::string> const& arguments);

    std::string const& address() const { return address_; }
    Process& process() { return *process_; }

private:
    explicit ServerProcess(std::unique_ptr<Process> process);

    std::unique_ptr<Process> process_;
    std::string address_;
};

} // namespace framelet::test
