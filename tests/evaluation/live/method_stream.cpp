#include "tests/evaluation/live/method_stream.h"

#include <utility>

#include "common/cpu_clock.h"

namespace framelet::bench {

MethodStream::MethodStream(std::string name, BenchScene& scene, MethodSetup setup)
    : name_(std::move(name)), scene_(scene), setup_(std::move(setup)) {}

void MethodStream::take(StreamEvent const& event) {
    if (auto const* const camera = std::get_if<CameraUpdate>(&event.what)) {
        if (!method_ || setup_.viewport != camera->view.viewport) {
            setup_.viewport = camera->view.viewport;
            method_ = make_method(name_, setup_);
        }
        view_ = camera->view;
        scene_camera_ = camera->scene_camera;
    } else if (auto const* const ack = std::get_if<Ack>(&event.what)) {
        while (!in_flight_.empty() && in_flight_.front().first <= ack->batch) {
            method_->answered(event.seconds, 1e-6 * static_cast<double>(ack->received_us));
            delivered_.push_back({in_flight_.front().second, 0});
            in_flight_.pop_front();
        }
    } else if (auto const* const sent = std::get_if<BatchSent>(&event.what)) {
        method_->sent(event.seconds, static_cast<double>(sent->bytes));
        for (auto& [number, bytes] : in_flight_) {
            bytes = number == sent->batch ? static_cast<double>(sent->bytes) : bytes;
        }
    }
    idle_of_.reset();
}

Step MethodStream::plan(Turn const& turn, PosedScene& scene) {
    if (!method_) {
        return Step::nothing;
    }
    SceneTime const present = scene.is_animated() ? turn.present : 0;
    ViewState const state{view_, 1, present};
    idle_ = idle_of_ && same_picture(*idle_of_, state);
    if (idle_) {
        return Step::nothing;
    }
    if (in_flight_.size() >= method_->window().messages || !method_->has_room(turn.now)) {
        return Step::wait;
    }
    turn_ = turn;
    turn_.present = present;
    figures_ = {};
    return Step::render;
}

void MethodStream::render(PosedScene const&) {
    pose_at(scene_, turn_.present);
    NumberedView view = view_;
    if (scene_camera_ >= 0) {
        view.camera = scene_.camera;
    }
    double const begun = cpu_seconds_of(CLOCK_PROCESS_CPUTIME_ID);
    ServerStep step = method_->produce({scene_, turn_.present, turn_.now, view, 0, delivered_});
    gather_light(step.samples, cpu_seconds_of(CLOCK_PROCESS_CPUTIME_ID) - begun);
    delivered_.clear();
    figures_.rays = step.samples;
    if (step.message.empty() && step.samples == 0) {
        idle_of_ = ViewState{view_, 1, turn_.present};
    }
    std::scoped_lock const lock(mutex_);
    rendered_.push_back({std::move(step), view_, turn_.present});
}

/// Learns light for the share of time that framelet's own streams learn, where the scene has a light cache.
void MethodStream::gather_light(std::size_t samples, double samples_took) {
    if (LightGathering* const gathering = scene_.posed->light_gathering()) {
        gathering->work(gathering->paths_beside(samples), LightCache::Use::recent, samples, samples_took);
    }
}

bool MethodStream::learn(PosedScene&) {
    {
        std::scoped_lock const lock(mutex_);
        learnt_ = std::move(rendered_.front());
        rendered_.pop_front();
    }
    if (learnt_.step.message.empty()) {
        return false;
    }
    in_flight_.push_back({++number_, static_cast<double>(learnt_.step.message.size())});
    return true;
}

EncodedBatch MethodStream::encode() {
    EncodedBatch batch;
    batch.number = number_;
    batch.moment = {learnt_.view, learnt_.time};
    batch.payload = std::move(learnt_.step.message);
    return batch;
}

} // namespace framelet::bench
