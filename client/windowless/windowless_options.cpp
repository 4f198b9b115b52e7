#include "client/windowless/windowless_options.h"

#include <unistd.h>

#include "client/frames/frame_writer.h"
#include "client/picture_size.h"
#include "client/tev/tev_sender.h"
#include "client/video/film_sink.h"
#include "common/command_line/number_range.h"
#include "common/error.h"

namespace framelet {
namespace {

ProgramNotes notes() {
    return {
        R"(The camera file is JSON: {"position": [x,y,z], "target": [x,y,z], "up": [0,1,0], "fov_degrees": 45} stands still
("up" and "fov_degrees" may be left out; "orthographic_height", in metres, stands in place of the latter); {"keys":
[{"time": seconds, "position": ..., "target": ...}, ...]} flies smoothly through the keys; {"scene_camera": 0} looks
through a camera of the scene. With "scene_time", in seconds, and "paused" it sets the scene's clock at the start, with
"exposure" the exposure; --seek, --play, --pause and --exposure go before that.

Frames are compressed and written by a thread of their own while batches go on arriving; where it cannot keep up, frames
are shown later, none is left out. A film (.webp or .mp4) is written when the run is over; of a long one 256 MB of
pictures are kept, and what is too much for the thread then is left out.

Where the server is gone for a while, what is held goes on being shown, and the session goes on when it is back; see
--no-reconnect.

With --output - a video goes to standard output (YUV4MPEG2, 4:4:4; BT.709, below 1280x577 BT.601), as long as the run
however slow its reader is, and the statistics go to standard error; once nobody reads it any more the client ends:

    framelet-client HOST --output - | mpv -

SIGINT (Ctrl-C), SIGTERM and SIGHUP end it as the end of --duration does, once what was shown is written; a second
SIGINT or SIGTERM ends it at once.)",
        {{0, "fine; also where nobody reads the video any more, or tev has gone"},
         {1, "a file cannot be used, tev or the server cannot be reached, the server refused the client or was gone at "
             "the end, or the picture did not converge in time"},
         {2, "bad usage"}},
        {"framelet-server", "framelet-viewer", "framelet"}};
}

} // namespace

void add_windowless_options(CLI::App& app, WindowlessOptions& options) {
    prepare_command_line(app, notes());
    add_connection_options(app, options.connection)->required();
    app.option_defaults()->group("Run");
    app.add_option("--size", options.size, "Size of the picture in pixels")
        ->type_name("WIDTHxHEIGHT")
        ->check(readable_by(parse_size))
        ->capture_default_str();
    app.add_option("--duration", options.duration, "Seconds after which to end")
        ->type_name("SECONDS")
        ->default_str("10, with --until-converged 60")
        ->check(number_in(0.0, 1e6));
    app.add_option(
           "--camera", options.camera_file,
           "Camera file: JSON, a still camera or a path; or an address of the web page, of which its camera counts")
        ->type_name("FILE")
        ->default_str("the scene's own view");
    app.add_flag("--until-converged", options.until_converged,
                 "End once the picture is as good as it gets; exit code 1 where that takes longer than --duration");
    app.option_defaults()->group("What is written");
    app.add_option("--output", options.output,
                   "Picture file for each frame, as in frames/%04d.png (or .ppm: larger, quicker); without a number: "
                   "for the last frame; .webp or .mp4: a film; - : a video to standard output")
        ->type_name("FILE")
        ->check(readable_by([](std::string const& text) {
            if (text != standard_output && !is_film_name(text)) {
                FramePattern{text};
            }
        }));
    app.add_option("--sheet", options.sheet,
                   "Contact sheet (.png): three moments of the run as they were shown, below each what it comes to "
                   "once it stands still, which is waited for when the run is over")
        ->type_name("FILE")
        ->check(readable_by([](std::string const& text) {
            if (!text.ends_with(".png")) {
                throw InputError("a contact sheet is a .png file");
            }
        }));
    app.add_option(
           "--tev", options.tev,
           "Show the pictures in the image viewer tev as well, which listens at HOST or HOST:PORT; without a port at "
           "port " +
               std::to_string(default_tev_port))
        ->type_name("ADDRESS")
        ->check(readable_by([](std::string const& text) { parse_address(text, default_tev_port); }));
    app.add_option("--rate", options.rate, "Display frames a second")
        ->type_name("HZ")
        ->default_str("60, with numbered files 10, of a film or video 30")
        ->check(number_in(0.1, 1000.0));
    app.add_option("--output-times", options.output_times,
                   "With numbered files: only the three frames from each of these times of the scene on; the numbers "
                   "stay; written when the run is over")
        ->type_name("SECONDS...")
        ->check(number_in(0.0, 1e6));
    app.add_option("--frames", options.frames_file,
                   "Write a line of JSON for each frame to this file: when it was shown, the scene's time, bytes, CPU")
        ->type_name("FILE");
    app.add_flag("--json", options.json, "Print the statistics as JSON");
    add_display_options(app, options.display);
    app.option_defaults()->group("The scene's clock");
    CLI::Option* const play = app.add_flag("--play", options.play, "Let the scene's clock run");
    app.add_flag("--pause", options.pause, "Stop the scene's clock")->excludes(play);
    app.add_option("--seek", options.seek, "Set the scene's clock to this second")
        ->type_name("SECONDS")
        ->check(number_in(0.0, max_scene_time));
    add_config_option(app);
}

bool is_video(WindowlessOptions const& options) {
    return options.output == standard_output || is_film_name(options.output);
}

double display_rate(WindowlessOptions const& options) {
    if (is_video(options)) {
        return options.rate.value_or(30);
    }
    return options.rate.value_or(options.output.find('%') != std::string::npos ? 10 : 60);
}

double run_seconds(WindowlessOptions const& options) {
    return options.duration.value_or(options.until_converged ? 60 : 10);
}

void check_output_options(WindowlessOptions const& options) {
    bool const is_numbered = !is_video(options) && options.output.find('%') != std::string::npos;
    if (!options.output_times.empty() && !is_numbered) {
        throw InputError("--output-times is for numbered files: a video has all frames, and a single picture none");
    }
    if (options.output == standard_output && ::isatty(STDOUT_FILENO) == 1) {
        throw InputError(
            "--output - writes a video to standard output, which is a terminal: pipe it to a program, as in "
            "framelet-client HOST --output - | mpv -");
    }
}

} // namespace framelet
