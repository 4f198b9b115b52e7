#include "client/client_core.h"

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <utility>

#include "client/confidence_colors.h"
#include "client/framelet_outlines.h"
#include "client/server_connection.h"
#include "client/smooth_view.h"
#include "common/error.h"
#include "common/framelet_cache.h"
#include "common/reconstruction.h"
#include "common/reprojector.h"
#include "common/scene_smoother.h"
#include "protocol/batch_codec.h"

namespace framelet {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_between(Clock::time_point from, Clock::time_point to) {
    return std::chrono::duration<double>(to - from).count();
}

double ratio(double amount, std::uint64_t count) {
    return count == 0 ? 0 : amount / static_cast<double>(count);
}

/// A batch's number, view, scene time and length prefix on the wire, about.
constexpr std::size_t batch_header_bytes = 96;

} // namespace

double ClientStatistics::bytes_per_sample() const {
    return ratio(static_cast<double>(bytes), samples);
}

double ClientStatistics::decode_ns_per_sample() const {
    return ratio(decode_seconds * 1e9, samples);
}

double ClientStatistics::reconstruct_ns_per_pixel() const {
    return ratio(reconstruct_seconds * 1e9, pixels);
}

struct ClientCore::Impl {
    struct SentCamera {
        std::uint64_t number;
        Clock::time_point time;
    };
    static constexpr std::size_t most_sent_cameras = 256;

    std::function<void()> on_news;
    Clock::time_point const start = Clock::now();
    BatchCodec codec; // the connection's thread only
    HeldPicture held; // the same
    Batch received_batch; // the same: the last one, whose memory the next one gets, at most some 200 MB

    mutable std::mutex mutex; // guards all that follows, but the connection
    std::condition_variable news_arrived;
    bool news = false;
    std::optional<CameraUpdate> waiting_view;
    CameraUpdate view; ///< the newest, sent or not
    std::deque<SentCamera> sent_cameras;
    std::optional<Clock::time_point> first_camera_time;
    std::optional<FrameletCache> cache;
    std::uint64_t cache_generation = 0;
    std::uint64_t shown_generation = 0;
    std::uint8_t const* shown_pixels = nullptr; ///< recognises the caller's picture
    std::uint64_t last_batch = 0;
    Camera shown_camera; ///< of the newest batch
    SceneTime shown_time = 0;
    bool reproject = true;
    BodyMotions motions;
    Reprojector reprojector;
    LateClock late_clock{0};
    CameraTrack batch_cameras; ///< only while the scene is smoothed
    std::optional<SceneSmoother> smoother;
    Camera pictured_camera; ///< what the picture shows
    SceneTime pictured_time = 0; ///< the same
    std::vector<PixelRect> arrived; ///< scratch: where batches have changed something
    Status status;
    Clock::time_point status_time = start;
    std::optional<std::string> end_reason;
    ClientStatistics statistics;

    std::unique_ptr<ServerConnection> connection; // last: its thread uses the rest

    explicit Impl(ConnectionOptions const& options, std::function<void()> news_handler)
        : on_news(std::move(news_handler)) {
        ServerConnection::Handlers handlers;
        handlers.on_message = [this](Message message) { receive(std::move(message)); };
        handlers.on_lost = [this](std::string reason) {
            {
                std::lock_guard const lock(mutex);
                end_reason = std::move(reason);
            }
            tell_news();
        };
        handlers.on_sent = [this] {
            std::lock_guard const lock(mutex);
            send_waiting_view();
        };
        connection = std::make_unique<ServerConnection>(options, std::move(handlers));
        std::lock_guard const lock(mutex);
        shown_camera = connection->welcome().start_camera;
        if (status_time == start) { // no Status has come yet
            status.clock = connection->welcome().clock;
        }
    }

    void tell_news() {
        {
            std::lock_guard const lock(mutex);
            news = true;
        }
        news_arrived.notify_all();
        if (on_news) {
            on_news();
        }
    }

