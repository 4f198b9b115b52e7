#include "client/window/first_connection.h"

#include <algorithm>
#include <chrono>
#include <future>
#include <iostream>
#include <optional>
#include <random>
#include <thread>

#include "client/core/connection/back_off.h"
#include "client/window/overlay/overlay.h"
#include "client/window/overlay/overlay_text.h"
#include "client/window/viewer.h"
#include "common/error.h"

namespace framelet {

namespace {

using Clock = std::chrono::steady_clock;

/// Tries to connect to one server, again and again. One that is given up is not waited for: its thread ends by itself.
class Attempts {
public:
    explicit Attempts(ConnectionOptions options) : options_(std::move(options)) {}

    ConnectionOptions const& options() const { return options_; }
    std::string const& failure() const { return failure_; } ///< of the last attempt; empty: none has ended
    bool is_refused() const { return is_refused_; } ///< no other attempt follows by itself

    void hurry() {
        back_off_.reset();
        next_ = Clock::now();
        is_refused_ = false;
    }

    /// The session once there is one, else null; begins attempts when they are due. `is_refusal_fatal`: a refusal is
    /// thrown.
    std::unique_ptr<ClientCore> poll(bool is_refusal_fatal) {
        if (!attempt_.valid() && !is_refused_ && Clock::now() >= next_) {
            std::packaged_task<std::unique_ptr<ClientCore>()> task([options = options_] {
                struct Wake {
                    ~Wake() { Window::wake(); } // whatever has come of it
                } const wake;
                return Viewer::connect(options);
            });
            attempt_ = task.get_future();
            std::thread(std::move(task)).detach();
        }
        if (!attempt_.valid() || attempt_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
            return nullptr;
        }
        try {
            return attempt_.get();
        } catch (ConnectionRefusal const& refusal) {
            if (is_refusal_fatal) {
                throw;
            }
            is_refused_ = true;
            note(refusal.what());
        } catch (ConnectionError const& error) {
            note(error.what());
            auto const pause =
                std::chrono::duration<double>(back_off_.next(std::generate_canonical<double, 32>(random_)));
            next_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(pause);
        }
        return nullptr;
    }

private:
    void note(std::string const& failure) {
        if (failure_ != failure) {
            failure_ = failure;
            std::cerr << "framelet-viewer: " << failure_ << (is_refused_ ? "" : "; waiting for it") << std::endl;
        }
    }

    ConnectionOptions options_;
    std::future<std::unique_ptr<ClientCore>> attempt_;
    std::string failure_;
    bool is_refused_ = false;
    BackOff back_off_;
    std::minstd_rand random_{std::random_device{}()};
    Clock::time_point next_ = Clock::now();
};

std::string message_of(Attempts const& attempts) {
    std::string const server = attempts.options().server.text();
    if (attempts.failure().empty()) {
        return "connecting to " + server + " ...";
    }
    return (attempts.is_refused() ? server + " does not let this viewer in" : "waiting for " + server + " ...") +
           "\n\n" + attempts.failure() + "\n\nR or Enter: try now     Esc: quit";
}

} // namespace

Connection wait_for_server(Window& window, std::string const& address, OptionsFor const& options_for,
                           std::vector<std::string> const& recent, SceneOpener& opener) {
    Overlay overlay(window.handle(), window.content_scale());
    std::optional<Attempts> attempts(options_for(address));
    bool is_from_command_line = true;
    std::string complaint; // about an address that was typed, or a file that was dropped
    OverlayContent shown;
    int frames = 1; // still to be drawn; what the mouse presses is seen in one, what it releases in the next
    for (;;) {
        if (auto core = attempts->poll(is_from_command_line)) {
            return {std::move(core), attempts->options()};
        }
        if (std::optional<Connection> opened = opener.poll()) {
            return std::move(*opened);
        }
        if (std::string why = opener.take_complaint(); !why.empty()) {
            complaint = std::move(why);
        }
        OverlayContent content;
        opener.show(content);
        content.message = message_of(*attempts) + (complaint.empty() ? "" : "\n\n" + complaint);
        if (!attempts->failure().empty() || !is_from_command_line) {
            content.address = {address, recent};
        }
        frames = content != shown ? std::max(frames, 1) : frames;
        if (frames > 0 && !window.is_hidden()) {
            window.draw_picture();
            OverlayActions const asked = overlay.draw(content);
            window.set_overlay_areas(overlay.mouse_areas());
            window.set_typing(overlay.is_typed_into());
            window.present();
            shown = content;
            --frames;
            if (asked.address) {
                try {
                    attempts.emplace(options_for(*asked.address));
                    is_from_command_line = false;
                    complaint.clear();
                } catch (InputError const& error) {
                    complaint = error.what();
                }
                continue;
            }
        }
        // The time between two looks at whether an attempt is due or has ended.
        constexpr double look_seconds = 0.1;
        WindowInput const input = window.wait(frames > 0 ? 0 : look_seconds);
        if (!input.dropped.empty()) {
            complaint.clear();
            opener.open(input.dropped);
        }
        frames = input.touched_overlay ? 3 : input.redraw ? 1 : frames;
        for (Command const command : input.commands) {
            if (command == Command::quit || command == Command::escape) {
                return {};
            }
            if (command == Command::reset || command == Command::reconnect) {
                attempts->hurry();
            } else if (command == Command::toggle_fullscreen) {
                window.toggle_fullscreen();
            }
        }
    }
}

} // namespace framelet
