// The viewer's session as a web page has it: the core, the hand that moves its camera, and frames that come in pieces.
// In: bytes of the page's socket, what the user does. Out: bytes to send, the picture. All of it in the painter's
// thread.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "client/core/camera/camera_controller.h"
#include "client/core/client_core.h"
#include "client/gpu/canvas_choice.h"
#include "client/viewer/bookmark_list.h"
#include "client/web/frame_inbox.h"
#include "client/web/page_connection.h"
#include "client/web/page_screen.h"
#include "protocol/connection/back_off.h"

namespace framelet {

class PageSession {
public:
    /// `send` hands bytes to the socket that is open.
    PageSession(std::string token, std::function<void(Bytes)> send);

    /// The socket has opened: asks for a session, for the one before where it can go on.
    void open();
    /// Takes bytes of the socket, cut anywhere. False: the socket is to be closed, and `close` called.
    bool receive(ByteView bytes);
    /// The socket has taken all that was sent, or has not.
    void note_sent(bool all);
    /// The socket has closed. Returns the seconds after which to open another; nothing where a server has refused for
    /// good. `chance` as in `BackOff`.
    std::optional<double> close(std::string const& reason, double chance);

    /// The core, once a session has been open.
    ClientCore* core() { return core_.get(); }
    /// The user's camera. Call it only where there is a core.
    CameraController& hand() { return *hand_; }
    /// The camera of the scene that is looked through; -1: the user's own.
    int scene_camera() const { return scene_camera_; }
    /// Looks through a camera of the scene. Does nothing where there is none of this number.
    void choose_camera(int number);
    /// The camera that is looked from and its moment, as camera files have it. Call it only where there is a core.
    std::string view() const;
    /// Goes to such a view, of a flight to its beginning. Throws InputError where it is none. Likewise.
    void go_to(std::string const& view);
    /// The user moves the camera: on from where the picture is seen from.
    CameraController& take_hand();

    /// Takes the scene's bookmarks from a text as `bookmarks_text`. Returns what is wrong with it, one line; there are
    /// none then. This and what follows are for where there is a core.
    std::string load_bookmarks(std::string const& text);
    std::string bookmarks() const;
    /// Adds the view that is shown, removes the one that was gone to last, goes to one. Each returns what is to be
    /// said.
    std::string add_bookmark();
    std::string remove_bookmark();
    std::string go_to_bookmark(int number);

    /// What the user wants, also of sessions that are still to be opened.
    ViewerSettings const& settings() const { return settings_; }
    void set_settings(ViewerSettings const& settings);
    /// Shows the scene a little late, as framelet-viewer's --smooth, or not.
    void set_smooth(bool is_smooth);
    /// Draws this over the picture.
    void set_drawn_over(DrawnOver what);
    DrawnOver drawn_over() const { return drawn_over_; }
    void set_viewport(Viewport viewport) { viewport_ = viewport; }
    Viewport viewport() const { return viewport_; }

    /// Shows pictures on the canvas of a WebGL 2 context, which is current in all calls from now on. `wanted` as
    /// framelet-viewer's --painter. False where the processor is to paint, as after `drop_screen`.
    bool set_screen(Painter wanted);
    /// Pictures are in memory from now on, for a canvas without WebGL.
    void drop_screen();
    bool has_screen() const { return screen_ != nullptr; }
    /// Brings the picture up to date, and what is drawn over it; true when it changed. Throws CanvasError as
    /// `ClientCore::update_picture`.
    bool update_picture();
    /// Shows the picture on the screen, which has its size by now. Call it only where there is one.
    void show_picture();
    /// Its size.
    Viewport picture_size() const { return {picture_.width, picture_.height}; }
    /// The last picture, in memory, with what is drawn over it.
    Picture const& picture();
    /// What the page shows beside the picture, JSON.
    std::string state() const;

private:
    /// Throws ProtocolError, and ConnectionError where the server ends or refuses the session.
    void take(Message message);
    void welcome(Welcome greeting);
    Camera present_camera() const;
    void forget_bookmarks();

    PageConnection connection_;
    std::string token_;
    FrameInbox inbox_;
    bool is_welcome_ = false; ///< the server has answered this socket's Hello
    bool is_refused_ = false; ///< and not to be asked again
    std::string reason_; ///< why there is no session; empty: there is one, or none was tried for
    BackOff back_off_;
    std::unique_ptr<ClientCore> core_;
    std::optional<CameraController> hand_;
    std::uint64_t scene_number_ = 0;
    int scene_camera_ = -1;
    std::vector<Bookmark> bookmarks_; ///< the scene's
    int bookmark_ = -1; ///< the one gone to last; -1: none
    bool is_at_bookmark_ = false; ///< the camera has not been moved since
    ViewerSettings settings_;
    bool is_smooth_ = false;
    DrawnOver drawn_over_ = DrawnOver::nothing;
    bool is_overlay_new_ = false; ///< it is to be drawn, be the picture as it was or not
    Viewport viewport_;
    std::unique_ptr<PageScreen> screen_; ///< null: the page shows pictures from memory
    CanvasChoice painter_;
    Picture picture_;
    Picture overlaid_; ///< the picture and what is drawn over it, if anything
    std::vector<PixelRect> changed_; ///< scratch
};

} // namespace framelet