    /// One camera in the network's queue at most: a newer one replaces it while it waits. Under the lock.
    void send_waiting_view() {
        if (!waiting_view || !connection || !connection->all_sent()) {
            return;
        }
        Clock::time_point const now = Clock::now();
        if (!first_camera_time) {
            first_camera_time = now;
        }
        sent_cameras.push_back({waiting_view->view.number, now});
        if (sent_cameras.size() > most_sent_cameras) {
            sent_cameras.pop_front();
        }
        ++statistics.cameras_sent;
        connection->send(*waiting_view);
        waiting_view.reset();
    }

    void receive(Message message) {
        if (auto const* encoded = std::get_if<EncodedBatch>(&message)) {
            receive_batch(*encoded);
        } else if (auto const* news_of_server = std::get_if<Status>(&message)) {
            std::lock_guard const lock(mutex);
            status = *news_of_server;
            status_time = Clock::now();
            statistics.converged = status.converged;
            statistics.server_samples_per_second = status.samples_per_second;
        } else {
            throw ProtocolError("a message that only a viewer sends");
        }
        tell_news();
    }

    void receive_batch(EncodedBatch const& encoded) {
        Clock::time_point const received = Clock::now();
        {
            std::lock_guard const lock(mutex);
            if (view.view.number == 0) {
                ++statistics.stale_batches; // nobody has asked for a picture yet
                return;
            }
        }
        codec.decode(encoded, &held, received_batch);
        Clock::time_point const decoded = Clock::now();
        Ack ack{received_batch.number, 0, 0};
        ack.received_us = static_cast<std::uint64_t>(
            std::chrono::duration_cast<std::chrono::microseconds>(received.time_since_epoch()).count());
        ack.decode_us = static_cast<std::uint32_t>(std::min(seconds_between(received, decoded) * 1e6, 4e9));
        {
            std::lock_guard const lock(mutex);
            take_in(received_batch);
            statistics.bytes += encoded.payload.size() + encoded.tiles.size() * sizeof(Tile) + batch_header_bytes;
            statistics.decode_seconds += seconds_between(received, decoded);
            note_round_trip(received_batch.view.number, received);
        }
        connection->send(ack);
    }

    /// Under the lock.
    void take_in(Batch const& batch) {
        ++statistics.batches;
        statistics.framelets += batch.framelets.size();
        statistics.samples += batch.framelets.size() * framelet_samples;
        last_batch = std::max(last_batch, batch.number);
        if (!cache || batch.view.viewport != cache->plane().viewport()) {
            ++statistics.stale_batches;
            return;
        }
        shown_camera = batch.view.camera;
        shown_time = batch.scene_time;
        Clock::time_point const before = Clock::now();
        cache->insert(batch);
        if (smoother) {
            smoother->insert(batch);
            batch_cameras.add(batch.scene_time, batch.view.camera);
        }
        for (BodyTrack const& track : batch.tracks) {
            motions.extend(track);
        }
        statistics.insert_seconds += seconds_between(before, Clock::now());
        if (statistics.full_picture_seconds < 0 && first_camera_time && cache->coverage() >= 1) {
            statistics.full_picture_seconds = seconds_between(*first_camera_time, Clock::now());
        }
    }

    /// Under the lock.
    ClockState clock_now() const {
        ClockState out = status.clock;
        if (out.playing) {
            double const elapsed = seconds_between(status_time, Clock::now());
            out.time = std::clamp(out.time + elapsed * static_cast<double>(out.speed), 0.0, max_scene_time);
        }
        return out;
    }

    bool scene_moves() const { return connection->welcome().animation_duration > 0; }

    /// Where the scene is to be smoothed, from here on. Under the lock.
    void restart_smoothing() {
        smoother.reset();
        batch_cameras = {};
        late_clock = LateClock(late_clock.lag_seconds());
        shown_pixels = nullptr; // all of it anew
        if (late_clock.lag_seconds() > 0 && reproject && cache && scene_moves()) {
            smoother.emplace(cache->plane());
        }
    }

    /// What the picture is to be of: the newest camera and the present, or what is late by the lag. Where the server
    /// moves the camera, what its newest batch shows, or what came before it. Under the lock.
    std::pair<Camera, SceneTime> wanted_picture() {
        bool const own_camera = view.scene_camera < 0;
        if (smoother) {
            SceneTime const time = late_clock.read(seconds_between(start, Clock::now()), clock_now().time);
            if (own_camera || batch_cameras.empty()) {
                return {own_camera ? view.view.camera : shown_camera, time};
            }
            SceneTime const known = std::min(time, shown_time);
            return {batch_cameras.at(known), known};
        }
        if (own_camera) {
            return {view.view.camera, scene_moves() ? clock_now().time : 0};
        }
        return {shown_camera, shown_time};
    }

