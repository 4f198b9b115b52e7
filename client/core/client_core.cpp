#include "client/core/client_core.h"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <utility>

#include "client/core/connection/server_connection.h"
#include "client/core/picture/display_timing.h"
#include "client/core/picture/making_time.h"
#include "client/core/picture/session_pictures.h"
#include "client/core/session/arrived_batches.h"
#include "client/core/session/asked_view.h"
#include "client/core/session/server_state.h"
#include "client/core/session/told_evictions.h"
#include "common/error.h"
#include "common/large_blocks.h"
#include "protocol/codec/batch_codec.h"

namespace framelet {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_between(Clock::time_point from, Clock::time_point to) {
    return std::chrono::duration<double>(to - from).count();
}

/// The time after which memory is given back again.
constexpr auto give_back_every = std::chrono::seconds(10);

/// Bytes, about, that a batch takes on the wire besides its payloads and one byte for each tile.
constexpr std::size_t batch_header_bytes = 96;

} // namespace

struct ClientCore::Impl {
    std::function<void()> on_news;
    Clock::time_point const start = Clock::now();
    // State of this session's stream, used by the connection's thread only.
    std::optional<BatchCodec> codec{std::in_place};
    std::optional<BatchMemory> memory{std::in_place};
    bool is_whole = true; ///< every batch that has come is decoded and among `arrived`, or taken in already
    Clock::time_point given_back = start; ///< when memory was given back last

    /// Guards what pictures are made of. Whoever holds it may lock `mutex` as well, not the other way round.
    std::mutex picture_mutex;
    SessionPictures pictures;
    std::vector<Batch> taken; ///< scratch

