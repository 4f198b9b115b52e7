// The viewer without a window: holds the connection, takes in batches, and turns what it holds into a picture whenever
// it is asked to, also while the server is gone. In: camera, settings, clock requests. Out: picture, status,
// statistics. Two threads share it: the connection's takes in what the server sends, the display's makes pictures.
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
#include "client/core/picture/making_time.h"
#include "client/core/picture/session_pictures.h"
#include "client/core/session/arrived_batches.h"
#include "client/core/session/asked_view.h"
#include "client/core/session/server_state.h"
#include "client/core/session/told_evictions.h"
#include "protocol/codec/batch_codec.h"
#include "protocol/connection/server_connection.h"

namespace framelet {

/// Greatest lag with which the scene may be shown, seconds.
inline constexpr double max_lag_seconds = 1;
/// Lag that suffices where a server renders some ten whole frames a second, seconds.
inline constexpr double usual_lag_seconds = 0.1;

/// All members may be called from any thread; `update_picture` and `draw_overlay` from one at a time. Painting holds
/// nothing up: what comes meanwhile is decoded and answered, and shows in the next picture.
class ClientCore {
public:
    /// Connects (blocks) and opens the session. `on_news` is called from the connection's thread whenever there is
    /// something new to show or to know; it must not call back. Throws as ServerConnection does.
    explicit ClientCore(ConnectionOptions const& options, std::function<void()> on_news = {});
    ClientCore(ClientCore const&) = delete;
    ClientCore& operator=(ClientCore const&) = delete;

    /// The Welcome of the newest session.
    Welcome welcome() const;
    /// A number that counts up where a session is of another scene than the one before, of which nothing is held any
    /// more then.
    std::uint64_t scene_number() const;

    /// Asks for this view. Only the newest one is kept while the network is busy. `scene_camera` >= 0: through that
    /// camera of the scene. Call it at most once a display frame; a view that equals the last one costs nothing.
    void set_view(Camera const& camera, Viewport viewport, int scene_camera = -1);
    /// Tells the server what this viewer wants, in the sessions that follow as well.
    void set_settings(ViewerSettings const& settings);
    /// Shows the scene, not the camera, `lag_seconds` late, in [0, `max_lag_seconds`], interpolated between what was
    /// rendered before that moment and after it instead of extrapolated from what came last; 0: not late. Has no effect
    /// without `ViewerSettings::reproject` and where the scene never moves. A camera of the scene that is looked
    /// through is late too. While it is on, a second cache, two pictures and the batches of that time are held.
    void set_smoothing(double lag_seconds);
    /// Asks for the scene's clock to be set; `clock` answers as if that were granted, until the server says how it is.
    /// Does nothing where `controls` is false or the session is interrupted.
    void request_clock(ClockRequest const& request);

    /// Brings `picture` up to date with what has come, and with the newest camera and the present scene time: what is
    /// held is moved to where it belongs now (`ViewerSettings::reproject`). Call it for every display frame. True when
    /// it changed. `changed` gets the rectangles that may differ. While nothing has come for a new viewport, the
    /// picture stays as it is, in its old size. A picture that lies elsewhere than that of the last call, or has
    /// another size, is written as a whole: a new one has no size at first, since it might lie where the last one lay.
    /// `shown_at`: the time when it will be seen, of which it is to be; in the past: as soon as it is ready. Throws
    /// std::bad_alloc where memory is missing for it: nothing more is to be asked of the core then. With a canvas what
    /// is moved is painted there, in the calling thread, and `picture` has its size alone: `is_on_canvas` says so.
    /// Throws CanvasError where that fails; called again without a canvas it goes on.
    bool update_picture(Picture& picture, std::vector<PixelRect>& changed,
                        std::chrono::steady_clock::time_point shown_at = {}, BlockCanvas* canvas = nullptr);
    /// True when the last picture is on the canvas and not in memory.
    bool is_on_canvas() const;
    /// Seconds that `update_picture` will take, most likely no longer.
    double making_seconds() const;

    /// Sets what `draw_overlay` draws over pictures that are made from now on.
    void set_drawn_over(DrawnOver what);
    /// Draws over a copy of the picture that `update_picture` made: outlines of the framelets that are held, as
    /// `draw_outlines`, or of the newest batch alone, as `draw_arrivals`; how far its pixels are to be trusted, as
    /// `draw_confidence` (outlines as well, where nothing is moved; while the scene is smoothed, of what came last);
    /// how often each 16x16 pixels are replaced, as `RefreshRates`; or what nothing is held of, as `draw_holes`. A
    /// picture of another size stays as it is.
    void draw_overlay(Picture& picture);
    /// True while what is drawn over changes though the picture does not.
    bool overlay_fades() const;

    /// The point of the world that the last picture shows at this position, pixel coordinates; nothing where that is
    /// not known, or infinitely far. Takes about as long as a picture.
    std::optional<Vec3> point_at(Vec2 position) const;
    /// The depths of the last picture's pixels, as `find_shown_depths` gives them. Takes longer than a picture.
    std::vector<float> picture_depths() const;

