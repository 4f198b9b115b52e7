#include "server/session/session.h"

#include <utility>

#include "server/session/limits/session_memory.h"
#include "server/session/limits/wall_time.h"

namespace framelet {
namespace {

EncodedBatch const& batch_of(std::shared_ptr<Message const> const& message) {
    return std::get<EncodedBatch>(*message);
}

/// Bytes that a batch takes, about.
std::size_t bytes_of(EncodedBatch const& batch) {
    return batch.payload.size() + batch.shapes.size() + batch.tracks.size() + batch.tiles.size() * sizeof(Tile);
}

} // namespace

Session::Session(std::uint64_t id, std::shared_ptr<FramedStream> stream, Events events)
    : id_(id), stream_(std::move(stream)), events_(std::move(events)) {}

void Session::start() {
    {
        std::scoped_lock const lock(mutex_);
        if (std::exchange(started_, true)) {
            return;
        }
        last_progress_ = std::chrono::steady_clock::now();
    }
    FramedStream::Handlers handlers;
    handlers.on_message = [self = shared_from_this()](Message message) { self->receive(std::move(message)); };
    handlers.on_close = [self = shared_from_this()](std::string const& reason) {
        self->fail(reason, self->stream_->was_cut());
    };
    stream_->start(std::move(handlers), max_upstream_message_bytes);
}

void Session::close(std::string const& farewell, bool again) {
    {
        std::scoped_lock const lock(mutex_);
        open_ = false;
        ended_ = true;
        parked_ = false;
    }
    stream_->send(Failure{farewell, again});
    stream_->close_after_sending();
}

void Session::end(std::string const& reason, bool again, bool tells) {
    {
        std::scoped_lock const lock(mutex_);
        parked_ = false;
        if (std::exchange(ended_, true)) {
            return;
        }
        open_ = false;
    }
    if (tells) {
        stream_->send(Failure{reason, again});
    }
    stream_->close_after_sending();
    events_.ended(reason);
}

void Session::cut() {
    stream_->close();
    std::scoped_lock const lock(mutex_);
    parked_ = parked_ || open_;
    open_ = false;
    ended_ = true;
}

bool Session::can_be_resumed(std::uint64_t last_batch) const {
    std::scoped_lock const lock(mutex_);
    return parked_ && last_ack_ <= last_batch && last_batch <= last_batch_ &&
           (last_batch == last_batch_ || (!kept_.empty() && batch_of(kept_.front()).number <= last_batch + 1));
}

void Session::resume(std::shared_ptr<Session> earlier, std::uint64_t last_batch) {
    std::scoped_lock const lock(mutex_, earlier->mutex_);
    evicted_ = earlier->evicted_;
    waiting_evicted_ = earlier->waiting_evicted_;
    last_batch_ = last_ack_ = last_batch;
    if (!earlier->earlier_) {
        earlier_ = std::move(earlier);
        return;
    }
    // Whoever comes back again and again before its turn makes no chain of sessions.
    waiting_events_ = std::move(earlier->waiting_events_);
    earlier_ = std::move(earlier->earlier_);
    earlier->parked_ = false;
}

bool Session::take_over(Session& earlier) {
    std::deque<std::shared_ptr<Message const>> lacked;
    {
        std::scoped_lock const lock(mutex_, earlier.mutex_);
        if (earlier_.get() != &earlier || !earlier.parked_) {
            return false;
        }
        std::vector<StreamEvent> events = std::move(earlier.waiting_events_);
        events.push_back({seconds_of(std::chrono::steady_clock::now()), Resumed{last_batch_}});
        events.insert(events.end(), waiting_events_.begin(), waiting_events_.end());
        waiting_events_ = std::move(events);
        lacked = std::move(earlier.kept_);
        std::erase_if(lacked, [this](auto const& message) { return batch_of(message).number <= last_batch_; });
        earlier.parked_ = false;
        earlier_.reset();
    }
    for (auto const& message : lacked) {
        send_batch(message);
    }
    return true;
}

void Session::abandon() {
    std::shared_ptr<Session> earlier;
    {
        std::scoped_lock const lock(mutex_);
        parked_ = false;
        earlier = std::move(earlier_);
    }
    if (earlier) {
        earlier->abandon();
    }
}

bool Session::has_spoken() const {
    std::scoped_lock const lock(mutex_);
    return has_spoken_;
}

bool Session::is_open() const {
    std::scoped_lock const lock(mutex_);
    return open_;
}

bool Session::has_ended() const {
    std::scoped_lock const lock(mutex_);
    return ended_;
}

bool Session::is_parked() const {
    std::scoped_lock const lock(mutex_);
    return parked_;
}

bool Session::is_served() const {
    std::scoped_lock const lock(mutex_);
    return open_ || parked_;
}

bool Session::is_ready() const {
    std::scoped_lock const lock(mutex_);
    return camera_number_ > 0;
}

std::shared_ptr<Session> Session::earlier() const {
    std::scoped_lock const lock(mutex_);
    return earlier_;
}

std::uint32_t Session::codings() const {
    std::scoped_lock const lock(mutex_);
    return codings_;
}

bool Session::is_worker() const {
    std::scoped_lock const lock(mutex_);
    return is_worker_;
}

std::uint64_t Session::take_events(std::vector<StreamEvent>& events) {
    events.clear();
    std::scoped_lock const lock(mutex_);
    events.swap(waiting_events_);
    waiting_evicted_ = 0;
    return version_;
}

void Session::send(Message const& message) {
    if (is_open()) {
        stream_->send(message);
    }
}

void Session::send_batch(EncodedBatch batch) {
    send_batch(std::make_shared<Message const>(std::move(batch)));
}

void Session::send_batch(std::shared_ptr<Message const> const& batch) {
    std::uint64_t const number = batch_of(batch).number;
    {
        std::scoped_lock const lock(mutex_);
        if (!open_ && !parked_) {
            return;
        }
        kept_.push_back(batch);
        kept_bytes_ += bytes_of(batch_of(batch));
        if (!open_) {
            return;
        }
        while (kept_bytes_ > most_kept_bytes) { // who lacks the oldest cannot go on
            drop_kept();
        }
        if (last_batch_ == last_ack_) {
            last_progress_ = std::chrono::steady_clock::now();
        }
        last_batch_ = number; // the answer may be here before it is sent as a whole
    }
    double const now = seconds_of(std::chrono::steady_clock::now());
    std::size_t const bytes = stream_->send(*batch);
    if (events_.sent) {
        events_.sent(bytes);
    }
    std::scoped_lock const lock(mutex_);
    waiting_events_.push_back({now, BatchSent{number, bytes}});
}

void Session::note_clock_change() {
    std::scoped_lock const lock(mutex_);
    add_newest(ClockChanged{});
}

/// Replaces an event of this kind that waits. To be called under the lock.
template <class What>
void Session::add_newest(What const& what) {
    std::erase_if(waiting_events_, [](StreamEvent const& event) { return std::holds_alternative<What>(event.what); });
    waiting_events_.push_back({seconds_of(std::chrono::steady_clock::now()), what});
    ++version_;
}

bool Session::report(std::uint64_t version, bool converged) {
    std::scoped_lock const lock(mutex_);
    std::uint64_t const reported = converged ? version : 0;
    return std::exchange(converged_version_, reported) != reported;
}

Status Session::status() const {
    std::scoped_lock const lock(mutex_);
    Status status;
    status.last_batch = last_batch_;
    status.evicted = evicted_;
    status.camera_number = camera_number_;
    status.converged = camera_number_ > 0 && converged_version_ == version_;
    return status;
}

std::optional<std::string> Session::overdue(std::chrono::steady_clock::time_point now) const {
    std::scoped_lock const lock(mutex_);
    if (!started_ || ended_) {
        return std::nullopt;
    }
    auto const waiting = now - last_progress_;
    if (!open_) {
        auto const most = stream_->asks_for_files() ? files_timeout : hello_timeout;
        return waiting > most ? std::optional("no Hello within the time for it") : std::nullopt;
    }
    if (codings_ == coding::none) {
        return std::nullopt;
    }
    if (camera_number_ == 0) {
        return waiting > camera_timeout ? std::optional("no camera within the time for it") : std::nullopt;
    }
    bool const owes = last_batch_ != last_ack_;
    return owes && waiting > ack_timeout ? std::optional("the viewer stopped acknowledging") : std::nullopt;
}

void Session::receive(Message message) {
    bool open = false;
    {
        std::scoped_lock const lock(mutex_);
        if (ended_) {
            return; // by another thread, while this message was on its way here
        }
        has_spoken_ = true;
        open = open_;
    }
    if (!open) {
        receive_hello(message);
    } else if (auto* const answer = std::get_if<PathAnswer>(&message); answer != nullptr && is_worker()) {
        events_.path_answer(std::move(*answer));
    } else if (!has_pictures() && !std::holds_alternative<Failure>(message) &&
               (is_worker() || !std::holds_alternative<ClockRequest>(message))) {
        close("unexpected message");
        events_.ended("who has no pictures has sent what only viewers may");
    } else if (auto const* const camera = std::get_if<CameraUpdate>(&message)) {
        receive_camera(*camera);
    } else if (auto const* const settings = std::get_if<ViewerSettings>(&message)) {
        {
            std::scoped_lock const lock(mutex_);
            add_newest(*settings);
        }
        events_.changed();
    } else if (auto const* const request = std::get_if<ClockRequest>(&message)) {
        events_.clock_request(*request);
    } else if (auto const* const ack = std::get_if<Ack>(&message)) {
        if (receive_ack(*ack)) {
            events_.changed();
        }
    } else if (auto* const gone = std::get_if<Evicted>(&message)) {
        receive_evicted(std::move(*gone));
    } else if (auto const* const failure = std::get_if<Failure>(&message)) {
        stream_->close();
        fail("the viewer gave up: " + failure->text, false);
    } else {
        close("unexpected message");
        events_.ended("the viewer sent a message that only a server may send");
    }
}

/// Drops the oldest batch that is kept. To be called under the lock.
void Session::drop_kept() {
    kept_bytes_ -= bytes_of(batch_of(kept_.front()));
    kept_.pop_front();
}

/// Takes in an acknowledgement; false where it answers nothing that waits for an answer.
bool Session::receive_ack(Ack const& ack) {
    std::scoped_lock const lock(mutex_);
    if (ack.batch <= last_ack_ || ack.batch > last_batch_) {
        return false;
    }
    last_ack_ = ack.batch;
    while (!kept_.empty() && batch_of(kept_.front()).number <= last_ack_) {
        drop_kept();
    }
    last_progress_ = std::chrono::steady_clock::now();
    waiting_events_.push_back({seconds_of(last_progress_), ack});
    return true;
}

/// Takes in what the viewer has evicted. What waits is bounded: a viewer that evicts more than it can hold is not
/// heard, nor is one that was sent nothing.
void Session::receive_evicted(Evicted gone) {
    constexpr std::size_t most_waiting = std::size_t{1} << 18;
    std::scoped_lock const lock(mutex_);
    ++evicted_;
    if (last_batch_ == 0) {
        return;
    }
    waiting_evicted_ += gone.framelets.size() + 1;
    if (waiting_evicted_ <= most_waiting) {
        waiting_events_.push_back({seconds_of(std::chrono::steady_clock::now()), std::move(gone)});
    }
}

void Session::receive_camera(CameraUpdate const& camera) {
    bool is_resized = false;
    {
        std::scoped_lock const lock(mutex_);
        if (camera.view.number <= camera_number_) {
            return; // late: a newer one is here already
        }
        is_resized = camera_number_ == 0 || camera.view.viewport != viewport_;
    }
    if (is_resized) {
        bool const takes_predictions =
            (codings() & coding::haar_colour) != 0 && (codings() & coding::predicted_colour) != 0;
        if (auto const refusal = events_.resize(camera.view.viewport, takes_predictions)) {
            end(*refusal);
            return;
        }
    }
    {
        std::scoped_lock const lock(mutex_);
        camera_number_ = camera.view.number;
        viewport_ = camera.view.viewport;
        add_newest(camera);
    }
    events_.changed();
}

void Session::receive_hello(Message const& message) {
    auto const* const hello = std::get_if<Hello>(&message);
    std::variant<Welcome, Failure> answer = Failure{"the first message has to be Hello"};
    if (hello) {
        answer = events_.admit(*hello);
    }
    if (auto* const failure = std::get_if<Failure>(&answer)) {
        close(failure->text, failure->again);
        events_.ended("refused: " + failure->text);
        return;
    }
    {
        std::scoped_lock const lock(mutex_);
        open_ = true;
        last_progress_ = std::chrono::steady_clock::now();
        is_worker_ = hello->work.has_value();
        codings_ = is_worker_ ? coding::none : hello->codings;
    }
    stream_->send(std::get<Welcome>(std::move(answer)));
    events_.changed();
}

void Session::fail(std::string const& reason, bool is_cut) {
    {
        std::scoped_lock const lock(mutex_);
        if (std::exchange(ended_, true)) {
            return;
        }
        parked_ = open_ && is_cut;
        open_ = false;
    }
    events_.ended(reason);
}

} // namespace framelet
