// One viewer's connection: handshake, the newest of what it asked for, how much is on its way to it. A resource; the
// io thread feeds it, the render loop reads its newest input and hands it batches.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "protocol/framed_stream.h"
#include "protocol/held_picture.h"
#include "protocol/message.h"
#include "server/flow/link_estimate.h"

namespace framelet {

/// The newest camera and settings of a viewer; `camera` is empty until the first one arrived.
struct SessionInput {
    std::optional<CameraUpdate> camera;
    ViewerSettings settings;
    std::uint32_t codings = coding::exact_colour; ///< that it can read
    std::uint64_t version = 0; ///< counts every change, that of the shared clock as well

    bool takes_loss() const { return (codings & coding::haar_colour) != 0; }
    bool takes_predictions() const { return takes_loss() && (codings & coding::predicted_colour) != 0; }
    bool takes_shapes() const { return settings.reproject && (codings & coding::shapes_and_tracks) != 0; }
};

class Session : public std::enable_shared_from_this<Session> {
public:
    /// What the session tells its server; called on the io thread.
    struct Events {
        /// The viewer said hello; the answer is sent back. A Failure ends the connection.
        std::function<std::variant<Welcome, Failure>(Hello const&)> admit;
        std::function<void(ClockRequest const&)> clock_request;
        /// The viewer's picture gets this size; a line that says why it cannot ends the session.
        std::function<std::optional<std::string>(Viewport, bool predicts)> resize;
        /// There is new input, or room for another batch.
        std::function<void()> changed;
        /// Once, when the connection is over; `reason` is one line. The only one that may come from any thread.
        std::function<void(std::string const& reason)> ended;
    };

    /// Batches that may be on their way (rendered, not yet acknowledged). Enough to keep the renderer busy while the
    /// viewer answers, few enough that what arrives is fresh.
    static constexpr std::uint64_t max_batches_in_flight = 32;
    /// A viewer that owes an acknowledgement for so long is taken for gone.
    static constexpr std::chrono::seconds ack_timeout{30};

    Session(std::uint64_t id, std::shared_ptr<FramedStream> stream, Events events);

    void start();
    void close(std::string const& farewell);

    std::uint64_t id() const { return id_; }
    std::string peer() const { return stream_->peer(); }

    // From any thread:
    /// The server cannot go on with this viewer, which is told the reason, one line, as is whoever waits for `ended`.
    void end(std::string const& reason);
    bool is_open() const;
    SessionInput newest_input() const;
    /// True while another batch may be sent, beyond `unsent` others that are not begun yet: there are few in flight,
    /// and the link is not full.
    bool has_room(std::uint64_t unsent) const;
    /// Takes a place in flight for one batch of so many samples and gives its number, from 1. Only while there is room.
    std::uint64_t begin_batch(double samples);
    void send(Message const& message);
    /// The same for a batch that was begun; what becomes of it tells of the link.
    void send_batch(EncodedBatch batch);
    /// What the viewer holds once it has all batches that were sent, for whoever encodes them in turn; null where the
    /// viewer takes no predictions.
    HeldPicture* held_picture();
    /// What is known of the way to the viewer.
    LinkState link() const;
    /// The picture may have to change for a reason that is not in the input (the clock was set).
    void invalidate();
    /// What the loop has done for this viewer: with the input of this version nothing is left to refine, or something
    /// is.
    bool report(std::uint64_t version, bool converged);
    /// The session's part of a status message: newest batch, its camera, convergence.
    Status status() const;
    /// True when the oldest unanswered batch is older than `ack_timeout`.
    bool has_stopped_answering(std::chrono::steady_clock::time_point now) const;

private:
    void receive(Message message);
    void receive_hello(Message const& message);
    void receive_camera(CameraUpdate camera);
    void fail(std::string const& reason);

    std::uint64_t const id_;
    std::shared_ptr<FramedStream> const stream_;
    Events const events_;

    mutable std::mutex mutex_;
    bool open_ = false; ///< handshake done, not ended
    bool ended_ = false;
    SessionInput input_;
    std::uint64_t last_batch_ = 0;
    std::uint64_t last_ack_ = 0;
    std::uint64_t converged_version_ = 0; ///< of the input that there is nothing left to refine for; 0: none
    std::chrono::steady_clock::time_point last_progress_;
    LinkEstimate link_;
    HeldPicture held_; ///< only for the encoder
};

} // namespace framelet