    /// Under the lock. `changed` is what has changed in the cache, and becomes what may differ in the picture.
    void draw(Picture& picture, std::vector<PixelRect>& changed) {
        if (!reproject) {
            reconstruct(*cache, changed, picture);
            return;
        }
        auto const [camera, time] = wanted_picture();
        pictured_camera = camera;
        pictured_time = time;
        arrived.swap(changed);
        if (smoother) {
            SceneTime const lag = late_clock.lag_seconds() * std::abs(static_cast<double>(status.clock.speed));
            smoother->show(*cache, arrived, camera, time, lag, motions, picture, changed);
        } else {
            reprojector.show(*cache, arrived, camera, time, motions, picture, changed);
        }
    }

    /// Under the lock.
    void note_round_trip(std::uint64_t camera_number, Clock::time_point received) {
        std::optional<double> seconds;
        while (!sent_cameras.empty() && sent_cameras.front().number <= camera_number) {
            if (sent_cameras.front().number == camera_number) {
                seconds = seconds_between(sent_cameras.front().time, received);
            }
            sent_cameras.pop_front();
        }
        if (seconds) {
            double& smoothed = statistics.round_trip_seconds;
            double& least = statistics.least_round_trip_seconds;
            smoothed = smoothed < 0 ? *seconds : 0.8 * smoothed + 0.2 * *seconds;
            least = least < 0 ? *seconds : std::min(least, *seconds);
        }
    }
};

ClientCore::ClientCore(ConnectionOptions const& options, std::function<void()> on_news)
    : impl_(std::make_unique<Impl>(options, std::move(on_news))) {}

ClientCore::~ClientCore() = default;

Welcome const& ClientCore::welcome() const {
    return impl_->connection->welcome();
}

void ClientCore::set_view(Camera const& wanted, Viewport viewport, int scene_camera) {
    Camera const camera = within_bounds(wanted); // a hand may lead it out
    std::lock_guard const lock(impl_->mutex);
    CameraUpdate& view = impl_->view;
    if (view.view.number > 0 && view.view.camera == camera && view.view.viewport == viewport &&
        view.scene_camera == scene_camera) {
        impl_->send_waiting_view();
        return;
    }
    if (!impl_->cache || impl_->cache->plane().viewport() != viewport) {
        impl_->cache.emplace(ImagePlane(viewport));
        ++impl_->cache_generation;
        impl_->restart_smoothing();
    }
    view = {{view.view.number + 1, camera, viewport}, scene_camera};
    impl_->statistics.converged = false;
    impl_->waiting_view = view;
    impl_->send_waiting_view();
}

void ClientCore::set_settings(ViewerSettings const& settings) {
    {
        std::lock_guard const lock(impl_->mutex);
        if (impl_->reproject != settings.reproject) {
            impl_->reproject = settings.reproject;
            impl_->restart_smoothing();
        }
    }
    impl_->connection->send(settings);
}

void ClientCore::set_smoothing(double lag_seconds) {
    FRAMELET_CHECK(lag_seconds >= 0 && lag_seconds <= max_lag_seconds);
    std::lock_guard const lock(impl_->mutex);
    if (impl_->late_clock.lag_seconds() != lag_seconds) {
        impl_->late_clock = LateClock(lag_seconds);
        impl_->restart_smoothing();
    }
}

void ClientCore::request_clock(ClockRequest const& request) {
    {
        std::lock_guard const lock(impl_->mutex);
        ClockState& clock = impl_->status.clock;
        clock = impl_->clock_now();
        impl_->status_time = Clock::now();
        clock.time = (request.set & ClockRequest::time) != 0 ? request.state.time : clock.time;
        clock.playing = (request.set & ClockRequest::playing) != 0 ? request.state.playing : clock.playing;
        clock.speed = (request.set & ClockRequest::speed) != 0 ? request.state.speed : clock.speed;
        impl_->status.converged = false;
        impl_->statistics.converged = false;
    }
    impl_->connection->send(request);
}

