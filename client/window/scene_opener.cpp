#include "client/window/scene_opener.h"

#include <chrono>
#include <exception>
#include <filesystem>
#include <utility>

#include "client/window/overlay/overlay_text.h"
#include "common/error.h"

namespace framelet {
namespace {

/// The options of a server without those for its scene alone, as a name of one of its clips, and those that cannot be
/// had twice, as a port or a file that is written, what its log looks like, which the window reads, and who may
/// connect.
std::vector<std::string> kept_for_other_scenes(std::vector<std::string> const& options) {
    std::vector<std::string> out;
    for (std::size_t i = 0; i < options.size(); ++i) {
        std::string const name = options[i].substr(0, options[i].find('='));
        bool const has_value = name == "--clip" || name == "--scene" || name == "--up" || name == "--unit" ||
                               name == "--port" || name == "--log" || name == "--bind" || name == "--token-file" ||
                               name == "--control-token-file" || name.starts_with("--tls-") ||
                               name.starts_with("--metrics") || name.starts_with("--record");
        if (!has_value && name != "--allow-outside") {
            out.push_back(options[i]);
        } else if (has_value && options[i] == name) {
            ++i; // its value
        }
    }
    return out;
}

} // namespace

SceneOpener::SceneOpener(Connect connect, std::function<void()> wake, std::vector<std::string> server_options)
    : dialog_(wake), connect_(std::move(connect)), wake_(std::move(wake)), server_options_(std::move(server_options)) {}

void SceneOpener::open_first(std::vector<std::string> const& files, ConnectionOptions connection) {
    begin({files, server_options_, std::move(connection)});
}

void SceneOpener::open(std::vector<std::string> const& files) {
    if (!files.empty()) {
        begin({files, kept_for_other_scenes(server_options_), {}});
    }
}

void SceneOpener::reopen() {
    if (!opening_) { // else it goes on
        begin(open_ ? open_scene_ : asked_);
    }
}

void SceneOpener::begin(Scene scene) {
    asked_ = std::move(scene);
    exit_code_ = 0;
    give_up();
    try {
        opening_ = std::make_unique<PrivateServer>(asked_.files, asked_.server_options, wake_);
    } catch (std::exception const& error) {
        complaint_ = error.what();
        exit_code_ = 1;
    }
}

void SceneOpener::choose() {
    try {
        dialog_.open();
    } catch (std::exception const& error) {
        complaint_ = error.what();
    }
}

std::optional<Connection> SceneOpener::poll() {
    open(dialog_.poll());
    if (!opening_) {
        return {};
    }
    try {
        std::optional<Connection> out = session();
        if (out) {
            open_ = std::exchange(opening_, nullptr);
            open_scene_ = asked_;
        }
        return out;
    } catch (std::exception const& error) {
        complaint_ = error.what();
        exit_code_ = opening_->process().running() ? 1 : opening_->process().exit_code();
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
        ConnectionOptions options = asked_.connection;
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
    std::size_t const others = asked_.files.size() - 1;
    return std::filesystem::path(asked_.files.front()).filename().string() +
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

} // namespace framelet
