// The command line of framelet-server, as a value.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "server/program/log.h"
#include "server/scene/reading/import_options.h"
#include "server/session/loaded_scene.h"
#include "server/session/loop/priority.h"
#include "server/session/server.h"

namespace framelet {

struct Options {
    std::vector<std::filesystem::path> scenes; ///< files, shown together
    ImportOptions import;
    std::optional<std::filesystem::path> environment;
    LookOptions look{.light_choice = LightChoice::by_view}; ///< but the scene's files may tell the method
    int threads = 0; ///< 0: all cores
    int nice = default_nice; ///< of all threads
    bool quiet = false;
    LogFormat log = LogFormat::text;
    std::string list_as = "framelet-server"; ///< what shows a scene, in the list of those of a folder
    std::optional<int> news; ///< descriptor for lines of loading and addresses, for who started this program
    bool watch = false; ///< load the scene again when its files change
    bool info = false; ///< print what is in the scene, and serve nothing
    bool json = false; ///< that as JSON
    std::filesystem::path record_events; ///< file for what came to the streams; empty: none
    std::filesystem::path token_file, control_token_file; ///< empty: none
    bool local_token = false; ///< viewers of this user on this machine get one by themselves, others none
    std::optional<std::uint16_t> metrics_port; ///< nothing: none
    std::string metrics_bind = "127.0.0.1";
    std::filesystem::path web_files; ///< folder of the page for browsers; empty: the one that is installed
    bool no_web = false; ///< browsers are not answered
    std::string web_origin; ///< of pages elsewhere that may connect; empty: none
    std::optional<ConnectionOptions> work_for; ///< the server that it is a worker of; nothing: it is a server itself
    bool browser = false; ///< open the page with this desktop's browser
    ServerOptions server;
};

/// The options, or the exit code where there is nothing to run (help, version: 0; bad usage: 2, with one line on
/// stderr).
std::variant<Options, int> parse_options(int argc, char const* const* argv);

} // namespace framelet
