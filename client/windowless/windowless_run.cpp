#include "client/windowless/windowless_run.h"

#include <algorithm>
#include <chrono>
#include <iostream>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <unistd.h>

#include "client/core/camera/camera_path.h"
#include "client/core/client_core.h"
#include "client/core/picture/display_timing.h"
#include "client/frames/frame_choice.h"
#include "client/frames/frame_log.h"
#include "client/frames/output_folder.h"
#include "client/processes/end_signals.h"
#include "client/sheet/sheet_moments.h"
#include "client/statistics_text.h"
#include "client/tev/tev_sender.h"
#include "client/video/film_sink.h"
#include "client/video/video_writer.h"
#include "common/command_line/standard_output.h"
#include "common/cpu_clock.h"
#include "common/error.h"
#include "common/files/picture_writer.h"
#include "common/program_line.h"
#include "protocol/connection/unknown_certificate.h"

namespace framelet {
namespace {

using Clock = std::chrono::steady_clock;
using FrameSinks = std::vector<std::unique_ptr<FrameSink>>;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

double unix_seconds() {
    return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

std::optional<CameraPath> read_camera(WindowlessOptions const& options) {
    return options.camera_file.empty() ? std::nullopt : std::optional(read_camera_path(options.camera_file));
}

/// Sets the clock as the camera file says, and as the options say, which go before it.
void ask_clock(ClientCore& core, WindowlessOptions const& options, std::optional<CameraPath> const& path) {
    ClockRequest request = path ? path->moment.clock_request() : ClockRequest();
    if (options.play || options.pause) {
        request.set |= ClockRequest::playing;
        request.state.playing = options.play;
    }
    if (options.seek) {
        request.set |= ClockRequest::time;
        request.state.time = *options.seek;
    }
    if (request.set != 0 && !core.controls()) {
        print_line("framelet-client", "another viewer controls the scene's clock: --play, --pause, --seek and what the "
                                      "camera file says of it do nothing");
    }
    if (request.set != 0) {
        core.request_clock(request);
    }
}

/// Waits until that time; returns early where the session has ended.
void wait_until(ClientCore& core, Clock::time_point time) {
    while (Clock::now() < time && !core.end_reason()) {
        core.wait_for_news(time - Clock::now());
    }
}

/// Says on stderr that the session is interrupted or goes on, where that is news; returns which of them it is.
bool tell_interruption(ClientCore const& core, bool interrupted) {
    std::optional<std::string> const reason = core.interruption();
    if (reason && !interrupted) {
        print_line("framelet-client", *reason + "; trying to connect again");
    } else if (!reason && interrupted && !core.end_reason()) {
        print_line("framelet-client", "connected again");
    }
    return reason.has_value();
}

FrameSinks make_sinks(WindowlessOptions const& options, std::optional<FramePattern> const& pattern, Viewport viewport) {
    FrameSinks sinks;
    if (options.output == standard_output) {
        sinks.push_back(std::make_unique<VideoWriter>(STDOUT_FILENO, viewport, PictureRate::of(display_rate(options)),
                                                      is_told_to_end));
    } else if (is_film_name(options.output)) {
        sinks.push_back(std::make_unique<FilmSink>(options.output, viewport));
    } else if (pattern) {
        sinks.push_back(std::make_unique<FrameWriter>(
            *pattern, options.output_times.empty() ? WhenWritten::at_once : WhenWritten::at_the_end));
    }
    if (!options.tev.empty()) {
        // tev keeps images of runs before: each has a name of its own.
        std::string const name = "framelet " + options.connection.server + " (" + std::to_string(::getpid()) + ")";
        sinks.push_back(std::make_unique<TevSender>(parse_address(options.tev, default_tev_port), name, viewport));
    }
    return sinks;
}

double cpu_seconds_of_sinks(FrameSinks const& sinks) {
    double sum = 0;
    for (std::unique_ptr<FrameSink> const& sink : sinks) {
        sum += sink->cpu_seconds();
    }
    return sum;
}

/// Says on stderr why somebody who was shown the frames has gone; false where nobody has.
bool tell_end_of_sinks(FrameSinks const& sinks) {
    for (std::unique_ptr<FrameSink> const& sink : sinks) {
        if (std::string const reason = sink->end_reason(); !reason.empty()) {
            print_line("framelet-client", reason);
            return true;
        }
    }
    return false;
}

/// Shows frames until the time is over, the session has ended, somebody whom they are for has gone or, if wanted, all
/// is there. Returns what it counted.
RunFigures show(ClientCore& core, WindowlessOptions const& options, std::optional<CameraPath> const& path,
                Viewport viewport, FrameSinks const& sinks, FrameLog* log, SheetMoments* sheet) {
    double const rate = display_rate(options);
    double const duration = run_seconds(options);
    double const path_duration = path ? path->duration() : 0;
    RunFigures run;
    Welcome welcome;
    std::uint64_t scene_number = 0;
    bool interrupted = false;
    run.viewport = viewport;
    Picture picture = bare_picture(viewport);
    Picture overlaid; ///< the picture and what is drawn over it
    bool faded = false; ///< what is drawn over it was fading in the last frame
    std::vector<PixelRect> changed;
    std::vector<double> photon_seconds;
    FrameChoice choice(options.output_times);
    Clock::time_point const start = Clock::now();
    Clock::time_point const end = start + DisplayTiming::duration(duration);
    DisplayTiming timing(start, rate);
    while (true) {
        wait_until(core, std::min(timing.begin(core.making_seconds()), end));
        if (core.scene_number() != scene_number) {
            scene_number = core.scene_number();
            welcome = core.welcome();
            run.scene = welcome.scene_name;
        }
        interrupted = tell_interruption(core, interrupted);
        double const now = seconds_since(start);
        bool const done = options.until_converged && now >= path_duration && core.is_complete();
        int const scene_camera = path ? path->scene_camera : start_scene_camera(welcome);
        Camera const camera = path && scene_camera < 0 ? path->at(now, welcome.scene_origin) : welcome.start_camera;
        if (!done) {
            core.set_view(camera, viewport, scene_camera);
        }
        Clock::time_point const shown_at = timing.show(Clock::now(), core.making_seconds());
        bool const news = core.update_picture(picture, changed, shown_at);
        wait_until(core, shown_at);
        ClientStatistics const statistics = core.statistics();
        if (news && statistics.photon_seconds >= 0) {
            photon_seconds.push_back(statistics.photon_seconds);
        }
        run.scene_seconds = core.clock().time;
        if (log != nullptr) {
            log->add({run.frames, unix_seconds(), run.scene_seconds, news, core.is_complete(), statistics.bytes,
                      cpu_seconds_of(CLOCK_PROCESS_CPUTIME_ID) - cpu_seconds_of_sinks(sinks), statistics.samples,
                      statistics.photon_seconds, scene_camera, camera, welcome.scene_origin});
        }
        if (sheet != nullptr) {
            sheet->note(seconds_since(start), picture,
                        {camera, scene_camera, std::max(run.scene_seconds - statistics.lag_seconds, 0.0)});
        }
        ++run.frames;
        if (!sinks.empty()) {
            bool const draws = options.display.drawn_over != DrawnOver::nothing;
            if (draws) {
                overlaid = picture;
                core.draw_overlay(overlaid);
            }
            bool const fades = draws && core.overlay_fades();
            bool const differs = news || fades || faded;
            faded = fades;
            ShownFrame const frame{draws ? overlaid : picture, differs, choice.takes(run.scene_seconds),
                                   seconds_since(start)};
            for (std::unique_ptr<FrameSink> const& sink : sinks) {
                sink->show(frame);
            }
        }
        if (run.converged_seconds < 0 && (done || core.is_complete())) {
            run.converged_seconds = now;
        }
        if (done || Clock::now() >= end || core.end_reason() || is_told_to_end() || tell_end_of_sinks(sinks)) {
            run.photon_seconds = median_seconds(std::move(photon_seconds));
            return run;
        }
        run.late_frames += timing.note_shown(Clock::now()) ? 1 : 0;
    }
}

/// Writes the contact sheet once its stills have come. Throws as `SheetMoments::take_stills`, and InputError where it
/// cannot be written.
void write_sheet(SheetMoments& sheet, ClientCore& core, std::string const& file) {
    print_line("framelet-client", "waiting for the stills of the contact sheet");
    sheet.take_stills(core);
    if (sheet.pairs().empty()) {
        print_line("framelet-client", "there is no contact sheet: the run ended before a quarter of --duration");
        return;
    }
    if (sheet.unfinished() > 0) {
        print_line("framelet-client", std::to_string(sheet.unfinished()) + " of the stills were not complete after " +
                                          std::to_string(sheet.patience().count()) +
                                          " s: they are as good as they were by then");
    }
    write_png(file, contact_sheet(sheet.pairs()));
}

/// True where somebody at the terminal says that a certificate is to be trusted; false where nobody can be asked.
bool asks_whether_to_trust(UnknownCertificate const& unknown) {
    if (::isatty(STDIN_FILENO) != 1 || ::isatty(STDERR_FILENO) != 1) {
        return false;
    }
    std::cerr << "No authority vouches for the certificate of " << unknown.server << ", which is new here.\n"
              << "Its SHA-256 fingerprint is " << unknown.fingerprint << "\n"
              << "Is that what the server printed, and is it to be trusted from now on (yes/no)? " << std::flush;
    std::string answer;
    return std::getline(std::cin, answer) && answer == "yes";
}

/// Opens the session. Throws as ClientCore does.
std::unique_ptr<ClientCore> connect(ConnectionOptions const& connection) {
    try {
        return std::make_unique<ClientCore>(connection);
    } catch (UnknownCertificate const& unknown) {
        if (!asks_whether_to_trust(unknown)) {
            throw;
        }
        unknown.trust();
    }
    return std::make_unique<ClientCore>(connection);
}

struct Session {
    ClientStatistics statistics;
    RunFigures figures;
    std::optional<std::string> end_reason; ///< where the server ended it, or was gone at the end
};

/// Runs the whole session: its figures are of what was shown, whatever is still to be written then. Throws InputError
/// and ConnectionError.
Session look(WindowlessOptions const& options, ConnectionOptions const& connection,
             std::optional<CameraPath> const& path, Viewport viewport, FrameSinks const& sinks) {
    std::optional<SheetMoments> sheet;
    if (!options.sheet.empty()) {
        make_folder_of(options.sheet);
        sheet.emplace(run_seconds(options));
    }
    std::optional<FrameLog> log;
    if (!options.frames_file.empty()) {
        log.emplace(options.frames_file);
    }
    std::unique_ptr<ClientCore> const connected = connect(connection);
    ClientCore& core = *connected;
    std::size_t const cameras = core.welcome().cameras.size();
    if (path && path->scene_camera >= static_cast<int>(cameras)) {
        throw InputError("the camera file asks for camera " + std::to_string(path->scene_camera) +
                         " of the scene, which has " + std::to_string(cameras) + " (numbered from 0)");
    }
    ViewerSettings settings = options.display.settings();
    if (path && !options.display.exposure_ev) {
        settings.exposure_ev = path->moment.exposure_ev.value_or(settings.exposure_ev);
    }
    core.set_settings(settings);
    core.set_smoothing(options.display.lag_seconds.value_or(0));
    core.set_drawn_over(options.display.drawn_over);
    ask_clock(core, options, path);
    Session session;
    session.figures = show(core, options, path, viewport, sinks, log ? &*log : nullptr, sheet ? &*sheet : nullptr);
    session.statistics = core.statistics();
    session.end_reason = core.end_reason() ? core.end_reason() : core.interruption();
    if (sheet && !session.end_reason) {
        write_sheet(*sheet, core, options.sheet);
        session.figures.still_difference = sheet->difference();
    }
    return session;
}

} // namespace

void run_windowless(WindowlessOptions const& options, ConnectionOptions const& connection, Viewport viewport,
                    std::optional<FramePattern> const& pattern) {
    std::optional<CameraPath> const path = read_camera(options);
    FrameSinks const sinks = make_sinks(options, pattern, viewport);
    note_end_signals();
    Session const session = look(options, connection, path, viewport, sinks);
    for (std::unique_ptr<FrameSink> const& sink : sinks) {
        sink->finish();
        if (std::string const result = sink->result(); !result.empty()) {
            print_line("framelet-client", result);
        }
    }
    std::string const told = options.json ? statistics_json(session.statistics, session.figures) + "\n"
                                          : statistics_summary(session.statistics, session.figures);
    if (options.output == standard_output) {
        std::cerr << told << std::flush;
    } else {
        print_output(told);
    }
    if (session.end_reason) {
        throw ConnectionError(*session.end_reason);
    }
    if (options.until_converged && session.figures.converged_seconds < 0) {
        throw ConnectionError("the picture was not complete when the time was over: give a longer --duration, or "
                              "--pause where the scene moves");
    }
}

} // namespace framelet
