#include "client/client_core.h"

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>
#include <utility>

#include "client/making_time.h"
#include "client/picture_maker.h"
#include "client/server_connection.h"
#include "common/error.h"
#include "protocol/batch_codec.h"

namespace framelet {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_between(Clock::time_point from, Clock::time_point to) {
    return std::chrono::duration<double>(to - from).count();
}

Clock::duration clock_duration(double seconds) {
    return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

double ratio(double amount, std::uint64_t count) {
    return count == 0 ? 0 : amount / static_cast<double>(count);
}

/// A batch's number, view, scene time and length prefix on the wire, about.
constexpr std::size_t batch_header_bytes = 96;

/// What waits for a painter that is busy, in samples: some 200 MB. Beyond that batches wait with it.
constexpr std::size_t most_waiting_samples = 64u << 20;

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

    /// Guards what pictures are made of. Whoever has it may take `mutex` as well, not the other way round.
    std::mutex picture_mutex;
    std::optional<PictureMaker> maker;
    std::vector<Batch> taken; ///< scratch

    mutable std::mutex mutex; // guards all that follows, but the connection; never held for long
    std::condition_variable news_arrived;
    bool news = false;
    std::vector<Batch> arrived; ///< and not in the maker yet, in order
    std::size_t arrived_samples = 0;
    std::vector<Batch> spare_batches; ///< for their memory
    std::vector<SentTile> let_go; ///< scratch
    std::optional<CameraUpdate> waiting_view;
    CameraUpdate view; ///< the newest, sent or not
    std::deque<SentCamera> sent_cameras;
    std::deque<SentCamera> set_cameras; ///< and not shown yet
    std::optional<Clock::time_point> first_camera_time;
    PictureSettings picture_settings;
    bool has_picture = false; ///< something is held of the newest viewport
    std::uint64_t last_batch = 0;
    Camera shown_camera;
    SceneTime shown_time = 0;
    Clock::time_point shown_at; ///< when the last picture was to be seen; does not go back
    MakingTime making;
    bool is_smooth = false;
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
        picture_settings.scene_moves = connection->welcome().animation_duration > 0;
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
        Batch batch;
        {
            std::lock_guard const lock(mutex);
            if (view.view.number == 0) {
                ++statistics.stale_batches; // nobody has asked for a picture yet
                return;
            }
            if (!spare_batches.empty()) {
                batch = std::move(spare_batches.back());
                spare_batches.pop_back();
            }
        }
        codec.decode(encoded, &held, batch);
        Clock::time_point const decoded = Clock::now();
        Ack ack{batch.number, 0, 0};
        ack.received_us = static_cast<std::uint64_t>(
            std::chrono::duration_cast<std::chrono::microseconds>(received.time_since_epoch()).count());
        ack.decode_us = static_cast<std::uint32_t>(std::min(seconds_between(received, decoded) * 1e6, 4e9));
        connection->send(ack);
        bool is_full = false;
        {
            std::lock_guard const lock(mutex);
            statistics.bytes += encoded.payload.size() + encoded.shapes.size() + encoded.tracks.size() +
                                encoded.tiles.size() * sizeof(Tile) + batch_header_bytes;
            statistics.decode_seconds += seconds_between(received, decoded);
            std::size_t const samples = batch.framelets.size() * framelet_samples;
            bool const is_stale = batch.view.viewport != view.view.viewport;
            ++statistics.batches;
            statistics.framelets += batch.framelets.size();
            statistics.samples += samples;
            note_round_trip(batch.view.number, received);
            last_batch = std::max(last_batch, batch.number);
            statistics.stale_batches += is_stale ? 1 : 0;
            if (!is_stale) {
                arrived_samples += samples;
                arrived.push_back(std::move(batch));
            }
            is_full = arrived_samples > most_waiting_samples;
        }
        if (is_full) {
            std::lock_guard const lock(picture_mutex);
            take_in();
        }
    }

