// What the two threads of a viewer share: the connection's, which takes in what the server sends, and the display's,
// which makes pictures of that. In: messages, news of the connection. Out: batches for the pictures, answers for the
// server, statistics.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "client/core/client_statistics.h"
#include "client/core/connection/server_connection.h"
#include "client/core/picture/making_time.h"
#include "client/core/picture/session_pictures.h"
#include "client/core/session/arrived_batches.h"
#include "client/core/session/asked_view.h"
#include "client/core/session/server_state.h"
#include "client/core/session/told_evictions.h"
#include "protocol/codec/batch_codec.h"

namespace framelet {

/// Its members are `ClientCore`'s as well, which locks as they say.
struct ClientSession {
    using Clock = std::chrono::steady_clock;

    static double seconds_between(Clock::time_point from, Clock::time_point to) {
        return std::chrono::duration<double>(to - from).count();
    }

    /// Connects (blocks). Throws as ServerConnection does.
    ClientSession(ConnectionOptions const& options, std::function<void()> news_handler);
    /// Sends the newest view where nothing else is queued: one camera at most is in the network's queue, and of those
    /// that are set while it waits only the newest is sent. Call it with `mutex` held.
    void send_view();
    /// Puts all batches that have arrived into what pictures are made of. Call it with `picture_mutex` held, without
    /// `mutex`.
    void take_in();
    /// True once the server has said that the newest view has converged, and all its batches have come. Call it with
    /// `mutex` held.
    bool is_settled() const;
    /// As `ClientCore::is_complete`. Call it with `mutex` held.
    bool is_complete() const;
    /// True once after another scene has taken the place of the one that was shown.
    bool is_clean_start();
    /// The request for a picture of what will be the present when it is seen.
    PictureRequest picture_request() const;
    /// Age in seconds of what the last picture shows, which is of the camera of this number, when it is seen: since
    /// that camera was set or, through a camera of the scene, since its moment was the present; -1: it shows nothing
    /// new. Call it with `mutex` held.
    double photon_seconds(std::uint64_t number, Clock::time_point seen);

    std::function<void()> on_news; ///< called without a lock
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

private:
    NumberedView wanted_view() const;
    void receive(Message message);
    void receive_batch(EncodedBatch const& encoded);
    /// Gives back memory that is free now and then: framelets leave theirs in small blocks, others behind them.
    void give_back_memory(Clock::time_point now);
    /// Interrupts the session; what has come is kept for the time without one.
    void pause_session(std::string reason);
    /// Asks to go on with the session before, where the viewer holds what the server thinks it holds, but for batches
    /// that are still to come.
    void ask_to_go_on(Hello& hello);
    void begin_session(Welcome greeting);
    /// Drops the state of the session that has ended. Its picture goes on being shown if the next session is of the
    /// same scene. Call it with `picture_mutex` held.
    void forget_session(Welcome const& next);
    void tell_news();
    /// Tells the server of all framelets that the maker has evicted. Call it with `picture_mutex` held.
    void tell_evicted(PictureMaker& maker);
    /// Notes in the statistics what is held. Call it with `mutex` held. `coverage` < 0: nothing has come.
    void note_held(PictureMaker const& maker, double coverage, bool is_fine, Clock::time_point now);
    /// Notes the time from when this camera was sent until the first batch seen from it was received. Call it with
    /// `mutex` held.
    void note_round_trip(std::uint64_t camera_number, Clock::time_point received);
};

} // namespace framelet
