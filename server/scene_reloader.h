// Loads the scene again when it is told to or its files have changed, on a thread of its own. In: how to load it. Out:
// loaded scenes, one after the other. One that does not load, as it is half written, costs a line of the log.
#pragma once

#include <condition_variable>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "server/scene/file_watch.h"
#include "server/session/loaded_scene.h"

namespace framelet {

class SceneReloader {
public:
    using Load = std::function<std::shared_ptr<LoadedScene>()>;
    using Take = std::function<void(std::shared_ptr<LoadedScene>)>;

    /// Has to be told to look before the scene is loaded for the first time, so that nothing is missed meanwhile.
    SceneReloader(bool watches, std::filesystem::path scene_file, std::filesystem::path environment_file);

    /// From now on scenes are loaded, until the end of its life. `load` throws where that fails.
    void start(std::vector<std::filesystem::path> files, Load load, Take take);
    /// From any thread: whether anything has changed or not.
    void ask();

private:
    static constexpr std::chrono::milliseconds interval{250}; ///< between looks at the files

    void watch();
    void run(std::stop_token const& stop);
    bool wait(std::stop_token const& stop);
    void reload();

    bool const watches_;
    std::filesystem::path const scene_file_, environment_file_;
    std::vector<std::filesystem::path> files_; ///< that the scene was made of
    bool failed_ = false; ///< the last time: what was missing may be any file of the folder
    FileWatch file_watch_;
    Load load_;
    Take take_;
    std::mutex mutex_;
    std::condition_variable_any told_;
    bool asked_ = false;
    std::jthread thread_; ///< ends before the rest does
};

} // namespace framelet
