#include "client/launcher/view.h"

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <optional>
#include <system_error>

#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <fcntl.h>
#include <unistd.h>

#include "client/processes/child.h"
#include "client/processes/private_server.h"
#include "common/error.h"

namespace framelet {
namespace {

namespace asio = boost::asio;

/// Time that the programs may take to end: the server has to tell its viewers.
constexpr std::chrono::seconds patience(5);

class View {
public:
    explicit View(ViewOptions const& options) : options_(options), viewer_program_(find_program("framelet-viewer")) {}

    View(View const&) = delete;
    View& operator=(View const&) = delete;

    int run() {
        for (int const number : {SIGINT, SIGTERM, SIGHUP, SIGCHLD}) {
            signals_.add(number);
        }
        wait_for_signal();
        server_.emplace(options_.scenes, options_.server, ServerErrors::shown, [this] {
            asio::post(io_, [this] {
                if (auto const address = server_->address(); address && !viewer_ && !ending_) {
                    start_viewer(*address);
                }
            });
        });
        io_.run();
        return exit_code_;
    }

private:
    void start_viewer(std::string const& address) {
        // While the other end of the pipe is open the server is needed: the viewer closes it where it opens another
        // scene.
        std::array<int, 2> needed{};
        if (::pipe2(needed.data(), O_CLOEXEC) != 0) {
            throw std::system_error(errno, std::generic_category(), "cannot make a pipe");
        }
        server_needed_.assign(needed[0]);
        ::fcntl(needed[1], F_SETFD, 0);
        std::vector<std::string> arguments = options_.viewer;
        arguments.insert(arguments.end(), {address, "--server-needed=" + std::to_string(needed[1])});
        for (std::string const& option : options_.other_scenes) {
            arguments.push_back("--server-option=" + option);
        }
        viewer_.emplace(viewer_program_, arguments);
        ::close(needed[1]);
        server_needed_.async_wait(asio::posix::stream_descriptor::wait_read, [this](boost::system::error_code error) {
            if (!error && !ending_) {
                is_server_needed_ = false;
                server_->process().signal(SIGTERM);
            }
        });
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

    /// Ends both programs where one has ended. False when both have.
    bool look_after_children() {
        bool const serving = server_->process().running();
        bool const viewing = viewer_ && viewer_->running();
        if (!ending_ && ((!serving && is_server_needed_) || (viewer_ && !viewing))) {
            exit_code_ = viewer_ && !viewing ? code_of_ended_viewer() : code_of_ended_server();
            end_both();
        }
        if (serving || viewing) {
            return true;
        }
        signals_.cancel();
        hurry_.cancel();
        server_needed_.close();
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

    int code_of_ended_server() {
        Child const& server = server_->process();
        if (viewer_ || server.ended_by_signal()) { // otherwise it has said why
            std::cerr << "framelet: framelet-server " << server.how_it_ended() << std::endl;
        }
        return viewer_ && server.exit_code() == 0 ? 1 : server.exit_code(); // 0: somebody has told it to end
    }

    void end_both() {
        ending_ = true;
        signal_both(SIGTERM);
        hurry_.expires_after(patience);
        hurry_.async_wait([this](boost::system::error_code error) {
            if (!error) {
                signal_both(SIGKILL);
            }
        });
    }

    void signal_both(int number) {
        if (viewer_) {
            viewer_->signal(number);
        }
        server_->process().signal(number);
    }

    ViewOptions const& options_;
    std::filesystem::path const viewer_program_;
    asio::io_context io_{1};
    asio::signal_set signals_{io_};
    asio::posix::stream_descriptor server_needed_{io_};
    asio::steady_timer hurry_{io_};
    std::optional<PrivateServer> server_;
    std::optional<Child> viewer_;
    bool is_server_needed_ = true; ///< by the viewer
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
