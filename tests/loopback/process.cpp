#include "tests/loopback/process.h"

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

#include <fcntl.h>
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

/// A file that is closed at the end of its scope: the child has its own descriptor.
class File {
public:
    File(std::filesystem::path const& path, int flags) : descriptor(::open(path.c_str(), flags | O_CLOEXEC, 0600)) {}
    ~File() { ::close(descriptor); }
    File(File const&) = delete;
    File& operator=(File const&) = delete;

    int const descriptor;
};

Child start(std::string const& program, std::vector<std::string> const& arguments,
            std::filesystem::path const& folder) {
    constexpr int flags = O_WRONLY | O_CREAT | O_TRUNC;
    File const in("/dev/null", O_RDONLY), out(folder / "out", flags), err(folder / "err", flags);
    return Child(program, arguments, {.output = out.descriptor, .errors = err.descriptor, .input = in.descriptor});
}

} // namespace

Process::Process(std::string const& program, std::vector<std::string> const& arguments)
    : child_(start(program, arguments, folder_.path())) {}

int Process::wait(std::chrono::seconds timeout) {
    auto const deadline = std::chrono::steady_clock::now() + timeout;
    while (running()) {
        if (std::chrono::steady_clock::now() > deadline) {
            return -1000;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return child_.ended_by_signal() ? 128 - child_.exit_code() : child_.exit_code();
}

std::string Process::output() const {
    return read_file(folder_.path() / "out");
}
std::string Process::errors() const {
    return read_file(folder_.path() / "err");
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

std::string TemporaryFolder::read(std::string const& name) const {
    return read_file(path_ / name);
}

std::pair<std::string, std::string> make_certificate(TemporaryFolder const& folder, std::string const& name,
                                                     std::string const& kind) {
    std::string const key = (folder.path() / (name + "-key.pem")).string();
    std::string const certificate = (folder.path() / (name + "-cert.pem")).string();
    Process openssl("/usr/bin/openssl",
                    {"req", "-x509", "-newkey", kind, "-nodes", "-days", "1", "-keyout", key, "-out", certificate,
                     "-subj", "/CN=localhost", "-addext", "subjectAltName=IP:127.0.0.1"});
    if (openssl.wait(std::chrono::seconds(60)) != 0) {
        throw std::runtime_error("cannot make a certificate: " + openssl.errors());
    }
    return {certificate, key};
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
