#include "client/window/scene_opener.h"

#include <chrono>
#include <exception>
#include <filesystem>
#include <utility>

#include <unistd.h>

#include "client/window/overlay/overlay_text.h"
#include "common/error.h"

namespace framelet {

SceneOpener::SceneOpener(Connect connect, std::function<void()> wake, std::optional<int> server_needed,
                         std::vector<std::string> server_options)
    : connect_(std::move(connect)), wake_(std::move(wake)), server_needed_(server_needed),
      server_options_(std::move(server_options)) {}

void SceneOpener::open(std::vector<std::string> const& files) {
    if (files.empty()) {
        return;
    }
    opening_.reset();
    connecting_ = {};
    try {
        opening_ = std::make_unique<PrivateServer>(files, server_options_, ServerErrors::kept, wake_);
    } catch (std::exception const& error) {
        complaint_ = error.what();
    }
}

std::optional<Connection> SceneOpener::poll() {
    if (!opening_) {
        return {};
    }
    try {
        std::optional<Connection> out = session();
        if (out) {
            open_ = std::exchange(opening_, nullptr);
            if (std::optional<int> const needed = std::exchange(server_needed_, std::nullopt)) {
                ::close(*needed);
            }
        }
        return out;
    } catch (std::exception const& error) {
        complaint_ = error.what();
        opening_.reset();
        return {};
    }
}

/// The session with the scene that is being opened, once there is one. Throws where there will be none.
std::optional<Connection> SceneOpener::session() {
    if (connecting_.valid()) {
        bool const is_ready = connecting_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
        return is_ready ? std::optional(connecting_.get()) : std::nullopt;
    }
    if (std::optional<std::string> const address = opening_->address()) {
        ConnectionOptions options;
        options.server = parse_server_address(*address);
        options.reconnect = true; // this machine may sleep for a while
        connecting_ = std::async(std::launch::async, [options, connect = connect_, wake = wake_] {
            Connection out{connect(options), options};
            wake();
            return out;
        });
    } else if (!opening_->process().running()) {
        throw InputError(opening_->end_reason());
    }
    return {};
}

std::string SceneOpener::opening() const {
    if (!opening_) {
        return "";
    }
    std::size_t const others = opening_->scenes().size() - 1;
    return std::filesystem::path(opening_->scenes().front()).filename().string() +
           (others > 0 ? " and " + std::to_string(others) + " more" : "");
}

void SceneOpener::show(OverlayContent& content) const {
    std::optional<LoadProgress> const progress = opening_ ? opening_->progress() : std::nullopt;
    content.sign = opening_text(opening(), progress ? progress->stage : "");
    if (progress) {
        content.progress = static_cast<float>(progress->percent) / 100;
    }
}

std::string SceneOpener::end_reason() {
    return open_ && !open_->process().running() ? open_->end_reason() : "";
}

void SceneOpener::reopen() {
    open(std::vector<std::string>(open_->scenes()));
}

} // namespace framelet
