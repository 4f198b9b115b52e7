// What painter.js and network.js call, each in an instance of its own, by plain C functions: embind makes code from
// text, which the page's content policy forbids.
#include <cstdint>
#include <memory>
#include <string>

#include <emscripten.h>

#include <nlohmann/json.hpp>

#include "client/core/camera/axis_views.h"
#include "client/core/drawn_over/age_colors.h"
#include "client/viewer/legend.h"
#include "client/web/batch_answers.h"
#include "client/web/page_session.h"
#include "common/error.h"
#include "protocol/stream/message_frame.h"

namespace framelet {
namespace {

std::unique_ptr<PageSession> session; // the painter's one; JavaScript holds no C++ objects
BatchAnswers answers; // the network's, of the socket that is open
std::string text; // what was returned last

// Copies: a frame's memory is gone when the socket sends it.
EM_JS(void, send_bytes, (std::byte const* data, std::size_t size), { Module.send(HEAPU8.slice(data, data + size)); })

ClientCore* core() {
    return session ? session->core() : nullptr;
}

/// Keeps what is returned. Empty where there is no core.
template <class Make>
char const* say(Make const& make) {
    text = core() == nullptr ? "" : make();
    return text.c_str();
}

void request_clock(std::uint8_t field, ClockState const& state) {
    if (core() != nullptr) {
        core()->request_clock({field, state});
    }
}

} // namespace
} // namespace framelet

using namespace framelet;

