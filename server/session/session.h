// One viewer's connection: handshake, and the events that its stream has not taken yet. A resource; the io thread feeds
// it, the render loop takes what has come and hands it batches. One whose connection was cut is parked: it keeps what
// another session of the same viewer may go on with.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "protocol/messages/message.h"
#include "protocol/stream/framed_stream.h"
#include "server/stream/stream_event.h"

namespace framelet {

class Session : public std::enable_shared_from_this<Session> {
public:
    /// Callbacks by which the session tells its server; on the io thread where nothing else is said.
    struct Events {
        /// Called when the viewer has said hello; the answer is sent back. A Failure ends the connection.
        std::function<std::variant<Welcome, Failure>(Hello const&)> admit;
        std::function<void(ClockRequest const&)> clock_request;
        /// Called when the viewer's picture gets this size; a line that says why it cannot ends the session.
        std::function<std::optional<std::string>(Viewport, bool predicts)> resize;
        /// Called when there is new input, or room for another batch.
        std::function<void()> changed;
        /// Called once, when the connection is over; `reason` is one line. This one and the next may come from any
        /// thread.
        std::function<void(std::string const& reason)> ended;
        /// Called when a worker has answered; empty: there are none.
        std::function<void(PathAnswer)> path_answer = {};
        /// Called when a batch of so many bytes was handed to the connection; empty: nobody counts them.
        std::function<void(std::size_t bytes)> sent = {};
    };

    /// Most time from the start of reading to Hello, a TLS handshake between them.
    static constexpr std::chrono::seconds hello_timeout{5};
    static constexpr std::chrono::seconds files_timeout{60}; ///< for a page and its files, over a slow link
    /// Most time from Welcome to the first camera: a viewer that looks nowhere takes the place of one that would.
    static constexpr std::chrono::seconds camera_timeout{10};
    /// A viewer that owes an acknowledgement for so long is taken for gone.
    static constexpr std::chrono::seconds ack_timeout{30};

    Session(std::uint64_t id, std::shared_ptr<FramedStream> stream, Events events);

    /// Begins to read. Does nothing the second time.
    void start();
    /// Ends the session and sends `farewell`; `again`: the viewer may come back by itself.
    void close(std::string const& farewell, bool again = false);

    /// Cuts the connection: the viewer has come back before it was known to be gone.
    void cut();
    /// True where it is parked, and a viewer that has all batches up to `last_batch` could go on with it.
    bool can_be_resumed(std::uint64_t last_batch) const;
    /// Lets the session go on with what `earlier`, which is parked, was doing, once the loop calls `take_over`. Where
    /// that had not taken over what it was to resume, this one is to do so instead. To be called before its Welcome.
    void resume(std::shared_ptr<Session> earlier, std::uint64_t last_batch);
    /// Ends being parked: the viewer does not come back, or the session has ended and leaves nothing to go on with.
    void abandon();

    std::uint64_t id() const { return id_; }
    /// The viewer's number, for people: until one is set, that of the connection. Set it before the viewer is let in.
    std::uint64_t number() const { return number_; }
    void set_number(std::uint64_t number) { number_ = number; }

    // The following may be called from any thread:
    /// Ends the session: the server cannot go on with this viewer, which is told the reason, one line, if `tells`, as
    /// is whoever waits for `ended`.
    void end(std::string const& reason, bool again = false, bool tells = true);
    bool is_open() const;
    /// False where nobody reads pictures: it is a worker's, or hears the scene's clock, as servers do that follow it.
    bool has_pictures() const { return codings() != coding::none; }
    bool is_worker() const;
    bool has_spoken() const; ///< a message has come
    bool has_ended() const;
    /// True where it was cut, and is gone on with if the viewer comes back.
    bool is_parked() const;
    /// True where it is open or parked: batches are made for it.
    bool is_served() const;
    /// False while no camera has come. Nothing is made for the viewer before: memory is set aside for its camera, and
    /// what is sent might come before its Welcome.
    bool is_ready() const;
    /// The session that it has to `take_over`, which has none itself; null: none.
    std::shared_ptr<Session> earlier() const;
    /// Takes over what has come to `earlier` and was not taken, and sends once more what the viewer lacks. To be called
    /// from the loop's thread, when nothing more is made for that session. False where there is nothing to take over
    /// any more: that session has been given up, or another one goes on with it.
    bool take_over(Session& earlier);
    /// True where its stream is stuck.
    bool is_stuck() const { return stream_->is_stuck(); }
    /// Codings that the viewer can read, as its Hello said.
    std::uint32_t codings() const;
    /// Replaces `events` by those that have come since the last call, in their order; of cameras, settings and changes
    /// of the clock only the newest. Returns the version of what the viewer asks for: it counts these three.
    std::uint64_t take_events(std::vector<StreamEvent>& events);
    void send(Message const& message);
    /// Sends a batch; that it was sent becomes an event.
    void send_batch(EncodedBatch batch);
    /// Notes that the scene's clock was set.
    void note_clock_change();
    /// Notes whether nothing is left to refine of what the viewer asked for in this version. Returns whether that is
    /// news.
    bool report(std::uint64_t version, bool converged);
    /// The session's part of a status message: newest batch, its camera, convergence.
    Status status() const;
    /// Says in one line what the viewer should have sent by now; nothing where it has.
    std::optional<std::string> overdue(std::chrono::steady_clock::time_point now) const;

private:
    void receive(Message message);
    void receive_hello(Message const& message);
    void receive_camera(CameraUpdate const& camera);
    bool receive_ack(Ack const& ack);
    void receive_evicted(Evicted gone);
    template <class What>
    void add_newest(What const& what);
    void send_batch(std::shared_ptr<Message const> const& batch);
    void drop_kept();
    void fail(std::string const& reason, bool is_cut);

    std::uint64_t const id_;
    std::uint64_t number_ = id_;
    std::shared_ptr<FramedStream> const stream_;
    Events const events_;

    mutable std::mutex mutex_;
    bool started_ = false;
    bool open_ = false; ///< handshake done, not ended
    bool has_spoken_ = false;
    bool ended_ = false;
    bool parked_ = false; ///< ended by a cut, and may be gone on with
    std::shared_ptr<Session> earlier_; ///< the session to be taken over; it has none itself
    std::uint32_t codings_ = coding::exact_colour;
    bool is_worker_ = false;
    std::uint64_t camera_number_ = 0; ///< newest that came; 0: none
    Viewport viewport_; ///< of the newest camera
    std::vector<StreamEvent> waiting_events_; ///< few: none of those that a newer one replaces
    std::size_t waiting_evicted_ = 0; ///< messages and framelets of `Evicted` among these and those of `earlier_`
    std::uint64_t evicted_ = 0; ///< `Evicted` messages that have come, in sessions before this one too
    std::uint64_t version_ = 0; ///< of what the viewer asks for, as `take_events` returns it
    std::uint64_t last_batch_ = 0; ///< newest batch that was sent; 0: none
    std::uint64_t last_ack_ = 0; ///< newest batch that the viewer has answered; 0: none
    std::deque<std::shared_ptr<Message const>> kept_; ///< batches after `last_ack_`, in order
    std::size_t kept_bytes_ = 0;
    std::uint64_t converged_version_ = 0; ///< for which there is nothing left to refine; 0: none
    std::chrono::steady_clock::time_point last_progress_; ///< of what the viewer owes: a hello, a camera or an Ack
};

} // namespace framelet
