#include "client/web/page_session.h"

#include <algorithm>
#include <exception>
#include <utility>

#include <nlohmann/json.hpp>

#include "client/viewer/lacks.h"
#include "common/error.h"
#include "protocol/messages/message_codec.h"
#include "protocol/stream/message_frame.h"

namespace framelet {

PageSession::PageSession(std::string token, std::function<void(Bytes)> send)
    : connection_{{}, std::move(send), false}, token_(std::move(token)) {}

void PageSession::open() {
    inbox_ = {};
    is_welcome_ = false;
    Hello hello{protocol_version, token_, coding::all};
    if (core_) {
        connection_.handlers.on_asking(hello);
    }
    connection_.send(frame_of(hello));
}

bool PageSession::receive(ByteView bytes) {
    try {
        inbox_.add(bytes);
        while (auto const body = inbox_.next()) {
            take(decode_message(*body));
        }
        return true;
    } catch (std::exception const& error) {
        reason_ = error.what();
        return false;
    }
}

void PageSession::take(Message message) {
    if (auto const* failure = std::get_if<Failure>(&message)) {
        is_refused_ = !is_welcome_ && !failure->again;
        throw ConnectionError(failure->text);
    }
    if (is_welcome_) {
        connection_.handlers.on_message(std::move(message));
    } else if (auto* greeting = std::get_if<Welcome>(&message)) {
        welcome(std::move(*greeting));
    } else {
        throw ProtocolError("no Welcome");
    }
}

void PageSession::welcome(Welcome greeting) {
    if (greeting.version != protocol_version) {
        is_refused_ = true;
        throw ConnectionError("this page is not the server's own any more: load it again");
    }
    is_welcome_ = true;
    inbox_.take_large();
    connection_.is_open = true;
    reason_.clear();
    back_off_.reset();
    if (core_) {
        connection_.handlers.on_reopened(std::move(greeting));
    } else {
        connection_.welcome = std::move(greeting);
        PageConnectionOptions options;
        options.page = &connection_;
        core_ = std::make_unique<ClientCore>(options);
        core_->set_settings(settings_);
        set_smooth(is_smooth_);
        set_drawn_over(drawn_over_);
    }
    if (scene_number_ != core_->scene_number()) {
        scene_number_ = core_->scene_number();
        Welcome const scene = core_->welcome();
        hand_.emplace(scene.start_camera, scene.scene_bounds);
        scene_camera_ = start_scene_camera(scene);
        forget_bookmarks();
    }
}

void PageSession::note_sent(bool all) {
    bool const is_news = all && !connection_.all_sent;
    connection_.all_sent = all;
    if (is_news && core_) {
        connection_.handlers.on_sent();
    }
}

std::optional<double> PageSession::close(std::string const& reason, double chance) {
    bool const was_open = std::exchange(connection_.is_open, false);
    connection_.all_sent = true;
    if (reason_.empty()) {
        reason_ = reason;
    }
    if (was_open && core_) {
        connection_.handlers.on_interrupted(reason_);
    }
    return is_refused_ ? std::nullopt : std::optional(back_off_.next(chance));
}

void PageSession::set_settings(ViewerSettings const& settings) {
    settings_ = settings;
    if (core_) {
        core_->set_settings(settings_);
    }
}

void PageSession::set_smooth(bool is_smooth) {
    is_smooth_ = is_smooth;
    if (core_) {
        core_->set_smoothing(is_smooth ? usual_lag_seconds : 0);
    }
}

void PageSession::set_drawn_over(DrawnOver what) {
    drawn_over_ = what;
    is_overlay_new_ = true;
    if (core_) {
        core_->set_drawn_over(what);
    }
}

bool PageSession::update_picture() {
    core_->set_view(hand_->camera(), viewport_, scene_camera_);
    bool const draws = drawn_over_ != DrawnOver::nothing; // which is done in memory
    bool const changed = core_->update_picture(picture_, changed_, {}, draws ? nullptr : painter_.canvas.get());
    bool const fades = core_->overlay_fades(); // it is drawn once more when it has faded
    bool const is_drawn_anew = (std::exchange(is_overlay_new_, fades) || fades) && !picture_.rgba.empty();
    if (draws && (changed || is_drawn_anew)) {
        overlaid_ = picture_;
        core_->draw_overlay(overlaid_);
    }
    return changed || is_drawn_anew;
}

void PageSession::show_picture() {
    if (core_->is_on_canvas()) {
        painter_.canvas->show();
    } else {
        screen_->show(drawn_over_ == DrawnOver::nothing ? picture_ : overlaid_);
    }
}

bool PageSession::set_screen(Painter wanted) {
    painter_ = choose_canvas(wanted);
    if (painter_.canvas) {
        screen_ = std::make_unique<PageScreen>();
    }
    return has_screen();
}

void PageSession::drop_screen() {
    painter_ = processor_paints("there is no WebGL 2");
    screen_.reset();
    picture_ = {}; // the next screen is blank: the next picture is made as a whole
}

Picture const& PageSession::picture() {
    if (painter_.canvas && core_->is_on_canvas()) {
        painter_.canvas->read(picture_);
    }
    return drawn_over_ == DrawnOver::nothing ? picture_ : overlaid_;
}

std::string PageSession::state() const {
    nlohmann::json out{{"reason", reason_},
                       {"refused", is_refused_},
                       {"painter", painter_.painter},
                       {"size", {picture_.width, picture_.height}}};
    if (core_) {
        Welcome const scene = core_->welcome();
        ClockState const clock = core_->clock();
        ClientStatistics const statistics = core_->statistics();
        nlohmann::json cameras = nlohmann::json::array();
        for (SceneCameraInfo const& camera : scene.cameras) {
            cameras.push_back(camera.name);
        }
        nlohmann::json bookmarks = nlohmann::json::array();
        for (Bookmark const& bookmark : bookmarks_) {
            bookmarks.push_back(bookmark.name);
        }
        out.update({{"scene", scene.scene_name},
                    {"scene_number", scene_number_},
                    {"scene_source", std::to_string(scene.scene_source)}, // too large for JavaScript's numbers
                    {"cameras", std::move(cameras)},
                    {"camera", scene_camera_},
                    {"bookmarks", std::move(bookmarks)},
                    {"bookmark", is_at_bookmark_ ? bookmark_ : -1},
                    {"drawn_over", name_of(drawn_over_)},
                    {"smoothing_lacks", smoothing_lacks(scene.animation_duration > 0, settings_.reproject)},
                    {"lag", statistics.lag_seconds},
                    {"duration", scene.animation_duration},
                    {"time", clock.time},
                    {"playing", clock.playing},
                    {"exposure", settings_.exposure_ev},
                    {"controls", core_->controls()},
                    {"complete", core_->is_complete()},
                    {"quality", name_of(statistics.state())},
                    {"seconds", statistics.seconds},
                    {"pictures", statistics.pictures},
                    {"bytes", statistics.bytes},
                    {"samples", statistics.samples},
                    {"reconstruct_seconds", statistics.reconstruct_seconds},
                    {"round_trip_seconds", statistics.round_trip_seconds},
                    {"first_picture_seconds", statistics.first_picture_seconds},
                    {"reconnections", statistics.reconnections}});
    }
    return out.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

} // namespace framelet