extern "C" {

/// The network's: the page is left for good, so that the server keeps nothing for it.
EMSCRIPTEN_KEEPALIVE void page_say_goodbye() {
    Bytes const frame = frame_of(Failure{"it was closed"});
    send_bytes(frame.data(), frame.size());
}
/// The network's: a socket has opened.
EMSCRIPTEN_KEEPALIVE void page_answer_anew() {
    answers = {};
}
/// Sends the answers to what has come at this time, milliseconds.
EMSCRIPTEN_KEEPALIVE void page_answer(std::byte const* data, std::size_t size, double now) {
    Bytes const frames = answers.answer({data, size}, static_cast<std::uint64_t>(1000 * now));
    if (!frames.empty()) {
        send_bytes(frames.data(), frames.size());
    }
}

EMSCRIPTEN_KEEPALIVE void page_begin(char const* token) {
    session = std::make_unique<PageSession>(token, [](Bytes const& frame) { send_bytes(frame.data(), frame.size()); });
}
EMSCRIPTEN_KEEPALIVE void page_open() {
    session->open();
}
EMSCRIPTEN_KEEPALIVE bool page_receive(std::byte const* data, std::size_t size) {
    return session->receive({data, size});
}
EMSCRIPTEN_KEEPALIVE void page_note_sent(bool all) {
    session->note_sent(all);
}
/// Seconds until another socket is to be opened; -1: never.
EMSCRIPTEN_KEEPALIVE double page_close(char const* reason, double chance) {
    return session->close(reason, chance).value_or(-1);
}

/// Shows pictures by the WebGL context that is current. False where the processor is to paint.
EMSCRIPTEN_KEEPALIVE bool page_set_screen(char const* painter) {
    try {
        return session->set_screen(parse_painter(painter));
    } catch (InputError const&) { // of what the address says
        return session->set_screen(Painter::automatic);
    }
}
EMSCRIPTEN_KEEPALIVE void page_drop_screen() {
    session->drop_screen();
}

/// 1 where there is a new picture, -1 where WebGL has failed.
EMSCRIPTEN_KEEPALIVE int page_paint(int width, int height) {
    if (core() == nullptr) {
        return 0;
    }
    session->set_viewport({width, height});
    try {
        return session->update_picture() ? 1 : 0;
    } catch (CanvasError const&) {
        return -1;
    }
}
EMSCRIPTEN_KEEPALIVE void page_show() {
    session->show_picture();
}
EMSCRIPTEN_KEEPALIVE std::uint8_t const* page_pixels() {
    return session->picture().rgba.data();
}
EMSCRIPTEN_KEEPALIVE int page_width() {
    return session->picture_size().width;
}
EMSCRIPTEN_KEEPALIVE int page_height() {
    return session->picture_size().height;
}
EMSCRIPTEN_KEEPALIVE char const* page_state() {
    text = session->state();
    return text.c_str();
}

EMSCRIPTEN_KEEPALIVE void page_orbit(float x, float y) {
    if (core() != nullptr) {
        session->take_hand().orbit({x, y}, session->viewport());
    }
}
EMSCRIPTEN_KEEPALIVE void page_pan(float x, float y) {
    if (core() != nullptr) {
        session->take_hand().pan({x, y}, session->viewport());
    }
}
EMSCRIPTEN_KEEPALIVE void page_dolly(float steps) {
    if (core() != nullptr) {
        session->take_hand().dolly(steps);
    }
}
EMSCRIPTEN_KEEPALIVE void page_fit() {
    if (core() != nullptr) {
        session->take_hand().fit(session->viewport());
    }
}
/// Turns to what is seen at this pixel, and goes half of the way there.
EMSCRIPTEN_KEEPALIVE void page_focus(float x, float y) {
    if (core() != nullptr) {
        if (auto const point = core()->point_at({x, y})) {
            session->take_hand().focus(*point);
        }
    }
}
/// A camera of the scene; -1: the user's own, from where the picture is seen from.
EMSCRIPTEN_KEEPALIVE void page_camera(int number) {
    if (core() != nullptr && number < 0) {
        session->take_hand();
    } else if (core() != nullptr) {
        session->choose_camera(number);
    }
}
EMSCRIPTEN_KEEPALIVE void page_play(bool playing) {
    ClockState state;
    state.playing = playing;
    request_clock(ClockRequest::playing, state);
}
EMSCRIPTEN_KEEPALIVE void page_seek(double seconds) {
    ClockState state;
    state.time = seconds;
    request_clock(ClockRequest::time, state);
}
EMSCRIPTEN_KEEPALIVE void page_exposure(float stops) {
    ViewerSettings settings = session->settings();
    settings.exposure_ev = stops;
    session->set_settings(settings);
}
EMSCRIPTEN_KEEPALIVE void page_pause(bool paused) {
    ViewerSettings settings = session->settings();
    settings.paused = paused;
    session->set_settings(settings);
}
/// Shows the scene a little late, and smooth, or not.
EMSCRIPTEN_KEEPALIVE void page_smooth(bool smooth) {
    session->set_smooth(smooth);
}
/// Draws the overlay of this name over the picture; of another name, nothing.
EMSCRIPTEN_KEEPALIVE void page_overlay(char const* name) {
    session->set_drawn_over(drawn_over_of(name).value_or(DrawnOver::nothing));
}
/// What can be drawn over the picture, JSON: {"overlays": [{"name": ..., "tip": ..., and of those that have a legend
/// "title", "newest", "oldest", "remark"}, ...], "colors": [[red, green, blue] from newest to oldest, ...]}.
EMSCRIPTEN_KEEPALIVE char const* page_overlays() {
    nlohmann::json overlays = nlohmann::json::array();
    for (std::size_t i = 0; i < drawn_over_names.size(); ++i) {
        auto const kind = static_cast<DrawnOver>(i);
        nlohmann::json entry{{"name", name_of(kind)}, {"tip", overlay_tip(kind)}};
        if (auto const legend = legend_of(kind)) {
            entry.update({{"title", legend->title},
                          {"newest", legend->newest},
                          {"oldest", legend->oldest},
                          {"remark", legend->remark}});
        }
        overlays.push_back(std::move(entry));
    }
    nlohmann::json colors = nlohmann::json::array();
    for (int i = 0; i <= 9; ++i) {
        colors.push_back(age_color(static_cast<float>(i) / 9));
    }
    text = nlohmann::json{{"colors", std::move(colors)}, {"overlays", std::move(overlays)}}.dump();
    return text.c_str();
}
/// x right, y up, z backwards, 1: the whole speed.
EMSCRIPTEN_KEEPALIVE void page_fly(float x, float y, float z, bool fast, double seconds) {
    if (core() != nullptr) {
        session->take_hand().fly({{x, y, z}, {0, 0}, fast}, seconds);
    }
}
/// One of `axis_views`, with all of the scene in the picture.
EMSCRIPTEN_KEEPALIVE void page_look_along(unsigned number) {
    if (core() != nullptr && number < axis_views.size()) {
        session->take_hand().look_along(axis_views[number].forward, axis_views[number].up);
        session->take_hand().fit(session->viewport());
    }
}
EMSCRIPTEN_KEEPALIVE void page_projection() {
    if (core() != nullptr) {
        session->take_hand().toggle_projection();
    }
}
/// The view as a camera file has it; empty: there is none.
EMSCRIPTEN_KEEPALIVE char const* page_view() {
    return say([] { return session->view(); });
}
/// Goes to such a view. Returns why not, empty where it could.
EMSCRIPTEN_KEEPALIVE char const* page_go_to(char const* view) {
    return say([view] {
        try {
            session->go_to(view);
            return std::string();
        } catch (InputError const& error) {
            return std::string(error.what());
        }
    });
}
/// Takes the scene's bookmarks from a text as `page_bookmarks` has it. Returns what is wrong with it; else empty.
EMSCRIPTEN_KEEPALIVE char const* page_load_bookmarks(char const* bookmarks) {
    return say([bookmarks] { return session->load_bookmarks(bookmarks); });
}
EMSCRIPTEN_KEEPALIVE char const* page_bookmarks() {
    return say([] { return session->bookmarks(); });
}
/// Adds the view that is shown; this and the next two return what is to be said.
EMSCRIPTEN_KEEPALIVE char const* page_add_bookmark() {
    return say([] { return session->add_bookmark(); });
}
EMSCRIPTEN_KEEPALIVE char const* page_remove_bookmark() {
    return say([] { return session->remove_bookmark(); });
}
EMSCRIPTEN_KEEPALIVE char const* page_go_to_bookmark(int number) {
    return say([number] { return session->go_to_bookmark(number); });
}
}
