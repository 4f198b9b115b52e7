#include "server/session/session.h"

#include <utility>

#include "common/error.h"

namespace framelet {
namespace {

double seconds_of(std::chrono::steady_clock::time_point time) {
    return std::chrono::duration<double>(time.time_since_epoch()).count();
}

} // namespace

Session::Session(std::uint64_t id, std::shared_ptr<FramedStream> stream, Events events)
    : id_(id), stream_(std::move(stream)), events_(std::move(events)) {}

void Session::start() {
    FramedStream::Handlers handlers;
    handlers.on_message = [self = shared_from_this()](Message message) { self->receive(std::move(message)); };
    handlers.on_close = [self = shared_from_this()](std::string const& reason) { self->fail(reason); };
    stream_->start(std::move(handlers), max_upstream_message_bytes);
}

void Session::close(std::string const& farewell) {
    {
        std::scoped_lock const lock(mutex_);
        open_ = false;
        ended_ = true;
    }
    stream_->send(Failure{farewell});
    stream_->close_after_sending();
}

void Session::end(std::string const& reason) {
    {
        std::scoped_lock const lock(mutex_);
        if (std::exchange(ended_, true)) {
            return;
        }
        open_ = false;
    }
    stream_->send(Failure{reason});
    stream_->close_after_sending();
    events_.ended(reason);
}

bool Session::is_open() const {
    std::scoped_lock const lock(mutex_);
    return open_;
}

SessionInput Session::newest_input() const {
    std::scoped_lock const lock(mutex_);
    return input_;
}

bool Session::has_room(std::uint64_t unsent) const {
    std::scoped_lock const lock(mutex_);
    return open_ && last_batch_ + unsent - last_ack_ < max_batches_in_flight &&
           link_.has_room(seconds_of(std::chrono::steady_clock::now()));
}

HeldPicture* Session::held_picture() {
    return newest_input().takes_predictions() ? &held_ : nullptr;
}

std::uint64_t Session::begin_batch(double samples) {
    std::scoped_lock const lock(mutex_);
    FRAMELET_CHECK(last_batch_ - last_ack_ < max_batches_in_flight);
    auto const now = std::chrono::steady_clock::now();
    if (last_batch_ == last_ack_) {
        last_progress_ = now;
    }
    ++last_batch_;
    link_.begin(samples);
    return last_batch_;
}

LinkState Session::link() const {
    std::scoped_lock const lock(mutex_);
    return link_.state();
}

void Session::send(Message const& message) {
    if (is_open()) {
        stream_->send(message);
    }
}

void Session::send_batch(EncodedBatch batch) {
    if (!is_open()) {
        return;
    }
    std::uint64_t const number = batch.number;
    double const now = seconds_of(std::chrono::steady_clock::now());
    std::size_t const bytes = stream_->send(std::move(batch)); // the answer may be here before this returns
    std::scoped_lock const lock(mutex_);
    link_.sent(number, now, static_cast<double>(bytes));
}

void Session::invalidate() {
    std::scoped_lock const lock(mutex_);
    ++input_.version;
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
    status.camera_number = input_.camera ? input_.camera->view.number : 0;
    status.converged = input_.camera && converged_version_ == input_.version;
    return status;
}

bool Session::has_stopped_answering(std::chrono::steady_clock::time_point now) const {
    std::scoped_lock const lock(mutex_);
    return open_ && last_batch_ != last_ack_ && now - last_progress_ > ack_timeout;
}

void Session::receive(Message message) {
    bool open = false;
    {
        std::scoped_lock const lock(mutex_);
        if (ended_) {
            return; // by another thread, while this message was on its way here
        }
        open = open_;
    }
    if (!open) {
        receive_hello(message);
    } else if (auto* const camera = std::get_if<CameraUpdate>(&message)) {
        receive_camera(std::move(*camera));
    } else if (auto const* const settings = std::get_if<ViewerSettings>(&message)) {
        {
            std::scoped_lock const lock(mutex_);
            input_.settings = *settings;
            ++input_.version;
        }
        events_.changed();
    } else if (auto const* const request = std::get_if<ClockRequest>(&message)) {
        events_.clock_request(*request);
    } else if (auto const* const ack = std::get_if<Ack>(&message)) {
        {
            std::scoped_lock const lock(mutex_);
            if (ack->batch <= last_ack_ || ack->batch > last_batch_) {
                return;
            }
            last_ack_ = ack->batch;
            last_progress_ = std::chrono::steady_clock::now();
            std::optional<double> received;
            if (ack->received_us != 0) {
                received = 1e-6 * static_cast<double>(ack->received_us);
            }
            link_.acknowledged(ack->batch, seconds_of(last_progress_), received);
        }
        events_.changed();
    } else if (auto const* const failure = std::get_if<Failure>(&message)) {
        stream_->close();
        fail("the viewer gave up: " + failure->text);
    } else {
        close("unexpected message");
        events_.ended("the viewer sent a message that only a server may send");
    }
}

void Session::receive_camera(CameraUpdate camera) {
    SessionInput const before = newest_input();
    if (before.camera && camera.view.number <= before.camera->view.number) {
        return; // late: a newer one is here already
    }
    if (!before.camera || camera.view.viewport != before.camera->view.viewport) {
        if (auto const refusal = events_.resize(camera.view.viewport, before.takes_predictions())) {
            end(*refusal);
            return;
        }
    }
    {
        std::scoped_lock const lock(mutex_);
        input_.camera = std::move(camera);
        ++input_.version;
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
        close(failure->text);
        events_.ended("refused: " + failure->text);
        return;
    }
    {
        std::scoped_lock const lock(mutex_);
        open_ = true;
        input_.codings = hello->codings;
    }
    stream_->send(std::get<Welcome>(std::move(answer)));
    events_.changed();
}

void Session::fail(std::string const& reason) {
    {
        std::scoped_lock const lock(mutex_);
        if (std::exchange(ended_, true)) {
            return;
        }
        open_ = false;
    }
    events_.ended(reason);
}

} // namespace framelet
