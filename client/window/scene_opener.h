// Opens scene files that the user drops on the window: with a private server for the newest, as `framelet view` starts
// one. In: names of files. Out: a session where that came to be, else a line that says why not, and what was served
// before goes on being served.
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
#include "client/window/overlay/overlay_content.h"

namespace framelet {

class SceneOpener {
public:
    using Connect = std::function<std::unique_ptr<ClientCore>(ConnectionOptions const&)>;

    /// `connect` (blocks) and `wake` are called from other threads; `wake` whenever `poll` may have something to say.
    /// `server_needed`: a descriptor that is closed once another scene is open, which tells who started this program
    /// that the server it was started for is not needed any more. `server_options`: options of framelet-server for
    /// every one that is started.
    SceneOpener(Connect connect, std::function<void()> wake, std::optional<int> server_needed = {},
                std::vector<std::string> server_options = {});
    SceneOpener(SceneOpener const&) = delete;
    SceneOpener& operator=(SceneOpener const&) = delete;

    /// Begins to open the files that were dropped on the window, as one scene. One that is still being opened is given
    /// up.
    void open(std::vector<std::string> const& files);
    /// The session with the new scene, once there is one; the server of the one that was open before has ended then.
    std::optional<Connection> poll();
    /// The reason why nothing was opened, told once; empty where there is none.
    std::string take_complaint() { return std::exchange(complaint_, {}); }
    /// The file that is being opened, without its folder, and how many more; empty while none is.
    std::string opening() const;
    /// Shows that file, and how far it has been loaded, as sign and bar; nothing while none is opened.
    void show(OverlayContent& content) const;

    bool has_open() const { return open_ != nullptr; }
    /// The reason why the server of the open scene has ended by itself; empty: it runs, or is not ours.
    std::string end_reason();
    /// Opens the scene again whose server has ended.
    void reopen();

private:
    std::optional<Connection> session();

    Connect const connect_;
    std::function<void()> const wake_;
    std::optional<int> server_needed_;
    std::vector<std::string> const server_options_;
    std::string complaint_;
    std::unique_ptr<PrivateServer> open_;
    std::future<Connection> connecting_; ///< session with the server that follows, whose end ends the attempt
    std::unique_ptr<PrivateServer> opening_;
};

} // namespace framelet
