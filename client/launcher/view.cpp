#include "client/launcher/view.h"

#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <istream>
#include <system_error>

#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/streambuf.hpp>
#include <fcntl.h>
#include <unistd.h>

#include "client/launcher/child.h"
#include "common/error.h"

namespace framelet {
namespace {

namespace asio = boost::asio;

/// How long the server may take to tell its viewers that it ends.
constexpr std::chrono::seconds patience(5);

class View {
public:
    explicit View(ViewOptions const& options)
        : options_(options), server_program_(find_program("framelet-server")),
          viewer_program_(find_program("framelet-viewer")) {}

    View(View const&) = delete;
    View& operator=(View const&) = delete;

    int run() {
        for (int const number : {SIGINT, SIGTERM, SIGHUP, SIGCHLD}) {
            signals_.add(number);
        }
        wait_for_signal();
        start_server();
        io_.run();
        return exit_code_;
    }

private:
    void start_server() {
        std::array<int, 2> pipe{};
        if (::pipe2(pipe.data(), O_CLOEXEC) != 0) {
            throw std::system_error(errno, std::generic_category(), "cannot make a pipe");
        }
        server_says_.assign(pipe[0]);
        std::vector<std::string> arguments{"--port", "0"};
        arguments.insert(arguments.end(), options_.server.begin(), options_.server.end());
        server_.emplace(server_program_, arguments, pipe[1]);
        ::close(pipe[1]);
        read_server();
    }

    /// What it prints is passed on, and its address is among it.
    void read_server() {
        asio::async_read_until(server_says_, said_, '\n', [this](boost::system::error_code error, std::size_t) {
            if (error) { // it has ended, as SIGCHLD says too
                return;
            }
            std::string line;
            std::istream stream(&said_);
            std::getline(stream, line);
            std::cout << line << std::endl;
            constexpr std::string_view ready = "listening on ";
            if (line.starts_with(ready) && !viewer_ && !ending_) {
                start_viewer(line.substr(ready.size()));
            }
            read_server();
        });
    }

    void start_viewer(std::string const& address) {
        std::vector<std::string> arguments = options_.viewer;
        arguments.push_back(address);
        viewer_.emplace(viewer_program_, arguments);
    }

    void wait_for_signal() {
        signals_.async_wait([this](boost::system::error_code error, int number) {
            if (error) {
                return;
            }
            if (number != SIGCHLD) {
                end_both();
            }
            if (look_after_children()) {
                wait_for_signal();
            }
        });
    }

    /// False when both have ended.
    bool look_after_children() {
        bool const serving = server_ && server_->running();
        bool const viewing = viewer_ && viewer_->running();
        if (!ending_ && (!serving || (viewer_ && !viewing))) {
            exit_code_ = viewer_ && !viewing ? code_of_ended_viewer() : code_of_ended_server();
            end_both();
        }
        if (serving || viewing) {
            return true;
        }
        signals_.cancel();
        hurry_.cancel();
        return false;
    }

    int code_of_ended_viewer() const {
        if (!viewer_->failed()) {
            return 0;
        }
        if (viewer_->ended_by_signal()) { // otherwise it has said why
            std::cerr << "framelet: framelet-viewer " << viewer_->how_it_ended() << std::endl;
        }
        return viewer_->exit_code();
    }

    int code_of_ended_server() const {
        if (viewer_ || server_->ended_by_signal()) { // otherwise it has said why
            std::cerr << "framelet: framelet-server " << server_->how_it_ended() << std::endl;
        }
        return viewer_ && server_->exit_code() == 0 ? 1 : server_->exit_code(); // 0: somebody has told it to end
    }

    void end_both() {
        ending_ = true;
        for (std::optional<Child>* const child : {&viewer_, &server_}) {
            if (*child) {
                (*child)->signal(SIGTERM);
            }
        }
        hurry_.expires_after(patience);
        hurry_.async_wait([this](boost::system::error_code error) {
            for (std::optional<Child>* const child : {&viewer_, &server_}) {
                if (!error && *child) {
                    (*child)->signal(SIGKILL);
                }
            }
        });
    }

    ViewOptions const& options_;
    std::filesystem::path const server_program_, viewer_program_;
    asio::io_context io_{1};
    asio::signal_set signals_{io_};
    asio::posix::stream_descriptor server_says_{io_};
    asio::streambuf said_;
    asio::steady_timer hurry_{io_};
    std::optional<Child> server_, viewer_;
    bool ending_ = false; ///< both have been told to end, and how they do is of no interest
    int exit_code_ = 0;
};

bool is_set(char const* variable) {
    char const* const value = std::getenv(variable);
    return value != nullptr && *value != '\0';
}

} // namespace

int view(ViewOptions const& options) {
    if (!is_set("DISPLAY") && !is_set("WAYLAND_DISPLAY")) { // before a scene is loaded for it
        throw InputError("cannot open a window: there is no display (neither DISPLAY nor WAYLAND_DISPLAY is set); "
                         "framelet-server and framelet-client need none");
    }
    return View(options).run();
}

} // namespace framelet