bool ClientCore::update_picture(Picture& picture, std::vector<PixelRect>& changed) {
    std::lock_guard const lock(impl_->mutex);
    Impl& core = *impl_;
    changed.clear();
    core.send_waiting_view();
    if (!core.cache || core.cache->framelet_count() == 0) {
        return false;
    }
    Viewport const viewport = core.cache->plane().viewport();
    bool const whole = core.cache_generation != core.shown_generation || picture.rgba.data() != core.shown_pixels ||
                       picture.width != viewport.width || picture.height != viewport.height;
    core.cache->take_changed(changed);
    if (whole) {
        picture = Picture(viewport.width, viewport.height);
        core.reprojector = Reprojector();
        if (core.smoother) {
            core.smoother->start_picture();
        }
        changed.assign(1, {0, 0, viewport.width, viewport.height});
        core.shown_generation = core.cache_generation;
        core.shown_pixels = picture.rgba.data();
    }
    Clock::time_point const before = Clock::now();
    core.draw(picture, changed);
    if (changed.empty()) {
        return false;
    }
    Clock::time_point const after = Clock::now();
    for (PixelRect const& rect : changed) {
        core.statistics.pixels += static_cast<std::uint64_t>(rect.width()) * static_cast<std::uint64_t>(rect.height());
    }
    core.statistics.reconstruct_seconds += seconds_between(before, after);
    ++core.statistics.pictures;
    if (core.statistics.first_picture_seconds < 0 && core.first_camera_time) {
        core.statistics.first_picture_seconds = seconds_between(*core.first_camera_time, after);
    }
    return true;
}

void ClientCore::draw_overlay(DrawnOver overlay, Picture& picture) const {
    Impl const& core = *impl_;
    std::lock_guard const lock(core.mutex);
    if (overlay == DrawnOver::none || !core.cache || core.cache->framelet_count() == 0 ||
        core.cache->plane().viewport() != Viewport{picture.width, picture.height}) {
        return;
    }
    if (overlay == DrawnOver::outlines || !core.reproject) {
        draw_outlines(*core.cache, picture);
        return;
    }
    std::vector<PixelConfidence> confidence;
    find_confidence(*core.cache, core.pictured_camera, core.pictured_time, core.motions, confidence);
    draw_confidence(confidence, picture);
}

bool ClientCore::wait_for_news(std::chrono::nanoseconds at_most) {
    std::unique_lock lock(impl_->mutex);
    impl_->news_arrived.wait_for(lock, at_most, [this] { return impl_->news; });
    return std::exchange(impl_->news, false);
}

std::optional<std::string> ClientCore::end_reason() const {
    std::lock_guard const lock(impl_->mutex);
    return impl_->end_reason;
}

bool ClientCore::is_complete() const {
    std::lock_guard const lock(impl_->mutex);
    return impl_->status.converged && impl_->view.view.number > 0 &&
           impl_->status.camera_number == impl_->view.view.number && impl_->last_batch >= impl_->status.last_batch &&
           impl_->cache && impl_->cache->framelet_count() > 0 &&
           (!impl_->smoother || impl_->status.clock.playing || impl_->pictured_time == impl_->status.clock.time);
}

Status ClientCore::status() const {
    std::lock_guard const lock(impl_->mutex);
    return impl_->status;
}

ClockState ClientCore::clock() const {
    std::lock_guard const lock(impl_->mutex);
    return impl_->clock_now();
}

Camera ClientCore::shown_camera() const {
    std::lock_guard const lock(impl_->mutex);
    return impl_->shown_camera;
}

ClientStatistics ClientCore::statistics() const {
    std::lock_guard const lock(impl_->mutex);
    ClientStatistics out = impl_->statistics;
    out.seconds = seconds_between(impl_->start, Clock::now());
    if (impl_->cache) {
        out.coverage = impl_->cache->coverage();
        out.cached_framelets = impl_->cache->framelet_count();
        out.cached_bytes = impl_->cache->memory_bytes();
    }
    if (impl_->smoother) {
        out.cached_bytes += impl_->smoother->memory_bytes();
        out.lag_seconds = impl_->late_clock.lag_seconds();
    }
    return out;
}

} // namespace framelet
