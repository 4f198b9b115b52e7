#include "client/window/first_connection.h"

#include <chrono>
#include <future>
#include <iostream>
#include <random>
#include <string>

#include "client/core/back_off.h"
#include "client/window/overlay.h"
#include "client/window/viewer.h"
#include "common/error.h"

namespace framelet {

std::unique_ptr<ClientCore> wait_for_server(Window& window, ConnectionOptions const& connection) {
    using Clock = std::chrono::steady_clock;
    Overlay overlay(window.handle(), window.content_scale());
    std::string const server = connection.server.text();
    OverlayContent content;
    content.message = "connecting to " + server + " ...";
    std::future<std::unique_ptr<ClientCore>> attempt;
    std::string failure; // of the last one
    BackOff back_off;
    std::minstd_rand random{std::random_device{}()};
    Clock::time_point next_attempt = Clock::now();
    bool redraw = true;
    for (;;) {
        if (!attempt.valid() && Clock::now() >= next_attempt) {
            attempt = std::async(std::launch::async, [&connection] {
                auto core = Viewer::connect(connection);
                Window::wake();
                return core;
            });
        }
        if (attempt.valid() && attempt.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
            try {
                return attempt.get();
            } catch (ConnectionRefusal const&) {
                throw;
            } catch (ConnectionError const& error) {
                if (failure != error.what()) {
                    failure = error.what();
                    std::cerr << "framelet-viewer: " << failure << "; waiting for it" << std::endl;
                }
                content.message =
                    "waiting for " + server + " ...\n\n" + failure + "\n\nR or Enter: try now     Esc: quit";
                redraw = true;
                auto const pause =
                    std::chrono::duration<double>(back_off.next(std::generate_canonical<double, 32>(random)));
                next_attempt = Clock::now() + std::chrono::duration_cast<Clock::duration>(pause);
            }
        }
        if (redraw && !window.is_hidden()) {
            window.draw_picture();
            overlay.draw(content);
            window.present();
            redraw = false;
        }
        // Whether it is time for another attempt, or one has ended, is looked at so often.
        constexpr double look_seconds = 0.1;
        WindowInput const input = window.wait(look_seconds);
        redraw = redraw || input.redraw;
        for (Command const command : input.commands) {
            if (command == Command::quit) {
                return nullptr;
            }
            if (command == Command::reset || command == Command::reconnect) {
                back_off.reset();
                next_attempt = Clock::now();
            } else if (command == Command::toggle_fullscreen) {
                window.toggle_fullscreen();
            }
        }
    }
}

} // namespace framelet
