#include "tests/evaluation/paused_viewer.h"

#include <algorithm>

namespace framelet::bench {

PausedViewer::PausedViewer(BenchScene& scene, Viewport viewport, double rate, SceneTime start)
    : scene_(scene), rate_(rate), stream_({.exposure = scene.exposure}, coding::all), clock_{start, false, 1},
      known_clock_(clock_) {
    view_.viewport = viewport;
    tell(ViewerSettings{});
}

SceneTime PausedViewer::time_at(double now) const {
    return clock_.playing ? clock_.time + (now - clock_set_) * static_cast<double>(clock_.speed) : clock_.time;
}

void PausedViewer::tell(decltype(StreamEvent::what) what) {
    events_.push_back({now_ + delay, std::move(what)});
}

void PausedViewer::look(Camera const& camera, int scene_camera) {
    ++view_.number;
    view_.camera = camera;
    scene_camera_ = scene_camera;
    tell(CameraUpdate{view_, scene_camera_});
}

void PausedViewer::resize(Viewport viewport) {
    view_.viewport = viewport;
    view_.held_since = view_.number + 1;
    look(view_.camera, scene_camera_);
}

void PausedViewer::set_clock(ClockState const& clock) {
    clock_ = clock;
    clock_set_ = now_;
    clock_known_from_ = now_ + delay;
    events_.push_front({now_, ClockChanged{}});
}

void PausedViewer::run(double seconds) {
    double const until = now_ + seconds;
    while (now_ < until) {
        advance(until);
    }
}

bool PausedViewer::run_until_complete(double most_seconds) {
    double const until = now_ + most_seconds;
    while (now_ < until) {
        advance(until);
        if (is_settled()) {
            show();
            return true;
        }
    }
    return false;
}

/// Goes on to what happens next: a turn of the server, a batch that arrives, a picture.
void PausedViewer::advance(double until) {
    double const arrival = batches_.empty() ? until : batches_.front().arrives;
    now_ = std::min({until, server_free_, next_picture_, arrival});
    if (clock_known_from_ <= now_) {
        known_clock_ = clock_;
        known_clock_set_ = clock_set_;
    }
    while (!batches_.empty() && batches_.front().arrives <= now_) {
        receive();
    }
    if (server_free_ <= now_) {
        take_turn();
    }
    if (next_picture_ <= now_) {
        show();
        next_picture_ += frame;
    }
}

void PausedViewer::take_turn() {
    while (!events_.empty() && events_.front().seconds <= now_) {
        if (auto const* const camera = std::get_if<CameraUpdate>(&events_.front().what)) {
            seen_number_ = camera->view.number;
        }
        stream_.take(events_.front());
        events_.pop_front();
    }
    PosedScene& scene = *scene_.posed;
    double const pixels = static_cast<double>(view_.viewport.width) * view_.viewport.height;
    double const rate = rate_ * pixels;
    double const speed = clock_.playing ? static_cast<double>(clock_.speed) : 0;
    server_free_ = now_ + least_turn;
    Step const step = stream_.plan({now_, time_at(now_), speed, rate, least_turn}, scene);
    if (step != Step::render) {
        if (is_unlearnt_) {
            finish();
        }
        is_unlearnt_ = false;
        return;
    }
    double const rays = static_cast<double>(stream_.planned_figures().rays);
    samples_ += rays;
    server_free_ = now_ + std::max(rays / rate, least_turn);
    scene.pose(stream_.moment());
    stream_.render(scene);
    if (is_unlearnt_) {
        finish();
    }
    is_unlearnt_ = true;
}

/// Learns and sends what was rendered before the last plan.
void PausedViewer::finish() {
    if (stream_.learn(*scene_.posed)) {
        EncodedBatch batch = stream_.encode();
        stream_.take({now_, BatchSent{stream_.last_batch(), batch.payload.size()}});
        batches_.push_back({now_ + delay, std::move(batch)});
    }
}

void PausedViewer::receive() {
    Batch const batch = codec_.decode(batches_.front().batch, &received_);
    batches_.pop_front();
    PictureMaker& maker = pictures_.prepare(view_, {});
    if (batch.view.held_since == view_.held_since) {
        maker.insert(batch);
    }
    std::vector<SentTile> evicted;
    maker.take_evicted(evicted);
    if (!evicted.empty()) {
        tell(Evicted{std::move(evicted)});
    }
    tell(Ack{batch.number, static_cast<std::uint64_t>(1e6 * now_), 0});
}

bool PausedViewer::is_settled() const {
    return stream_.is_complete() && !is_unlearnt_ && batches_.empty() && seen_number_ == view_.number &&
           clock_known_from_ <= now_ && !clock_.playing;
}

void PausedViewer::show() {
    double const speed = known_clock_.playing ? static_cast<double>(known_clock_.speed) : 0;
    SceneTime const time = known_clock_.time + (now_ - known_clock_set_) * speed;
    pictures_.prepare(view_, {});
    pictures_.show({view_.camera, view_.number, scene_camera_, time, speed, now_, is_settled()}, picture_, changed_);
}

} // namespace framelet::bench
