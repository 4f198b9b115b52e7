// The viewer's loop: hands -> camera, batches -> picture, both at display rate.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "client/core/camera/camera_controller.h"
#include "client/core/camera/camera_path.h"
#include "client/core/client_core.h"
#include "client/core/picture/making_time.h"
#include "client/display_choice.h"
#include "client/gpu/canvas_choice.h"
#include "client/video/recorder.h"
#include "client/window/attempts.h"
#include "client/window/connection.h"
#include "client/window/escape_key.h"
#include "client/window/kept/bookmarks.h"
#include "client/window/kept/viewer_memory.h"
#include "client/window/overlay/overlay.h"
#include "client/window/overlay/overlay_text.h"
#include "client/window/resize.h"
#include "client/window/scene_opener.h"
#include "client/window/window.h"

namespace framelet {

class Viewer {
public:
    /// `connection` wakes the window on news; `options_for` is for servers that the user names. What `choice` does not
    /// say is as it is remembered. `camera`: to begin with. Scenes that are dropped are opened by `opener`, what is to
    /// be remembered goes into `memory`; both must outlive this. `painter` is of the window's context.
    Viewer(Window& window, Connection connection, OptionsFor options_for, SceneOpener& opener,
           DisplayChoice const& choice, std::optional<CameraPath> const& camera, ViewerMemory& memory,
           CanvasChoice painter);

    /// Runs until the user quits, or a signal tells the program to end. Returns the exit code: 1 where the user quit
    /// and the server was gone.
    int run();

private:
    using Clock = std::chrono::steady_clock;
    static constexpr double note_seconds = 2;
    static constexpr double long_note_seconds = 6; ///< for notes that are to be read

    void adopt(std::unique_ptr<ClientCore> core);
    void note_server();
    void try_server(NamedServer const& server);
    void look_at_scene();
    bool apply(WindowInput const& input, double seconds);
    void apply(OverlayActions const& asked);
    void take_pivot(WindowInput const& input);
    void apply(Command command);
    void escape();
    std::string clock_lacks() const;
    void ask_clock(std::uint8_t fields, ClockState const& state);
    void step_clock(double seconds);
    void choose_scene_camera(int number);
    void leave_scene_camera();
    void take_view(Command command);
    void change_exposure(float stops);
    void change_bias(float step);
    void toggle_smoothing();
    void draw_over(DrawnOver what);
    void save_screenshot(bool with_depth);
    void toggle_recording();
    void watch_recording();
    Camera present_camera() const;
    void change_bookmarks(std::function<void()> const& change);
    void add_bookmark();
    void remove_bookmark(int number);
    void go_to_bookmark(int number);
    void copy_camera(bool saves);
    void take_camera(CameraPath const& path);
    void take_dropped(std::vector<std::string> const& files);
    void paste_camera();
    void say(std::string note, double seconds = note_seconds);
    void watch_connection();
    void watch_opener();
    bool make_picture(Clock::time_point shown_at);
    bool update_shown_picture();
    Picture const& shown_picture();
    std::string painter_text() const;
    void take_figures();
    TimeLine time_line() const;
    CameraMenu camera_menu(Welcome const& welcome) const;
    OverlayContent overlay_content();
    void remember_exposure();
    double seconds_now() const;

    Window& window_;
    ConnectionOptions connection_;
    OptionsFor const options_for_;
    SceneOpener& opener_;
    ViewerMemory& memory_;
    Overlay overlay_;
    std::unique_ptr<ClientCore> core_;
    std::uint64_t scene_number_ = 0; ///< the core's; 0: none yet
    bool interrupted_ = false; ///< the core tries for another session
    bool controlled_ = true; ///< what `ClientCore::controls` said last
    std::string scene_name_;
    std::uint64_t scene_source_ = 0; ///< as in Welcome
    glm::dvec3 scene_origin_{0, 0, 0}; ///< likewise
    std::optional<CameraController> controller_;
    int scene_camera_ = -1;
    std::optional<Bookmarks> bookmarks_; ///< the scene's
    int bookmark_ = -1; ///< the one gone to last; -1: none
    bool is_at_bookmark_ = false; ///< the camera has not been moved since
    std::optional<Vec3> grabbed_; ///< point of the world that the hands have taken hold of, until the camera moves
    std::optional<float> const chosen_exposure_; ///< by the command line, for all scenes; stops
    bool has_set_exposure_ = false; ///< by hand, in this scene
    ViewerSettings settings_;
    double lag_seconds_; ///< 0: the scene is not smoothed
    double const chosen_lag_seconds_; ///< the lag when it is smoothed
    std::string lost_; ///< why there is no session; empty while there is one
    std::optional<Attempts> attempts_; ///< at another, which the user has asked for

    CanvasChoice painter_;
    Picture picture_; ///< where it is not on the canvas; else it has its size alone
    bool is_on_canvas_ = false;
    PictureState picture_state_ = PictureState::coarse; ///< at least so far had the picture come
    double made_ = 0; ///< when the picture was made, by `seconds_now`
    MakingTime showing_; ///< from when a picture is made until it is on the display
    std::vector<PixelRect> changed_;
    SteadySize steady_size_;
    OldPicture old_picture_;
    std::optional<Viewport> uploaded_size_; ///< of the picture that the window has
    bool show_help_ = false;
    DrawnOver drawn_over_;
    bool overlay_toggled_ = false; ///< since the picture was uploaded
    Picture overlaid_; ///< the picture and what is drawn over it, if anything
    RateMeter meter_;
    StatisticsHistory history_;
    StatisticsPanel figures_;
    std::optional<Recorder> recorder_; ///< until its film is written
    double recording_since_ = 0;
    std::string note_;
    double note_until_ = 0;
    EscapeKey escape_;
    bool quit_ = false;
    Clock::time_point const start_ = Clock::now();
};

} // namespace framelet
