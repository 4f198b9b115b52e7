// Opens scene files, the one of the command line and those that the user drops on the window: with a private server for
// the newest. In: names of files. Out: a session where that came to be, else a line that says why not, and what was
// served before goes on being served.
#pragma once

#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "client/processes/private_server.h"
#include "client/window/connection.h"
#include "client/window/file_dialog.h"
#include "client/window/overlay/overlay_content.h"

namespace framelet {

class SceneOpener {
public:
    using Connect = std::function<std::unique_ptr<ClientCore>(ConnectionOptions const&)>;

    /// `connect` (blocks) and `wake` are called from other threads; `wake` whenever `poll` may have something to say.
    /// `server_options`: options of framelet-server for the scene of the command line; other scenes are served with
    /// those that count for any.
    SceneOpener(Connect connect, std::function<void()> wake, std::vector<std::string> server_options = {});
    SceneOpener(SceneOpener const&) = delete;
    SceneOpener& operator=(SceneOpener const&) = delete;

    /// Begins to open the scene of the command line. `connection`: what that says beside the server's address.
    void open_first(std::vector<std::string> const& files, ConnectionOptions connection);
    /// Begins to open the files that were dropped on the window, as one scene. One that is still being opened is given
    /// up.
    void open(std::vector<std::string> const& files);
    /// Lets the user choose files, which are opened likewise.
    void choose();
    /// The session with the new scene, once there is one; the server of the one that was open before has ended then.
    std::optional<Connection> poll();
    /// The reason why nothing was opened, told once; empty where there is none.
    std::string take_complaint() { return std::exchange(complaint_, {}); }
    /// The exit code of a program whose only purpose was to open what was asked for last: that of the server which
    /// could not, else 0.
    int exit_code() const { return exit_code_; }
    /// The file that is being opened, without its folder, and how many more; empty while none is.
    std::string opening() const;
    /// Shows that file, and how far it has been loaded, as sign and bar; nothing while none is opened.
    void show(OverlayContent& content) const;

    bool has_open() const { return open_ != nullptr; }
    /// The reason why the server of the open scene has ended by itself; empty: it runs, or is not ours.
    std::string end_reason();
    bool can_reopen() const { return open_ || !asked_.files.empty(); }
    /// Opens the scene again whose server has ended, or that could not be opened; goes on where one is being opened.
    void reopen();
    /// Gives up what is being opened.
    void give_up() {
        opening_.reset(); // so that the attempt to connect, which is waited for, ends with the server
        connecting_ = {};
    }
    /// Ends the server of the open scene, which is not looked at any more.
    void close() { open_.reset(); }

private:
    struct Scene {
        std::vector<std::string> files; ///< shown together
        std::vector<std::string> server_options;
        ConnectionOptions connection;
    };
    void begin(Scene scene);
    std::optional<Connection> session();

    FileDialog dialog_;
    Connect const connect_;
    std::function<void()> const wake_;
    std::vector<std::string> const server_options_;
    std::string complaint_;
    int exit_code_ = 0;
    Scene open_scene_;
    std::unique_ptr<PrivateServer> open_;
    Scene asked_; ///< the one that is being opened, or was tried last
    std::future<Connection> connecting_; ///< session with the server that follows, whose end ends the attempt
    std::unique_ptr<PrivateServer> opening_;
};

} // namespace framelet
