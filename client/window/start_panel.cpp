#include "client/window/start_panel.h"

#include <algorithm>
#include <chrono>

#include "client/processes/end_signals.h"
#include "client/viewer/commands.h"
#include "client/window/attempts.h"
#include "client/window/dropped_files.h"
#include "client/window/escape_key.h"
#include "client/window/overlay/overlay.h"
#include "common/error.h"
#include "common/program_line.h"

namespace framelet {

namespace {

/// The message, and the field for a server where one may be wanted. `complaint`: about an address that was typed, or a
/// scene.
void show_choice(Attempts const* attempts, SceneOpener const& opener, std::string const& complaint,
                 OverlayContent& content) {
    if (attempts != nullptr) {
        content.message = attempts->message() + (complaint.empty() ? "" : "\n\n" + complaint);
        content.asks_trust = attempts->asks_trust();
    } else if (opener.opening().empty()) {
        content.message =
            (complaint.empty() ? "Connect to framelet-server, or open a scene file, which may also be dropped here."
                               : complaint) +
            "\n\n" + (opener.can_reopen() ? "R: try again     " : "") + "Enter: connect     Ctrl+Q: quit";
    }
}

double seconds_now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

} // namespace

Connection run_start_panel(Window& window, Start const& start, OptionsFor const& options_for, SceneOpener& opener) {
    Overlay overlay(window.handle());
    std::optional<Attempts> attempts;
    if (start.address) {
        attempts.emplace(options_for({*start.address}));
    }
    bool is_from_command_line = start.address.has_value();
    std::string complaint;
    OverlayContent shown;
    int frames = 1; // still to be drawn; what the mouse presses is seen in one, what it releases in the next
    auto const try_server = [&](NamedServer const& server) {
        try {
            attempts.emplace(options_for(server), true);
            is_from_command_line = false;
            complaint.clear();
        } catch (InputError const& error) {
            complaint = error.what();
        }
    };
    EscapeKey escape;
    double note_until = 0;
    // True where the command ends the program; where it is an Esc, carries that out.
    auto const is_quit = [&](Command command) {
        if (command != Command::escape) {
            return command == Command::quit;
        }
        EscapeLeaves const leaves = escape.press({.full_screen = window.is_fullscreen()}, seconds_now());
        if (leaves == EscapeLeaves::full_screen) {
            window.toggle_fullscreen();
        } else {
            note_until = seconds_now() + EscapeKey::most_pause;
        }
        return leaves == EscapeLeaves::program;
    };
    while (!is_told_to_end()) {
        if (attempts) {
            if (auto core = attempts->poll(is_from_command_line && opener.opening().empty())) {
                return {std::move(core), attempts->options()};
            }
        }
        if (std::optional<Connection> opened = opener.poll()) {
            return std::move(*opened);
        }
        if (std::string why = opener.take_complaint(); !why.empty()) {
            print_line("framelet-viewer", why);
            if (start.needs_scene) {
                return {};
            }
            complaint = std::move(why);
        }
        OverlayContent content;
        opener.show(content);
        show_choice(attempts ? &*attempts : nullptr, opener, complaint, content);
        content.note = seconds_now() < note_until ? escape_note() : "";
        if (!content.message.empty() && !content.asks_trust &&
            (!attempts || attempts->has_failed() || !is_from_command_line)) {
            content.address = {with_tls(start.address.value_or(usual_server), start.always_tls), start.recent,
                               attempts              ? attempts->field_at_fault()
                               : opener.can_reopen() ? ServerField::none
                                                     : ServerField::address,
                               start.always_tls};
        }
        // A field that is new takes the keys after its first frame.
        frames = content != shown ? std::max(frames, 3) : frames;
        if (frames > 0 && !window.is_hidden()) {
            window.draw_picture();
            OverlayActions const asked = overlay.draw(content, window.content_scale());
            window.set_overlay_areas(overlay.mouse_areas());
            window.set_typing(overlay.is_typed_into());
            window.present();
            shown = content;
            --frames;
            if (asked.trusts && attempts) {
                *asked.trusts ? attempts->trust() : attempts.reset();
                continue;
            }
            if (asked.server) {
                try_server(*asked.server);
                continue;
            }
            for (Command const command : asked.commands) { // Esc in a field, or a button
                if (is_quit(command)) {
                    return {};
                }
                if (command == Command::open_file) {
                    opener.choose();
                }
            }
        }
        // The time between two looks at whether an attempt is due or has ended.
        constexpr double look_seconds = 0.1;
        WindowInput const input = window.wait(frames > 0 && !window.is_hidden() ? 0 : look_seconds);
        if (!input.dropped.empty()) {
            DroppedFiles const dropped = sort_dropped(input.dropped);
            complaint = dropped.cameras.empty()
                            ? ""
                            : "'" + dropped.cameras.back() + "' is a camera: drop it once there is a scene to look at.";
            opener.open(dropped.scenes);
        }
        frames = input.touched_overlay ? 3 : input.redraw ? std::max(frames, 1) : frames;
        for (Command const command : input.commands) {
            if (is_quit(command)) {
                return {};
            }
            if (command == Command::toggle_fullscreen) {
                window.toggle_fullscreen();
            } else if (command == Command::open_file) {
                opener.choose();
            } else if (command != Command::reset && command != Command::reconnect) {
                continue;
            } else if (attempts) {
                attempts->hurry();
            } else if (!opener.opening().empty()) {
                continue;
            } else if (command == Command::reconnect) {
                try_server(overlay.server());
            } else if (opener.can_reopen()) {
                complaint.clear();
                opener.reopen();
            }
        }
    }
    return {};
}

} // namespace framelet
