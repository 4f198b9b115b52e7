// Loads the scene again when it is told to or its files have changed, on a thread of its own. In: how to load it. Out:
// loaded scenes, one after the other. One that does not load, as it is half written, costs a line of the log.
#pragma once

#include <condition_variable>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "server/scene/file_watch.h"
#include "server/scene/reading/progress.h"
#include "server/session/loaded_scene.h"

namespace framelet {

class SceneReloader {
public:
    using Load = std::function<std::shared_ptr<LoadedScene>(Progress const&)>;
    using Take = std::function<void(std::shared_ptr<LoadedScene>)>;

    /// Scenes are loaded until the end of its life: a load that is on its way then ends when it next reports how far it
    /// is. Without `watch` only where it is asked. `scene_files` are absolute, `files` are what the scene was made of
    /// that is served; `load` throws where it fails.
    SceneReloader(std::optional<FileWatch> watch, std::vector<std::filesystem::path> scene_files,
                  std::filesystem::path environment_file, std::vector<std::filesystem::path> files, Load load,
                  Take take);
    /// Asks for the scene to be loaded again, whether anything has changed or not: a load on its way ends for that when
    /// it next reports how far it is. May be called from any thread.
    void ask();

private:
    static constexpr std::chrono::milliseconds interval{250}; ///< between looks at the files

    void watch();
    void run(std::stop_token const& stop);
    bool wait(std::stop_token const& stop);
    void reload(std::stop_token const& stop);

    std::optional<FileWatch> file_watch_;
    std::vector<std::filesystem::path> const scene_files_;
    std::filesystem::path const environment_file_;
    std::vector<std::filesystem::path> files_; ///< files that the scene was made of
    bool failed_ = false; ///< loading failed the last time: what was missing may be any file of the folder
    Load load_;
    Take take_;
    std::mutex mutex_;
    std::condition_variable_any told_;
    bool asked_ = false;
    std::jthread thread_; ///< ends before the rest does
};

} // namespace framelet
