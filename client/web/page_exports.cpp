// What worker.js calls, by plain C functions: embind makes code from text, which the page's content policy forbids.
#include <cstdint>
#include <memory>
#include <string>

#include <emscripten.h>

#include "client/web/page_session.h"

namespace framelet {
namespace {

std::unique_ptr<PageSession> session; // the module's one; JavaScript holds no C++ objects
std::string text; // what was returned last

// Copies: a frame's memory is gone when the socket sends it.
EM_JS(void, send_bytes, (std::byte const* data, std::size_t size), { Module.send(HEAPU8.slice(data, data + size)); })

ClientCore* core() {
    return session ? session->core() : nullptr;
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

/// True where there is a new picture.
EMSCRIPTEN_KEEPALIVE bool page_paint(int width, int height) {
    if (core() == nullptr) {
        return false;
    }
    session->set_viewport({width, height});
    return session->update_picture();
}
EMSCRIPTEN_KEEPALIVE std::uint8_t const* page_pixels() {
    return session->picture().rgba.data();
}
EMSCRIPTEN_KEEPALIVE int page_width() {
    return session->picture().width;
}
EMSCRIPTEN_KEEPALIVE int page_height() {
    return session->picture().height;
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
EMSCRIPTEN_KEEPALIVE void page_camera(int number) {
    if (core() != nullptr) {
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
EMSCRIPTEN_KEEPALIVE void page_settings(float exposure_ev, bool paused) {
    ViewerSettings settings;
    settings.exposure_ev = exposure_ev;
    settings.paused = paused;
    session->set_settings(settings);
}
}
