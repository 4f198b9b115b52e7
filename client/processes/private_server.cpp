#include "client/processes/private_server.h"

#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string_view>
#include <system_error>
#include <utility>

#include <poll.h>
#include <unistd.h>

#include "common/one_line.h"
#include "common/pipe.h"

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

/// Reads what is there, and hands on the lines that are whole now; `rest` is what there is of the next. False at the
/// end.
bool read_lines(int descriptor, std::string& rest, std::function<void(std::string const&)> const& take) {
    std::array<char, 4096> bytes;
    ssize_t const count = ::read(descriptor, bytes.data(), bytes.size());
    if (count <= 0) {
        return count < 0 && errno == EINTR;
    }
    rest.append(bytes.data(), static_cast<std::size_t>(count));
    std::size_t begin = 0;
    for (std::size_t end; (end = rest.find('\n', begin)) != std::string::npos; begin = end + 1) {
        take(rest.substr(begin, end - begin));
    }
    rest.erase(0, begin);
    return true;
}

} // namespace

PrivateServer::PrivateServer(std::vector<std::string> const& scenes, std::vector<std::string> const& options,
                             std::function<void()> on_news)
    : on_news_(std::move(on_news)) {
    std::filesystem::path const file = find_program(program);
    std::vector<std::string> arguments{"--port", "0"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    arguments.insert(arguments.end(), {"--news", std::to_string(news_descriptor), "--log=text"}); // what is read here
    arguments.emplace_back("--"); // behind it, what looks like an option is none
    arguments.insert(arguments.end(), scenes.begin(), scenes.end());
    auto news = std::make_unique<Pipe>(), words = std::make_unique<Pipe>();
    process_.emplace(
        file, arguments,
        ChildFiles{.output = words->writing(), .errors = words->writing(), .is_alone = true, .news = news->writing()});
    news->close_writing();
    words->close_writing();
    reader_ = std::thread([this, news = std::move(news), words = std::move(words)] {
        read(news->reading(), words->reading());
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

void PrivateServer::read(int news, int words) {
    std::string of_news, of_words; // what is there of a line
    std::array<pollfd, 2> wanted{{{news, POLLIN, 0}, {words, POLLIN, 0}}};
    while (wanted[0].fd >= 0 || wanted[1].fd >= 0) {
        if (::poll(wanted.data(), wanted.size(), -1) < 0) {
            continue; // a signal
        }
        if (wanted[0].revents != 0) {
            wanted[0].fd = read_lines(news, of_news, [this](std::string const& line) { take_news(line); }) ? news : -1;
        }
        if (wanted[1].revents != 0) {
            wanted[1].fd = read_lines(words, of_words, [this](std::string const& line) { take(line); }) ? words : -1;
        }
    }
}

void PrivateServer::take_news(std::string const& line) {
    constexpr std::string_view listening = "listening on ";
    {
        std::lock_guard const lock(mutex_);
        if (auto progress = load_progress_of(line)) {
            progress_ = std::move(progress);
        } else if (line.starts_with(listening) && !address_) {
            address_ = line.substr(listening.size());
        } else {
            return;
        }
    }
    on_news_();
}

void PrivateServer::take(std::string const& line) {
    constexpr std::string_view complaining = "framelet-server: ";
    if (line.starts_with(complaining)) {
        std::lock_guard const lock(mutex_);
        complaint_ = line.substr(complaining.size()); // for whoever asks why it has ended
    } else {
        std::cerr << to_one_line(line) + '\n' << std::flush;
    }
}

} // namespace framelet