    /// Waits until something has come since the last call, or the time is over; true when something has.
    bool wait_for_news(std::chrono::nanoseconds at_most);

    /// The reason why the session ended for good, one line; nothing while it is open or another is tried for.
    std::optional<std::string> end_reason() const;
    /// The reason why the session was interrupted, one line; nothing while one is open. Meanwhile what is held is
    /// shown, the scene's clock stands, and the view and settings that are set go to the next session. With
    /// `ConnectionOptions::reconnect` only.
    std::optional<std::string> interruption() const;
    /// True when this viewer may set the scene's clock; false while another viewer controls it.
    bool controls() const;
    /// True when the server has nothing more to say about the newest view and all of it has arrived.
    bool is_complete() const;
    /// The server's last Status; `clock` has the present time.
    Status status() const;
    /// The scene clock as it should stand now.
    ClockState clock() const;
    /// The camera of the last picture; before the first one, the scene's start camera.
    Camera shown_camera() const;
    ClientStatistics statistics() const;

private:
    using Clock = std::chrono::steady_clock;

    static double seconds_between(Clock::time_point from, Clock::time_point to) {
        return std::chrono::duration<double>(to - from).count();
    }

    /// Sends the newest view where nothing else is queued: one camera at most is in the network's queue, and of those
    /// that are set while it waits only the newest is sent. Call it with `mutex_` held.
    void send_view();
    /// Puts all batches that have arrived into what pictures are made of. Call it with `picture_mutex_` held, without
    /// `mutex_`.
    void take_in();
    /// True once the server has said that the newest view has converged, and all its batches have come. Call it with
    /// `mutex_` held.
    bool is_settled() const;
    /// As `is_complete`. Call it with `mutex_` held.
    bool shows_all() const;
    /// True once after another scene has taken the place of the one that was shown.
    bool is_clean_start();
    /// The request for a picture of what will be the present when it is seen.
    PictureRequest picture_request() const;
    /// Age in seconds of what the last picture shows when it is seen: since its camera was set or, through a camera of
    /// the scene, since its moment was the present; -1: it shows nothing new. Call it with `mutex_` held.
    double photon_seconds(Clock::time_point seen);

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
    /// same scene. Call it with `picture_mutex_` held.
    void forget_session(Welcome const& next);
    void tell_news();
    /// Tells the server of all framelets that the maker has evicted. Call it with `picture_mutex_` held.
    void tell_evicted(PictureMaker& maker);
    /// Notes in the statistics what is held. Call it with `mutex_` held. `coverage` < 0: nothing has come.
    void note_held(PictureMaker const& maker, double coverage, bool is_fine, Clock::time_point now);
    /// Notes the time from when this camera was sent until the first batch seen from it was received. Call it with
    /// `mutex_` held.
    void note_round_trip(std::uint64_t camera_number, Clock::time_point received);

    std::function<void()> const on_news_; ///< called without a lock
    Clock::time_point const start_ = Clock::now();
    // State of this session's stream, used by the connection's thread only.
    std::optional<BatchCodec> codec_{std::in_place};
    std::optional<BatchMemory> memory_{std::in_place};
    bool is_whole_ = true; ///< every batch that has come is decoded and among `arrived_`, or taken in already
    Clock::time_point given_back_ = start_; ///< when memory was given back last

    /// Guards what pictures are made of. Whoever holds it may lock `mutex_` as well, not the other way round.
    mutable std::mutex picture_mutex_;
    SessionPictures pictures_;
    std::vector<Batch> taken_; ///< scratch
    std::vector<SentTile> evicted_; ///< scratch

    mutable std::mutex mutex_; // guards all that follows, but the connection; never held for long
    std::condition_variable news_arrived_;
    bool news_ = false;
    ArrivedBatches arrived_; ///< batches that are not in the maker yet
    ToldEvictions told_evictions_;
    AskedView asked_;
    ViewerSettings viewer_settings_;
    PictureSettings picture_settings_;
    DrawnOver drawn_over_ = DrawnOver::nothing;
    bool has_picture_ = false; ///< something is held of the newest viewport
    std::uint64_t last_batch_ = 0;
    ShownPicture shown_; ///< the last one; before there is one, it has the start camera
    Clock::time_point shown_at_; ///< when the last picture was to be seen; does not go back
    MakingTime making_;
    bool is_smooth_ = false;
    ServerState server_;
    Welcome welcome_;
    std::uint64_t scene_number_ = 1;
    bool starts_clean_ = false; ///< what is shown is of another scene, and is to be cleared
    std::optional<std::string> interruption_;
    std::optional<std::string> end_reason_;
    ClientStatistics statistics_;

    std::unique_ptr<ServerConnection> connection_; // last: its thread uses the rest
};

/// The camera of the scene that a viewer looks through until the user moves: the first one, its animation included; -1
/// where the scene has none (then `Welcome::start_camera`).
inline int start_scene_camera(Welcome const& welcome) {
    return welcome.cameras.empty() ? -1 : 0;
}

} // namespace framelet
