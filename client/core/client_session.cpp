#include "client/core/client_session.h"

#include <algorithm>
#include <utility>

#include "common/error.h"
#include "common/large_blocks.h"

namespace framelet {

namespace {

using Clock = ClientSession::Clock;

/// The time after which memory is given back again.
constexpr auto give_back_every = std::chrono::seconds(10);

/// Bytes, about, that a batch takes on the wire besides its payloads and one byte for each tile.
constexpr std::size_t batch_header_bytes = 96;

} // namespace

ClientSession::ClientSession(ConnectionOptions const& options, std::function<void()> news_handler)
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

NumberedView ClientSession::wanted_view() const {
    std::lock_guard const lock(mutex);
    return asked.view();
}

void ClientSession::pause_session(std::string reason) {
    {
        std::lock_guard const picture_lock(picture_mutex);
        std::lock_guard const lock(mutex);
        interruption = std::move(reason);
        server.stop(Clock::now());
        pictures.pause(server.status().clock.time);
    }
    tell_news();
}

void ClientSession::ask_to_go_on(Hello& hello) {
    std::lock_guard const lock(mutex);
    if (is_whole && !told_evictions.is_lost()) {
        hello.ticket = welcome.ticket;
        hello.last_batch = last_batch;
    }
}

void ClientSession::begin_session(Welcome greeting) {
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

void ClientSession::forget_session(Welcome const& next) {
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

void ClientSession::tell_news() {
    {
        std::lock_guard const lock(mutex);
        news = true;
    }
    news_arrived.notify_all();
    if (on_news) {
        on_news();
    }
}

void ClientSession::send_view() {
    if (asked.is_unsent() && !interruption && connection && connection->all_sent()) {
        ++statistics.cameras_sent;
        connection->send(asked.send(Clock::now()));
    }
}

void ClientSession::receive(Message message) {
    if (auto const* encoded = std::get_if<EncodedBatch>(&message)) {
        receive_batch(*encoded);
    } else if (auto const* news_of_server = std::get_if<Status>(&message)) {
        std::lock_guard const lock(mutex);
        server.note(*news_of_server, Clock::now());
        told_evictions.note_come(news_of_server->evicted);
        statistics.server_samples_per_second = news_of_server->samples_per_second;
        statistics.server_busy = static_cast<double>(news_of_server->busy);
    } else {
        throw ProtocolError("a message that only a viewer sends");
    }
    tell_news();
}

void ClientSession::give_back_memory(Clock::time_point now) {
    if (now - given_back >= give_back_every) {
        give_back_small_blocks();
        given_back = now;
    }
}

void ClientSession::receive_batch(EncodedBatch const& encoded) {
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

void ClientSession::take_in() {
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
    FrameletCache const& newest = maker.pool().newest();
    bool const is_fine = !taken.empty() && newest.is_covered_from(maker.pool().plane().pixel_depth());
    std::lock_guard const lock(mutex);
    statistics.stale_batches += stale;
    statistics.insert_seconds += seconds_between(before, after);
    has_picture = !maker.is_empty();
    note_held(maker, coverage, is_fine, after);
    arrived.give_back(taken);
}

void ClientSession::tell_evicted(PictureMaker& maker) {
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

void ClientSession::note_held(PictureMaker const& maker, double coverage, bool is_fine, Clock::time_point now) {
    if (coverage >= 0) {
        statistics.coverage = coverage;
        statistics.is_fine = is_fine;
        statistics.cached_framelets = maker.pool().framelet_count();
    }
    statistics.cached_bytes = pictures.memory_bytes();
    statistics.lag_seconds = maker.is_smooth() ? picture_settings.lag_seconds : 0;
    is_smooth = maker.is_smooth();
    if (statistics.full_picture_seconds < 0 && asked.first_sent() && coverage >= full_coverage) {
        statistics.full_picture_seconds = seconds_between(*asked.first_sent(), now);
    }
}

bool ClientSession::is_settled() const {
    Status const& status = server.status();
    return status.converged && asked.exists() && status.camera_number == asked.view().number &&
           last_batch >= status.last_batch;
}

bool ClientSession::is_complete() const {
    ClockState const& clock = server.status().clock;
    return is_settled() && (has_picture || !arrived.empty()) &&
           (!is_smooth || clock.playing || shown_time == clock.time);
}

bool ClientSession::is_clean_start() {
    std::lock_guard const lock(mutex);
    return std::exchange(starts_clean, false);
}

PictureRequest ClientSession::picture_request() const {
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

double ClientSession::photon_seconds(std::uint64_t number, Clock::time_point seen) {
    if (asked.scene_camera() >= 0) {
        ClockState const clock = server.clock_at(seen);
        bool const moves = clock.playing && clock.speed != 0 && picture_settings.scene_moves;
        return moves ? (clock.time - shown_time) / static_cast<double>(clock.speed) : -1;
    }
    return asked.since_set(number, seen).value_or(-1);
}

void ClientSession::note_round_trip(std::uint64_t camera_number, Clock::time_point received) {
    if (auto const seconds = asked.since_sent(camera_number, received)) {
        double& smoothed = statistics.round_trip_seconds;
        double& least = statistics.least_round_trip_seconds;
        smoothed = smoothed < 0 ? *seconds : 0.8 * smoothed + 0.2 * *seconds;
        least = least < 0 ? *seconds : std::min(least, *seconds);
    }
}

} // namespace framelet