    mutable std::mutex mutex; // guards all that follows, but the connection; never held for long
    std::condition_variable news_arrived;
    bool news = false;
    ArrivedBatches arrived; ///< batches that are not in the maker yet
    std::vector<SentTile> evicted; ///< scratch
    ToldEvictions told_evictions;
    AskedView asked;
    ViewerSettings viewer_settings;
    PictureSettings picture_settings;
    DrawnOver drawn_over = DrawnOver::nothing;
    bool has_picture = false; ///< something is held of the newest viewport
    std::uint64_t last_batch = 0;
    bool is_on_canvas = false; ///< the last picture is on the canvas
    Camera shown_camera;
    SceneTime shown_time = 0;
    Clock::time_point shown_at; ///< when the last picture was to be seen; does not go back
    MakingTime making;
    bool is_smooth = false;
    ServerState server;
    Welcome welcome;
    std::uint64_t scene_number = 1;
    bool starts_clean = false; ///< what is shown is of another scene, and is to be cleared
    std::optional<std::string> interruption;
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
                interruption.reset();
            }
            tell_news();
        };
        handlers.on_interrupted = [this](std::string reason) { pause_session(std::move(reason)); };
        handlers.on_asking = [this](Hello& hello) { ask_to_go_on(hello); };
        handlers.on_reopened = [this](Welcome news_of_scene) { begin_session(std::move(news_of_scene)); };
        handlers.on_sent = [this] {
            std::lock_guard const lock(mutex);
            send_view();
        };
        auto opened = std::make_unique<ServerConnection>(options, std::move(handlers));
        std::lock_guard const lock(mutex);
        connection = std::move(opened);
        if (statistics.reconnections == 0) { // the connection's thread has not opened another session meanwhile
            welcome = connection->welcome();
            shown_camera = welcome.start_camera;
            picture_settings.scene_moves = welcome.animation_duration > 0;
            if (!server.has_begun()) { // no Status has come yet
                server.begin(welcome, Clock::now());
            }
        }
    }

    NumberedView wanted_view() const {
        std::lock_guard const lock(mutex);
        return asked.view();
    }

    /// Interrupts the session; what has come is kept for the time without one.
    void pause_session(std::string reason) {
        {
            std::lock_guard const picture_lock(picture_mutex);
            std::lock_guard const lock(mutex);
            interruption = std::move(reason);
            server.stop(Clock::now());
            pictures.pause(server.status().clock.time);
            statistics.converged = false;
        }
        tell_news();
    }

    /// Asks to go on with the session before, where the viewer holds what the server thinks it holds, but for batches
    /// that are still to come.
    void ask_to_go_on(Hello& hello) {
        std::lock_guard const lock(mutex);
        if (is_whole && !told_evictions.is_lost()) {
            hello.ticket = welcome.ticket;
            hello.last_batch = last_batch;
        }
    }

    void begin_session(Welcome greeting) {
        {
            std::lock_guard const picture_lock(picture_mutex);
            if (!greeting.resumed) {
                forget_session(greeting);
            }
            std::lock_guard const lock(mutex);
            pictures.resume();
            picture_settings.scene_moves = greeting.animation_duration > 0;
            server.begin(greeting, Clock::now());
            asked.begin_session();
            welcome = std::move(greeting);
            interruption.reset();
            ++statistics.reconnections;
            told_evictions.note_come(welcome.evicted);
            if (connection) {
                connection->send(viewer_settings);
                for (Evicted const& told : told_evictions.messages()) {
                    connection->send(told);
                }
            }
            send_view();
        }
        tell_news();
    }

    /// Drops the state of the session that has ended. Its picture goes on being shown if the next session is of the
    /// same scene. Call it with `picture_mutex` held.
    void forget_session(Welcome const& next) {
        is_whole = false;
        if (pictures.is_for(wanted_view())) {
            take_in();
        }
        codec.emplace();
        memory.emplace();
        pictures.begin_anew();
        std::lock_guard const lock(mutex);
        if (next.scene_identity == 0 || next.scene_identity != welcome.scene_identity) {
            pictures.forget_earlier();
            starts_clean = true;
            shown_camera = next.start_camera;
            ++scene_number;
        }
        arrived.clear();
        has_picture = false;
        last_batch = 0;
        told_evictions = {};
        is_whole = true;
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

    /// Sends the newest view where nothing else is queued: one camera at most is in the network's queue, and of those
    /// that are set while it waits only the newest is sent. Call it with `mutex` held.
    void send_view() {
        if (asked.is_unsent() && !interruption && connection && connection->all_sent()) {
            ++statistics.cameras_sent;
            connection->send(asked.send(Clock::now()));
        }
    }

    void receive(Message message) {
        if (auto const* encoded = std::get_if<EncodedBatch>(&message)) {
            receive_batch(*encoded);
        } else if (auto const* news_of_server = std::get_if<Status>(&message)) {
            std::lock_guard const lock(mutex);
            server.note(*news_of_server, Clock::now());
            told_evictions.note_come(news_of_server->evicted);
            statistics.converged = news_of_server->converged;
            statistics.server_samples_per_second = news_of_server->samples_per_second;
            statistics.server_busy = static_cast<double>(news_of_server->busy);
        } else {
            throw ProtocolError("a message that only a viewer sends");
        }
        tell_news();
    }

    /// Gives back memory that is free now and then: framelets leave theirs in small blocks, others behind them.
    void give_back_memory(Clock::time_point now) {
        if (now - given_back >= give_back_every) {
            give_back_small_blocks();
            given_back = now;
        }
    }

    void receive_batch(EncodedBatch const& encoded) {
        Clock::time_point const received = Clock::now();
        Batch batch;
        {
            std::lock_guard const lock(mutex);
            if (!asked.exists()) {
                ++statistics.stale_batches; // nobody has asked for a picture yet
                return;
            }
            batch = arrived.take_spare();
        }
        is_whole = false;
        codec->decode(encoded, &*memory, batch);
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
                                encoded.tiles.size() + batch_header_bytes;
            statistics.decode_seconds += seconds_between(received, decoded);
            std::size_t const samples = batch.framelets.size() * framelet_samples;
            bool const is_stale = !asked.wants(batch);
            ++statistics.batches;
            statistics.framelets += batch.framelets.size();
            statistics.samples += samples;
            note_round_trip(batch.view.number, received);
            last_batch = std::max(last_batch, batch.number);
            statistics.stale_batches += is_stale ? 1 : 0;
            if (!is_stale) {
                arrived.add(std::move(batch));
            }
            is_full = arrived.is_full(); // nobody paints: what has arrived is taken in at once
        }
        if (is_full) {
            std::lock_guard const lock(picture_mutex);
            take_in();
        }
        is_whole = true;
        give_back_memory(decoded);
    }

    /// Puts all batches that have arrived into what pictures are made of. Call it with `picture_mutex` held, without
    /// `mutex`.
    void take_in() {
        NumberedView wanted;
        PictureSettings settings;
        std::uint64_t stale = 0;
        {
            std::lock_guard const lock(mutex);
            arrived.take(taken);
            stale = std::erase_if(taken, [this](Batch const& batch) { return !asked.wants(batch); });
            wanted = asked.view();
            settings = picture_settings;
            pictures.set_drawn_over(drawn_over);
        }
        PictureMaker& maker = pictures.prepare(wanted, settings);
        Clock::time_point const before = Clock::now();
        for (Batch const& batch : taken) {
            maker.insert(batch);
        }
        tell_evicted(maker);
        Clock::time_point const after = Clock::now();
        double const coverage = taken.empty() ? -1 : maker.coverage();
        std::lock_guard const lock(mutex);
        statistics.stale_batches += stale;
        statistics.insert_seconds += seconds_between(before, after);
        has_picture = !maker.is_empty();
        note_held(maker, coverage, after);
        arrived.give_back(taken);
    }

    /// Tells the server of all framelets that the maker has evicted. Call it with `picture_mutex` held.
    void tell_evicted(PictureMaker& maker) {
        maker.take_evicted(evicted);
        for (Evicted& told : evicted_messages(evicted)) {
            std::lock_guard const lock(mutex);
            if (!interruption) {
                connection->send(told);
            }
            if (welcome.ticket) {
                told_evictions.keep(std::move(told));
            }
        }
    }

    /// Notes in the statistics what is held. Call it with `mutex` held. `coverage` < 0: nothing has come.
    void note_held(PictureMaker const& maker, double coverage, Clock::time_point now) {
        if (coverage >= 0) {
            statistics.coverage = coverage;
            statistics.cached_framelets = maker.pool().framelet_count();
        }
        statistics.cached_bytes = pictures.memory_bytes();
        statistics.lag_seconds = maker.is_smooth() ? picture_settings.lag_seconds : 0;
        is_smooth = maker.is_smooth();
        if (statistics.full_picture_seconds < 0 && asked.first_sent() && coverage >= full_coverage) {
            statistics.full_picture_seconds = seconds_between(*asked.first_sent(), now);
        }
    }

    /// True once the server has said that the newest view has converged, and all its batches have come. Call it with
    /// `mutex` held.
    bool is_settled() const {
        Status const& status = server.status();
        return status.converged && asked.exists() && status.camera_number == asked.view().number &&
               last_batch >= status.last_batch;
    }

    /// True once after another scene has taken the place of the one that was shown.
    bool is_clean_start() {
        std::lock_guard const lock(mutex);
        return std::exchange(starts_clean, false);
    }

    /// The request for a picture of what will be the present when it is seen.
    PictureRequest picture_request() const {
        std::lock_guard const lock(mutex);
        ClockState const clock = server.clock_at(shown_at);
        return {asked.view().camera,
                asked.view().number,
                asked.scene_camera(),
                clock.time,
                static_cast<double>(clock.speed),
                seconds_between(start, shown_at),
                is_settled()};
    }

    /// Age in seconds of what the last picture shows, which is of the camera of this number, when it is seen: since
    /// that camera was set or, through a camera of the scene, since its moment was the present; -1: it shows nothing
    /// new. Call it with `mutex` held.
    double photon_seconds(std::uint64_t number, Clock::time_point seen) {
        if (asked.scene_camera() >= 0) {
            ClockState const clock = server.clock_at(seen);
            bool const moves = clock.playing && clock.speed != 0 && picture_settings.scene_moves;
            return moves ? (clock.time - shown_time) / static_cast<double>(clock.speed) : -1;
        }
        return asked.since_set(number, seen).value_or(-1);
    }

    /// Notes the time from when this camera was sent until the first batch seen from it was received. Call it with
    /// `mutex` held.
    void note_round_trip(std::uint64_t camera_number, Clock::time_point received) {
        if (auto const seconds = asked.since_sent(camera_number, received)) {
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

std::string const& ClientCore::notice() const {
    return impl_->connection->notice();
}

Welcome ClientCore::welcome() const {
    std::lock_guard const lock(impl_->mutex);
    return impl_->welcome;
}

std::uint64_t ClientCore::scene_number() const {
    std::lock_guard const lock(impl_->mutex);
    return impl_->scene_number;
}

void ClientCore::set_view(Camera const& wanted, Viewport viewport, int scene_camera) {
    Camera const camera = within_bounds(wanted); // the user may have moved it out of bounds
    std::lock_guard const lock(impl_->mutex);
    AskedView& asked = impl_->asked;
    if (!asked.equals(camera, viewport, scene_camera)) {
        impl_->has_picture = impl_->has_picture && asked.has_viewport(viewport);
        impl_->statistics.converged = false;
        asked.set(camera, viewport, scene_camera, Clock::now());
    }
    impl_->send_view();
}

void ClientCore::set_settings(ViewerSettings const& settings) {
    {
        std::lock_guard const lock(impl_->mutex);
        impl_->viewer_settings = settings;
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
        if (impl_->interruption || !impl_->server.status().controls) {
            return;
        }
        impl_->server.ask_clock(request, Clock::now());
        impl_->statistics.converged = false;
    }
    impl_->connection->send(request);
}

bool ClientCore::update_picture(Picture& picture, std::vector<PixelRect>& changed, Clock::time_point shown_at,
                                BlockCanvas* canvas) {
    Impl& core = *impl_;
    changed.clear();
    Clock::time_point const called = Clock::now();
    {
        std::lock_guard const lock(core.mutex);
        core.send_view();
        if (!core.asked.exists()) {
            return false;
        }
        shown_at = std::max({shown_at, core.shown_at, called + DisplayTiming::duration(core.making.expected())});
        core.shown_at = shown_at;
    }
    Clock::time_point begun, made;
    bool drawn = false;
    Camera camera;
    SceneTime time = 0;
    std::uint64_t camera_number = 0;
    bool is_on_canvas = false;
    {
        std::lock_guard const picture_lock(core.picture_mutex);
        core.take_in();
        begun = Clock::now();
        drawn = core.pictures.show(core.picture_request(), picture, changed, canvas);
        made = Clock::now();
        PictureMaker const& maker = core.pictures.shown();
        camera = maker.shown_camera();
        time = maker.shown_time();
        camera_number = maker.shown_camera_number();
        is_on_canvas = maker.is_on_canvas();
        if (core.is_clean_start() && !drawn) {
            picture = bare_picture(maker.viewport());
            std::lock_guard const lock(core.mutex);
            core.is_on_canvas = false;
            changed.assign(1, {0, 0, picture.width, picture.height});
            return true;
        }
    }
    std::lock_guard const lock(core.mutex);
    core.is_on_canvas = is_on_canvas;
    if (camera_number > 0) { // else nothing has been shown, and the start camera stays
        core.shown_camera = camera;
    }
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
    if (core.statistics.first_picture_seconds < 0 && core.asked.first_sent()) {
        core.statistics.first_picture_seconds = seconds_between(*core.asked.first_sent(), made);
    }
    return true;
}

bool ClientCore::is_on_canvas() const {
    std::lock_guard const lock(impl_->mutex);
    return impl_->is_on_canvas;
}

double ClientCore::making_seconds() const {
    std::lock_guard const lock(impl_->mutex);
    return impl_->making.expected();
}

void ClientCore::set_drawn_over(DrawnOver what) {
    std::lock_guard const lock(impl_->mutex);
    impl_->drawn_over = what;
}

void ClientCore::draw_overlay(Picture& picture) {
    std::lock_guard const lock(impl_->picture_mutex);
    if (impl_->pictures.current() != nullptr) {
        impl_->pictures.draw_over(picture);
    }
}

bool ClientCore::overlay_fades() const {
    {
        std::lock_guard const lock(impl_->mutex);
        if (impl_->drawn_over != DrawnOver::refresh_rate) {
            return false;
        }
    }
    std::lock_guard const lock(impl_->picture_mutex);
    return impl_->pictures.current() != nullptr && impl_->pictures.drawn_over_fades();
}

std::optional<Vec3> ClientCore::point_at(Vec2 position) const {
    std::lock_guard const lock(impl_->picture_mutex);
    return impl_->pictures.current() == nullptr ? std::nullopt : impl_->pictures.shown().point_at(position);
}

std::vector<float> ClientCore::picture_depths() const {
    std::lock_guard const lock(impl_->picture_mutex);
    return impl_->pictures.current() == nullptr ? std::vector<float>() : impl_->pictures.shown().depths();
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

std::optional<std::string> ClientCore::interruption() const {
    std::lock_guard const lock(impl_->mutex);
    return impl_->interruption;
}

bool ClientCore::controls() const {
    std::lock_guard const lock(impl_->mutex);
    return impl_->server.status().controls;
}

bool ClientCore::is_complete() const {
    std::lock_guard const lock(impl_->mutex);
    ClockState const& clock = impl_->server.status().clock;
    return impl_->is_settled() && (impl_->has_picture || !impl_->arrived.empty()) &&
           (!impl_->is_smooth || clock.playing || impl_->shown_time == clock.time);
}

Status ClientCore::status() const {
    std::lock_guard const lock(impl_->mutex);
    return impl_->server.status();
}

ClockState ClientCore::clock() const {
    std::lock_guard const lock(impl_->mutex);
    return impl_->server.clock_at(Clock::now());
}

Camera ClientCore::shown_camera() const {
    std::lock_guard const lock(impl_->mutex);
    return impl_->shown_camera;
}

ClientStatistics ClientCore::statistics() const {
    std::lock_guard const lock(impl_->mutex);
    ClientStatistics out = impl_->statistics;
    out.seconds = seconds_between(impl_->start, Clock::now());
    out.waiting_bytes = impl_->arrived.bytes();
    return out;
}

} // namespace framelet
