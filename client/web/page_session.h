// The viewer's session as a web page has it: the core, the hand that moves its camera, and frames that come in pieces.
// In: bytes of the page's socket, what the user does. Out: bytes to send, the picture. All of it in one thread.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "client/core/camera/camera_controller.h"
#include "client/core/client_core.h"
#include "client/core/connection/back_off.h"
#include "client/web/page_connection.h"

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
    /// The user moves the camera: on from where the picture is seen from.
    CameraController& take_hand();
    /// What the user wants, also of sessions that are still to be opened.
    void set_settings(ViewerSettings const& settings);
    void set_viewport(Viewport viewport) { viewport_ = viewport; }
    Viewport viewport() const { return viewport_; }

    /// Brings the picture up to date; true when it changed.
    bool update_picture();
    Picture const& picture() const { return picture_; }
    /// What the page shows beside the picture, JSON.
    std::string state() const;

private:
    /// Takes the frames of the inbox that are whole. Throws ProtocolError, and ConnectionError where the server ends or
    /// refuses the session.
    void take_frames();
    void take(Message message);
    void welcome(Welcome greeting);

    PageConnection connection_;
    std::string token_;
    Bytes inbox_; ///< frames that have not come to their end
    bool is_welcome_ = false; ///< the server has answered this socket's Hello
    bool is_refused_ = false; ///< and not to be asked again
    std::string reason_; ///< why there is no session; empty: there is one, or none was tried for
    BackOff back_off_;
    std::unique_ptr<ClientCore> core_;
    std::optional<CameraController> hand_;
    std::uint64_t scene_number_ = 0;
    int scene_camera_ = -1;
    ViewerSettings settings_;
    Viewport viewport_;
    Picture picture_;
    std::vector<PixelRect> changed_; ///< scratch
};

} // namespace framelet
