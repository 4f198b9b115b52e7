#include "tests/loopback/process.h"

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace framelet::test {
namespace {

std::string read_file(std::filesystem::path const& file) {
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
}

std::filesystem::path make_folder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "framelet-test-XXXXXX").string();
    if (!::mkdtemp(pattern.data())) {
        throw std::runtime_error("cannot make a temporary folder");
    }
    return pattern;
}

std::vector<std::string> server_arguments(std::string const& scene, std::vector<std::string> options) {
    options.insert(options.begin(), {scene, "--port", "0"});
    return options;
}

} // namespace

Process::Process(std::string const& program, std::vector<std::string> const& arguments) : directory_(make_folder()) {
    std::vector<char*> argv{const_cast<char*>(program.c_str())};
    for (auto const& argument : arguments) {
        argv.push_back(const_cast<char*>(argument.c_str()));
    }
    argv.push_back(nullptr);
    std::string const out = (directory_ / "out").string();
    std::string const err = (directory_ / "err").string();
    pid_ = ::fork();
    if (pid_ == 0) {
        constexpr int flags = O_WRONLY | O_CREAT | O_TRUNC;
        ::dup2(::open("/dev/null", O_RDONLY), STDIN_FILENO);
        ::dup2(::open(out.c_str(), flags, 0600), STDOUT_FILENO);
        ::dup2(::open(err.c_str(), flags, 0600), STDERR_FILENO);
        ::signal(SIGPIPE, SIG_DFL); // whatever the tests were started by
        ::execv(program.c_str(), argv.data());
        ::_exit(127);
    }
    if (pid_ < 0) {
        throw std::runtime_error("cannot start " + program);
    }
}

Process::~Process() {
    if (running()) {
        ::kill(pid_, SIGKILL);
        ::kill(pid_, SIGCONT);
        ::waitpid(pid_, &status_, 0);
    }
    std::filesystem::remove_all(directory_);
}

bool Process::running() {
    if (!reaped_ && ::waitpid(pid_, &status_, WNOHANG) == pid_) {
        reaped_ = true;
    }
    return !reaped_;
}

int Process::wait(std::chrono::seconds timeout) {
    auto const deadline = std::chrono::steady_clock::now() + timeout;
    while (running()) {
        if (std::chrono::steady_clock::now() > deadline) {
            return -1000;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return WIFEXITED(status_) ? WEXITSTATUS(status_) : -WTERMSIG(status_);
}

void Process::signal(int number) {
    if (running()) {
        ::kill(pid_, number);
    }
}

std::string Process::output() const {
    return read_file(directory_ / "out");
}
std::string Process::errors() const {
    return read_file(directory_ / "err");
}

TemporaryFolder::TemporaryFolder() : path_(make_folder()) {}
TemporaryFolder::~TemporaryFolder() {
    std::filesystem::remove_all(path_);
}

std::string TemporaryFolder::write(std::string const& name, std::string const& text) const {
    std::string const file = (path_ / name).string();
    std::ofstream(file, std::ios::binary) << text;
    return file;
}

ServerProcess::ServerProcess(std::string const& scene, std::vector<std::string> options)
    : ServerProcess(of_program(FRAMELET_SERVER, server_arguments(scene, std::move(options)))) {}

ServerProcess ServerProcess::of_program(std::string const& program, std::vector<std::string> const& arguments) {
    return ServerProcess(std::make_unique<Process>(program, arguments));
}

ServerProcess::ServerProcess(std::unique_ptr<Process> process) : process_(std::move(process)) {
    auto const deadline = std::chrono::steady_clock::now() + std::chrono::seconds(120);
    std::string const mark = "listening on ";
    for (;;) {
        std::string const text = process_->output();
        std::size_t const start = text.find(mark);
        std::size_t const end = start == std::string::npos ? start : text.find('\n', start);
        if (end != std::string::npos) {
            address_ = text.substr(start + mark.size(), end - start - mark.size());
            return;
        }
        if (!process_->running() || std::chrono::steady_clock::now() > deadline) {
            throw std::runtime_error("the server did not start: " + process_->errors());
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
}

bool eventually(std::function<bool()> const& holds) {
    auto const deadline = std::chrono::steady_clock::now() + std::chrono::minutes(2);
    while (!holds()) {
        if (std::chrono::steady_clock::now() > deadline) {
            return false;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return true;
}

} // namespace framelet::test