    /// Puts all that has arrived into what pictures are made of. Under the picture's lock, and not the other one.
    void take_in() {
        Viewport viewport;
        PictureSettings settings;
        {
            std::lock_guard const lock(mutex);
            taken.swap(arrived);
            arrived_samples = 0;
            viewport = view.view.viewport;
            settings = picture_settings;
        }
        if (!maker || maker->viewport() != viewport) {
            maker.emplace(viewport, settings);
        }
        maker->set(settings);
        Clock::time_point const before = Clock::now();
        std::uint64_t stale = 0;
        for (Batch const& batch : taken) {
            if (batch.view.viewport == viewport) {
                maker->insert(batch);
            } else {
                ++stale;
            }
        }
        tell_let_go();
        Clock::time_point const after = Clock::now();
        double const coverage = taken.empty() ? -1 : maker->coverage();
        std::lock_guard const lock(mutex);
        statistics.stale_batches += stale;
        statistics.insert_seconds += seconds_between(before, after);
        has_picture = !maker->is_empty();
        note_held(coverage, after);
        constexpr std::size_t most_spares = 4;
        while (!taken.empty() && spare_batches.size() < most_spares) {
            spare_batches.push_back(std::move(taken.back()));
            taken.pop_back();
        }
        taken.clear();
    }

    /// Under the picture's lock.
    void tell_let_go() {
        maker->take_let_go(let_go);
        std::ranges::sort(let_go);
        for (std::size_t first = 0; first < let_go.size(); first += max_let_go) {
            std::size_t const end = std::min(first + max_let_go, let_go.size());
            connection->send(LetGo{{let_go.begin() + static_cast<std::ptrdiff_t>(first),
                                    let_go.begin() + static_cast<std::ptrdiff_t>(end)}});
        }
    }

    /// Under the lock. `coverage` < 0: nothing has come.
    void note_held(double coverage, Clock::time_point now) {
        if (coverage >= 0) {
            statistics.coverage = coverage;
            statistics.cached_framelets = maker->pool().framelet_count();
        }
        statistics.cached_bytes = maker->memory_bytes();
        statistics.lag_seconds = maker->is_smooth() ? picture_settings.lag_seconds : 0;
        is_smooth = maker->is_smooth();
        if (statistics.full_picture_seconds < 0 && first_camera_time && coverage >= 1) {
            statistics.full_picture_seconds = seconds_between(*first_camera_time, now);
        }
    }

    /// Under the lock.
    ClockState clock_at(Clock::time_point time) const {
        ClockState out = status.clock;
        if (out.playing) {
            double const elapsed = seconds_between(status_time, time);
            out.time = std::clamp(out.time + elapsed * static_cast<double>(out.speed), 0.0, max_scene_time);
        }
        return out;
    }

    /// The server says so of what was asked last, and all of it has come. Under the lock.
    bool is_settled() const {
        return status.converged && view.view.number > 0 && status.camera_number == view.view.number &&
               last_batch >= status.last_batch;
    }

    /// Of what will be the present when the picture is seen.
    PictureRequest picture_request() const {
        std::lock_guard const lock(mutex);
        ClockState const clock = clock_at(shown_at);
        return {view.view.camera,
                view.view.number,
                view.scene_camera,
                clock.time,
                static_cast<double>(clock.speed),
                seconds_between(start, shown_at),
                is_settled()};
    }

