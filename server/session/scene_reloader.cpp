#include "server/session/scene_reloader.h"

#include <algorithm>
#include <exception>
#include <iterator>
#include <utility>

#include <spdlog/spdlog.h>

#include "common/command_line/program_failure.h"

namespace framelet {
namespace {

/// Ends a load that nobody waits for any more.
struct LoadEnded {};

} // namespace

SceneReloader::SceneReloader(std::optional<FileWatch> watch, std::vector<std::filesystem::path> scene_files,
                             std::filesystem::path environment_file, std::vector<std::filesystem::path> files,
                             Load load, Take take)
    : file_watch_(std::move(watch)), scene_files_(std::move(scene_files)),
      environment_file_(std::move(environment_file)), files_(std::move(files)), load_(std::move(load)),
      take_(std::move(take)) {
    this->watch();
    thread_ = std::jthread([this](std::stop_token const& stop) { run(stop); });
}

void SceneReloader::ask() {
    {
        std::scoped_lock const lock(mutex_);
        asked_ = true;
    }
    told_.notify_one();
}

void SceneReloader::watch() {
    if (!file_watch_) {
        return;
    }
    std::vector<std::filesystem::path> all = files_;
    all.insert(all.end(), scene_files_.begin(), scene_files_.end());
    if (!environment_file_.empty()) {
        all.push_back(environment_file_);
    }
    if (failed_) {
        std::ranges::transform(scene_files_, std::back_inserter(all),
                               [](auto const& file) { return file.parent_path(); });
    }
    file_watch_->watch(all);
}

void SceneReloader::run(std::stop_token const& stop) {
    for (;;) {
        try {
            while (wait(stop)) {
                reload(stop);
                watch();
            }
            return;
        } catch (std::exception const& error) { // most likely for want of memory: what was asked for still is
            spdlog::warn("cannot look at the scene's files: {}", failure_text(error));
            std::unique_lock lock(mutex_);
            told_.wait_for(lock, stop, interval, [] { return false; });
        }
    }
}

/// Waits. True where there is something to load, false where it is to end.
bool SceneReloader::wait(std::stop_token const& stop) {
    std::unique_lock lock(mutex_);
    auto const is_asked = [this] { return asked_; };
    for (;;) {
        bool const asked =
            file_watch_ ? told_.wait_for(lock, stop, interval, is_asked) : told_.wait(lock, stop, is_asked);
        if (stop.stop_requested()) {
            return false;
        }
        bool const changed = file_watch_ && file_watch_->look(std::chrono::steady_clock::now());
        if (asked || changed) {
            asked_ = true; // until loading begins
            return true;
        }
    }
}

void SceneReloader::reload(std::stop_token const& stop) {
    spdlog::info("loading the scene again");
    {
        std::scoped_lock const lock(mutex_);
        asked_ = false;
    }
    try {
        auto scene = load_([this, &stop](std::string_view, double) {
            std::scoped_lock const lock(mutex_);
            if (stop.stop_requested() || asked_) {
                throw LoadEnded();
            }
        });
        files_ = scene->scene.files;
        failed_ = false;
        take_(std::move(scene));
    } catch (LoadEnded const&) { // nor is there anything to say
    } catch (std::exception const& error) {
        failed_ = true;
        spdlog::warn("{}; the scene as it was is served on", failure_text(error));
    }
}

} // namespace framelet
