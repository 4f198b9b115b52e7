#include "client/processes/private_server.h"

#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <string_view>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

namespace framelet {
namespace {

constexpr char const* program = "framelet-server";

/// Time that the server may take to end when it is told to; then it is killed.
constexpr std::chrono::seconds patience(2);

/// The progress that a line "loading PERCENT% STAGE" tells; nothing of other lines.
std::optional<LoadProgress> load_progress_of(std::string const& line) {
    constexpr std::string_view loading = "loading ";
    std::size_t const end = line.find("% ");
    if (!line.starts_with(loading) || end == std::string::npos) {
        return std::nullopt;
    }
    LoadProgress out{line.substr(end + 2), 0};
    auto const [rest, error] = std::from_chars(line.data() + loading.size(), line.data() + end, out.percent);
    return error == std::errc() && rest == line.data() + end ? std::optional(out) : std::nullopt;
}

} // namespace

PrivateServer::PrivateServer(std::vector<std::string> const& scenes, std::vector<std::string> const& options,
                             std::function<void()> on_news)
    : on_news_(std::move(on_news)) {
    std::filesystem::path const file = find_program(program);
    std::vector<std::string> arguments{"--port", "0"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    arguments.insert(arguments.end(), {"--progress-lines", "--log=text"}); // what is read here
    arguments.emplace_back("--"); // behind it, what looks like an option is none
    arguments.insert(arguments.end(), scenes.begin(), scenes.end());
    std::array<int, 2> pipe{};
    if (::pipe2(pipe.data(), O_CLOEXEC) != 0) {
        throw std::system_error(errno, std::generic_category(), "cannot make a pipe");
    }
    try {
        process_.emplace(file, arguments, ChildFiles{.output = pipe[1], .errors = pipe[1], .is_alone = true});
    } catch (...) {
        ::close(pipe[0]);
        ::close(pipe[1]);
        throw;
    }
    ::close(pipe[1]);
    reader_ = std::thread([this, from = pipe[0]] {
        read(from);
        ::close(from);
        on_news_();
    });
}

PrivateServer::~PrivateServer() {
    process_->end(patience);
    read_to_the_end();
}

/// Waits until all that a server has printed is read, once it has ended.
void PrivateServer::read_to_the_end() {
    if (reader_.joinable()) {
        reader_.join(); // nobody has the other end of the pipe any more
    }
}

std::optional<std::string> PrivateServer::address() const {
    std::lock_guard const lock(mutex_);
    return address_;
}

std::optional<LoadProgress> PrivateServer::progress() const {
    std::lock_guard const lock(mutex_);
    return progress_;
}

std::string PrivateServer::end_reason() {
    read_to_the_end();
    std::lock_guard const lock(mutex_);
    return complaint_.empty() || process_->ended_by_signal() ? std::string(program) + " " + process_->how_it_ended()
                                                             : complaint_;
}

void PrivateServer::read(int descriptor) {
    std::array<char, 4096> bytes;
    std::string said;
    for (;;) {
        ssize_t const count = ::read(descriptor, bytes.data(), bytes.size());
        if (count < 0 && errno == EINTR) {
            continue;
        }
        if (count <= 0) {
            return;
        }
        said.append(bytes.data(), static_cast<std::size_t>(count));
        std::size_t begin = 0;
        for (std::size_t end; (end = said.find('\n', begin)) != std::string::npos; begin = end + 1) {
            take(said.substr(begin, end - begin));
        }
        said.erase(0, begin);
    }
}

void PrivateServer::take(std::string const& line) {
    constexpr std::string_view listening = "listening on ", complaining = "framelet-server: ";
    std::optional<LoadProgress> progress = load_progress_of(line);
    bool const is_progress = progress.has_value();
    bool is_news = is_progress;
    {
        std::lock_guard const lock(mutex_);
        if (is_progress) {
            progress_ = std::move(progress);
        } else if (line.starts_with(complaining)) {
            complaint_ = line.substr(complaining.size()); // for whoever asks why it has ended
            return;
        } else if (line.starts_with(listening) && !address_) {
            address_ = line.substr(listening.size());
            is_news = true;
        }
    }
    if (!is_progress) {
        std::cerr << line + '\n' << std::flush;
    }
    if (is_news) {
        on_news_();
    }
}

} // namespace framelet
