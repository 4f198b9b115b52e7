#include "client/web/page_session.h"

#include <algorithm>
#include <cstring>
#include <exception>
#include <utility>

#include <nlohmann/json.hpp>

#include "common/error.h"
#include "protocol/messages/message_codec.h"
#include "protocol/stream/message_frame.h"

namespace framelet {

PageSession::PageSession(std::string token, std::function<void(Bytes)> send)
    : connection_{{}, std::move(send), false}, token_(std::move(token)) {}

void PageSession::open() {
    inbox_.clear();
    is_welcome_ = false;
    Hello hello{protocol_version, token_, coding::all};
    if (core_) {
        connection_.handlers.on_asking(hello);
    }
    connection_.send(frame_of(hello));
}

bool PageSession::receive(ByteView bytes) {
    inbox_.insert(inbox_.end(), bytes.begin(), bytes.end());
    try {
        take_frames();
        return true;
    } catch (std::exception const& error) {
        reason_ = error.what();
        return false;
    }
}

void PageSession::take_frames() {
    std::size_t at = 0;
    FramePrefix prefix;
    while (inbox_.size() - at >= prefix.size()) {
        std::memcpy(prefix.data(), inbox_.data() + at, prefix.size());
        std::size_t const size = body_size(prefix);
        if (size > (is_welcome_ ? max_message_bytes : max_upstream_message_bytes)) {
            throw ProtocolError("a message that is too long");
        }
        if (inbox_.size() - at - prefix.size() < size) {
            break;
        }
        take(decode_message(ByteView(inbox_).subspan(at + prefix.size(), size)));
        at += prefix.size() + size;
    }
    inbox_.erase(inbox_.begin(), inbox_.begin() + static_cast<std::ptrdiff_t>(at));
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
    }
    if (scene_number_ != core_->scene_number()) {
        scene_number_ = core_->scene_number();
        Welcome const scene = core_->welcome();
        hand_.emplace(scene.start_camera, scene.scene_bounds);
        scene_camera_ = start_scene_camera(scene);
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

void PageSession::choose_camera(int number) {
    if (number >= 0 && number < static_cast<int>(core_->welcome().cameras.size())) {
        scene_camera_ = number;
    }
}

void PageSession::set_settings(ViewerSettings const& settings) {
    settings_ = settings;
    if (core_) {
        core_->set_settings(settings_);
    }
}

CameraController& PageSession::take_hand() {
    if (scene_camera_ >= 0) {
        hand_->set_camera(core_->shown_camera());
        scene_camera_ = -1;
    }
    return *hand_;
}

bool PageSession::update_picture() {
    core_->set_view(hand_->camera(), viewport_, scene_camera_);
    return core_->update_picture(picture_, changed_);
}

std::string PageSession::state() const {
    nlohmann::json out{{"reason", reason_}, {"refused", is_refused_}};
    if (core_) {
        Welcome const scene = core_->welcome();
        ClockState const clock = core_->clock();
        ClientStatistics const statistics = core_->statistics();
        nlohmann::json cameras = nlohmann::json::array();
        for (SceneCameraInfo const& camera : scene.cameras) {
            cameras.push_back(camera.name);
        }
        out.update({{"scene", scene.scene_name},
                    {"cameras", std::move(cameras)},
                    {"camera", scene_camera_},
                    {"duration", scene.animation_duration},
                    {"time", clock.time},
                    {"playing", clock.playing},
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
