// The options of framelet-client. In: the command line. Out: a value.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "client/connection_arguments.h"
#include "client/display_arguments.h"

namespace framelet {

inline constexpr char const* standard_output = "-"; ///< as the value of --output

struct WindowlessOptions {
    ConnectionArguments connection;
    std::string size = "1280x720";
    std::optional<double> duration;
    std::string camera_file;
    std::optional<double> rate;
    std::vector<double> output_times;
    std::string output;
    std::string tev;
    std::string sheet;
    std::string frames_file;
    bool json = false;
    bool until_converged = false;
    DisplayChoice display;
    bool play = false;
    bool pause = false;
    std::optional<double> seek;
};

/// Adds the options to the program's, with its notes; `options` has to outlive `app`.
void add_windowless_options(CLI::App& app, WindowlessOptions& options);

/// True where one film or video is written instead of numbered pictures.
bool is_video(WindowlessOptions const& options);
/// Throws InputError where the options ask for output that cannot be.
void check_output_options(WindowlessOptions const& options);
/// Display frames a second.
double display_rate(WindowlessOptions const& options);
/// Seconds after which the run ends.
double run_seconds(WindowlessOptions const& options);

} // namespace framelet
