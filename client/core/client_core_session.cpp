// What the connection's thread does for the core, and what it shares with the display's.
#include "client/core/client_core.h"

#include <algorithm>
#include <utility>

#include "common/error.h"
#include "common/large_blocks.h"

namespace framelet {

namespace {

/// The time after which memory is given back again.
constexpr auto give_back_every = std::chrono::seconds(10);

/// Bytes, about, that a batch takes on the wire besides its payloads and one byte for each tile.
constexpr std::size_t batch_header_bytes = 96;

} // namespace

ClientCore::ClientCore(ConnectionOptions const& options, std::function<void()> on_news) : on_news_(std::move(on_news)) {
    ServerConnection::Handlers handlers;
    handlers.on_message = [this](Message message) { receive(std::move(message)); };
    handlers.on_lost = [this](std::string reason) {
        {
            std::lock_guard const lock(mutex_);
            end_reason_ = std::move(reason);
            interruption_.reset();
        }
        tell_news();
    };
    handlers.on_interrupted = [this](std::string reason) { pause_session(std::move(reason)); };
    handlers.on_asking = [this](Hello& hello) { ask_to_go_on(hello); };
    handlers.on_reopened = [this](Welcome news_of_scene) { begin_session(std::move(news_of_scene)); };
    handlers.on_sent = [this] {
        std::lock_guard const lock(mutex_);
        send_view();
    };
    auto opened = std::make_unique<ServerConnection>(options, std::move(handlers));
    std::lock_guard const lock(mutex_);
    connection_ = std::move(opened);
    if (statistics_.reconnections == 0) { // the connection's thread has not opened another session meanwhile
        welcome_ = connection_->welcome();
        shown_.camera = welcome_.start_camera;
        picture_settings_.scene_moves = welcome_.animation_duration > 0;
        if (!server_.has_begun()) { // no Status has come yet
            server_.begin(welcome_, Clock::now());
        }
    }
}

void ClientCore::pause_session(std::string reason) {
    {
        std::lock_guard const picture_lock(picture_mutex_);
        std::lock_guard const lock(mutex_);
        interruption_ = std::move(reason);
        server_.stop(Clock::now());
        pictures_.pause(server_.status().clock.time);
    }
    tell_news();
}

void ClientCore::ask_to_go_on(Hello& hello) {
    std::lock_guard const lock(mutex_);
    if (is_whole_ && !told_evictions_.is_lost()) {
        hello.ticket = welcome_.ticket;
        hello.last_batch = last_batch_;
    }
}

void ClientCore::begin_session(Welcome greeting) {
    {
        std::lock_guard const picture_lock(picture_mutex_);
        if (!greeting.resumed) {
            forget_session(greeting);
        }
        std::lock_guard const lock(mutex_);
        pictures_.resume();
        picture_settings_.scene_moves = greeting.animation_duration > 0;
        server_.begin(greeting, Clock::now());
        asked_.begin_session();
        welcome_ = std::move(greeting);
        interruption_.reset();
        ++statistics_.reconnections;
        told_evictions_.note_come(welcome_.evicted);
        if (connection_) {
            connection_->send(viewer_settings_);
            for (Evicted const& told : told_evictions_.messages()) {
                connection_->send(told);
            }
        }
        send_view();
    }
    tell_news();
}

void ClientCore::forget_session(Welcome const& next) {
    is_whole_ = false;
    NumberedView wanted;
    {
        std::lock_guard const lock(mutex_);
        wanted = asked_.view();
    }
    if (pictures_.is_for(wanted)) {
        take_in();
    }
    codec_.emplace();
    memory_.emplace();
    pictures_.begin_anew();
    std::lock_guard const lock(mutex_);
    if (next.scene_identity == 0 || next.scene_identity != welcome_.scene_identity) {
        pictures_.forget_earlier();
        starts_clean_ = true;
        shown_.camera = next.start_camera;
        ++scene_number_;
    }
    arrived_.clear();
    has_picture_ = false;
    last_batch_ = 0;
    told_evictions_ = {};
    is_whole_ = true;
}

void ClientCore::tell_news() {
    {
        std::lock_guard const lock(mutex_);
        news_ = true;
    }
    news_arrived_.notify_all();
    if (on_news_) {
        on_news_();
    }
}

void ClientCore::send_view() {
    if (asked_.is_unsent() && !interruption_ && connection_ && connection_->all_sent()) {
        ++statistics_.cameras_sent;
        connection_->send(asked_.send(Clock::now()));
    }
}

void ClientCore::receive(Message message) {
    if (auto const* encoded = std::get_if<EncodedBatch>(&message)) {
        receive_batch(*encoded);
    } else if (auto const* news_of_server = std::get_if<Status>(&message)) {
        std::lock_guard const lock(mutex_);
        server_.note(*news_of_server, Clock::now());
        told_evictions_.note_come(news_of_server->evicted);
        statistics_.server_samples_per_second = news_of_server->samples_per_second;
        statistics_.server_busy = static_cast<double>(news_of_server->busy);
    } else {
        throw ProtocolError("a message that only a viewer sends");
    }
    tell_news();
}

void ClientCore::give_back_memory(Clock::time_point now) {
    if (now - given_back_ >= give_back_every) {
        give_back_small_blocks();
        given_back_ = now;
    }
}

void ClientCore::receive_batch(EncodedBatch const& encoded) {
    Clock::time_point const received = Clock::now();
    Batch batch;
    {
        std::lock_guard const lock(mutex_);
        if (!asked_.exists()) {
            ++statistics_.stale_batches; // nobody has asked for a picture yet
            return;
        }
        batch = arrived_.take_spare();
    }
    is_whole_ = false;
    codec_->decode(encoded, &*memory_, batch);
    Clock::time_point const decoded = Clock::now();
    Ack ack{batch.number, 0, 0};
    ack.received_us = static_cast<std::uint64_t>(
        std::chrono::duration_cast<std::chrono::microseconds>(received.time_since_epoch()).count());
    ack.decode_us = static_cast<std::uint32_t>(std::min(seconds_between(received, decoded) * 1e6, 4e9));
    connection_->acknowledge(ack);
    bool is_full = false;
    {
        std::lock_guard const lock(mutex_);
        statistics_.bytes += encoded.payload.size() + encoded.shapes.size() + encoded.tracks.size() +
                             encoded.tiles.size() + batch_header_bytes;
        statistics_.decode_seconds += seconds_between(received, decoded);
        std::size_t const samples = batch.framelets.size() * framelet_samples;
        bool const is_stale = !asked_.wants(batch);
        ++statistics_.batches;
        statistics_.framelets += batch.framelets.size();
        statistics_.samples += samples;
        note_round_trip(batch.view.number, received);
        last_batch_ = std::max(last_batch_, batch.number);
        statistics_.stale_batches += is_stale ? 1 : 0;
        if (!is_stale) {
            arrived_.add(std::move(batch));
        }
        is_full = arrived_.is_full(); // nobody paints: what has arrived is taken in at once
    }
    if (is_full) {
        std::lock_guard const lock(picture_mutex_);
        take_in();
    }
    is_whole_ = true;
    give_back_memory(decoded);
}

void ClientCore::take_in() {
    NumberedView wanted;
    PictureSettings settings;
    std::uint64_t stale = 0;
    {
        std::lock_guard const lock(mutex_);
        arrived_.take(taken_);
        stale = std::erase_if(taken_, [this](Batch const& batch) { return !asked_.wants(batch); });
        wanted = asked_.view();
        settings = picture_settings_;
    }
    PictureMaker& maker = pictures_.prepare(wanted, settings);
    Clock::time_point const before = Clock::now();
    for (Batch const& batch : taken_) {
        maker.insert(batch);
    }
    tell_evicted(maker);
    Clock::time_point const after = Clock::now();
    double const coverage = taken_.empty() ? -1 : maker.coverage();
    FrameletCache const& newest = maker.pool().newest();
    bool const is_fine = !taken_.empty() && newest.is_covered_from(maker.pool().plane().pixel_depth());
    std::lock_guard const lock(mutex_);
    statistics_.stale_batches += stale;
    statistics_.insert_seconds += seconds_between(before, after);
    has_picture_ = !maker.is_empty();
    note_held(maker, coverage, is_fine, after);
    arrived_.give_back(taken_);
}

void ClientCore::tell_evicted(PictureMaker& maker) {
    maker.take_evicted(evicted_);
    for (Evicted& told : evicted_messages(evicted_)) {
        std::lock_guard const lock(mutex_);
        if (!interruption_) {
            connection_->send(told);
        }
        if (welcome_.ticket) {
            told_evictions_.keep(std::move(told));
        }
    }
}

void ClientCore::note_held(PictureMaker const& maker, double coverage, bool is_fine, Clock::time_point now) {
    if (coverage >= 0) {
        statistics_.coverage = coverage;
        statistics_.is_fine = is_fine;
        statistics_.cached_framelets = maker.pool().framelet_count();
    }
    statistics_.cached_bytes = pictures_.memory_bytes();
    statistics_.lag_seconds = maker.is_smooth() ? picture_settings_.lag_seconds : 0;
    is_smooth_ = maker.is_smooth();
    if (statistics_.full_picture_seconds < 0 && asked_.first_sent() && coverage >= full_coverage) {
        statistics_.full_picture_seconds = seconds_between(*asked_.first_sent(), now);
    }
}

bool ClientCore::is_settled() const {
    Status const& status = server_.status();
    return status.converged && asked_.exists() && status.camera_number == asked_.view().number &&
           last_batch_ >= status.last_batch;
}

bool ClientCore::shows_all() const {
    ClockState const& clock = server_.status().clock;
    return is_settled() && (has_picture_ || !arrived_.empty()) &&
           (!is_smooth_ || clock.playing || shown_.time == clock.time);
}

bool ClientCore::is_clean_start() {
    std::lock_guard const lock(mutex_);
    return std::exchange(starts_clean_, false);
}

PictureRequest ClientCore::picture_request() const {
    std::lock_guard const lock(mutex_);
    ClockState const clock = server_.clock_at(shown_at_);
    return {asked_.view().camera,
            asked_.view().number,
            asked_.scene_camera(),
            clock.time,
            static_cast<double>(clock.speed),
            seconds_between(start_, shown_at_),
            is_settled(),
            drawn_over_};
}

double ClientCore::photon_seconds(Clock::time_point seen) {
    if (asked_.scene_camera() >= 0) {
        ClockState const clock = server_.clock_at(seen);
        bool const moves = clock.playing && clock.speed != 0 && picture_settings_.scene_moves;
        return moves ? (clock.time - shown_.time) / static_cast<double>(clock.speed) : -1;
    }
    return asked_.since_set(shown_.camera_number, seen).value_or(-1);
}

void ClientCore::note_round_trip(std::uint64_t camera_number, Clock::time_point received) {
    if (auto const seconds = asked_.since_sent(camera_number, received)) {
        double& smoothed = statistics_.round_trip_seconds;
        double& least = statistics_.least_round_trip_seconds;
        smoothed = smoothed < 0 ? *seconds : 0.8 * smoothed + 0.2 * *seconds;
        least = least < 0 ? *seconds : std::min(least, *seconds);
    }
}

} // namespace framelet