    /// How old what the last picture, of the camera of this number, shows is; -1: nothing new. Under the lock.
    double photon_seconds(std::uint64_t number, Clock::time_point seen) {
        if (view.scene_camera >= 0) {
            ClockState const clock = clock_at(seen);
            bool const moves = clock.playing && clock.speed != 0 && picture_settings.scene_moves;
            return moves ? (clock.time - shown_time) / static_cast<double>(clock.speed) : -1;
        }
        double seconds = -1;
        while (!set_cameras.empty() && set_cameras.front().number <= number) {
            seconds = set_cameras.front().number == number ? seconds_between(set_cameras.front().time, seen) : seconds;
            set_cameras.pop_front();
        }
        return seconds;
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
    impl_->has_picture = impl_->has_picture && view.view.viewport == viewport;
    view = {{view.view.number + 1, camera, viewport}, scene_camera};
    impl_->statistics.converged = false;
    impl_->set_cameras.push_back({view.view.number, Clock::now()});
    if (impl_->set_cameras.size() > Impl::most_sent_cameras) {
        impl_->set_cameras.pop_front();
    }
    impl_->waiting_view = view;
    impl_->send_waiting_view();
}

void ClientCore::set_settings(ViewerSettings const& settings) {
    {
        std::lock_guard const lock(impl_->mutex);
        impl_->picture_settings.reproject = settings.reproject;
    }
    impl_->connection->send(settings);
}

void ClientCore::set_smoothing(double lag_seconds) {
    FRAMELET_CHECK(lag_seconds >= 0 && lag_seconds <= max_lag_seconds);
    std::lock_guard const lock(impl_->mutex);
    impl_->picture_settings.lag_seconds = lag_seconds;
}

void ClientCore::request_clock(ClockRequest const& request) {
    {
        std::lock_guard const lock(impl_->mutex);
        ClockState& clock = impl_->status.clock;
        clock = impl_->clock_at(Clock::now());
        impl_->status_time = Clock::now();
        clock.time = (request.set & ClockRequest::time) != 0 ? request.state.time : clock.time;
        clock.playing = (request.set & ClockRequest::playing) != 0 ? request.state.playing : clock.playing;
        clock.speed = (request.set & ClockRequest::speed) != 0 ? request.state.speed : clock.speed;
        impl_->status.converged = false;
        impl_->statistics.converged = false;
    }
    impl_->connection->send(request);
}

bool ClientCore::update_picture(Picture& picture, std::vector<PixelRect>& changed, Clock::time_point shown_at) {
    Impl& core = *impl_;
    changed.clear();
    Clock::time_point const called = Clock::now();
    {
        std::lock_guard const lock(core.mutex);
        core.send_waiting_view();
        if (core.view.view.number == 0) {
            return false;
        }
        shown_at = std::max({shown_at, core.shown_at, called + clock_duration(core.making.expected())});
        core.shown_at = shown_at;
    }
    Clock::time_point begun, made;
    bool drawn = false;
    Camera camera;
    SceneTime time = 0;
    std::uint64_t camera_number = 0;
    {
        std::lock_guard const picture_lock(core.picture_mutex);
        core.take_in();
        begun = Clock::now();
        drawn = core.maker->show(core.picture_request(), picture, changed);
        made = Clock::now();
        camera = core.maker->shown_camera();
        time = core.maker->shown_time();
        camera_number = core.maker->shown_camera_number();
    }
    std::lock_guard const lock(core.mutex);
    core.shown_camera = camera;
    core.shown_time = time;
    core.statistics.photon_seconds = drawn ? core.photon_seconds(camera_number, std::max(shown_at, made)) : -1;
    if (!drawn) {
        return false;
    }
    for (PixelRect const& rect : changed) {
        core.statistics.pixels += static_cast<std::uint64_t>(rect.width()) * static_cast<std::uint64_t>(rect.height());
    }
    core.statistics.reconstruct_seconds += seconds_between(begun, made);
    core.making.note(seconds_between(called, made));
    ++core.statistics.pictures;
    if (core.statistics.first_picture_seconds < 0 && core.first_camera_time) {
        core.statistics.first_picture_seconds = seconds_between(*core.first_camera_time, made);
    }
    return true;
}

double ClientCore::making_seconds() const {
    std::lock_guard const lock(impl_->mutex);
    return impl_->making.expected();
}

void ClientCore::draw_overlay(DrawnOver overlay, Picture& picture) const {
    std::lock_guard const lock(impl_->picture_mutex);
    if (impl_->maker) {
        impl_->maker->draw_over(overlay, picture);
    }
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
    return impl_->is_settled() && (impl_->has_picture || !impl_->arrived.empty()) &&
           (!impl_->is_smooth || impl_->status.clock.playing || impl_->shown_time == impl_->status.clock.time);
}

Status ClientCore::status() const {
    std::lock_guard const lock(impl_->mutex);
    return impl_->status;
}

ClockState ClientCore::clock() const {
    std::lock_guard const lock(impl_->mutex);
    return impl_->clock_at(Clock::now());
}

Camera ClientCore::shown_camera() const {
    std::lock_guard const lock(impl_->mutex);
    return impl_->shown_camera;
}

ClientStatistics ClientCore::statistics() const {
    std::lock_guard const lock(impl_->mutex);
    ClientStatistics out = impl_->statistics;
    out.seconds = seconds_between(impl_->start, Clock::now());
    return out;
}

} // namespace framelet
