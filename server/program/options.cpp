#include "server/program/options.h"

#include <iostream>

#include "common/command_line/command_line.h"
#include "common/command_line/number_range.h"
#include "common/command_line/standard_output.h"
#include "common/error.h"
#include "protocol/stream/token.h"
#include "server/scene/scene_axes.h"

namespace framelet {
namespace {

ProgramNotes notes() {
    return {
        "Port, certificate and all other files are looked at before the scene is loaded. SIGINT (Ctrl-C) and SIGTERM "
        "end the server, and its viewers are told. SIGHUP loads the scene again; where its terminal is gone it ends "
        "the server too.",
        {{0, "fine"},
         {1, "a scene or another file cannot be used, or the address cannot be listened on"},
         {2, "bad usage"}},
        {"framelet", "framelet-viewer", "framelet-client"}};
}

void require_protection(Options const& options, bool insecure) {
    ServerOptions const& server = options.server;
    bool const protected_link = !options.token_file.empty() && !server.tls_certificate.empty();
    if (!is_loopback(server.bind) && !protected_link && !insecure) {
        throw InputError("--bind " + server.bind +
                         " can be reached from other machines: give --token-file, --tls-cert and --tls-key, or "
                         "--insecure if you know that nobody else can reach it");
    }
    if (server.tls_certificate.empty() != server.tls_key.empty()) {
        throw InputError("--tls-cert and --tls-key belong together: give both");
    }
}

} // namespace

std::variant<Options, int> parse_options(int argc, char const* const* argv) {
    Options options;
    bool insecure = false;
    std::string light;
    std::vector<std::string> proxied;
    std::optional<std::string> clock_from, work_for;
    std::string tone_curve = "neutral";
    std::uint64_t scene_megabytes = options.import.memory_bytes >> 20;

    CLI::App app("Renders a scene for remote viewers: every ray where their pictures gain most.", "framelet-server");
    prepare_command_line(app, notes());
    app.option_defaults()->group("Scene");
    app.add_option("SCENE", options.scenes,
                   "Scene file: .gltf, .glb, .obj and what else the import library reads. Several are shown together, "
                   "each where it has its things. Of a folder alone the scenes in it are listed")
        ->required();
    app.add_option("--scene", options.import.scene, "Scene of a glTF file to show, by name or number from 0")
        ->type_name("NAME|N")
        ->default_str("the one that the file says")
        ->configurable(false); // `scene` is the file there
    app.add_option("--up", options.import.up, "Axis that is up, of files that do not say so or say it wrongly")
        ->type_name("x|y|z")
        ->check(readable_by(parse_up_axis))
        ->capture_default_str();
    app.add_option("--unit", options.import.unit, "Unit of length, likewise: mm, cm, m, km, in or ft")
        ->type_name("UNIT")
        ->check(readable_by(parse_unit))
        ->capture_default_str();
    app.add_flag("--allow-outside", options.import.allow_outside,
                 "Read files that the scene names outside its own folder as well");
    app.add_option("--scene-memory", scene_megabytes, "Most memory for what is made of the scene files")
        ->type_name("MB")
        ->check(number_in(1, 1 << 20))
        ->capture_default_str();
    app.add_option("--environment", options.environment, "Environment map (.hdr, .exr) that lights the scene")
        ->type_name("FILE");
    app.add_option(
           "--light", light,
           "Light: that of lights and environment alone (direct); all of it, smooth in motion and exact in the end "
           "(full); or all of it by paths alone (reference): noisy while anything moves, and for a while after")
        ->type_name("direct|full|reference")
        ->check(readable_by(parse_light_method))
        ->default_str("what the scene file asks for; else full where the first view shows it, direct where not");
    app.add_option("--sun-size", options.look.light.sun_degrees,
                   "Diameter of suns, for soft shadows with --light full and reference; 0: hard")
        ->type_name("DEGREES")
        ->check(number_in(0.0, 90.0))
        ->capture_default_str();
    app.add_option("--lamp-size", options.look.light.lamp_metres, "Diameter of lamps, likewise")
        ->type_name("METRES")
        ->check(number_in(0.0, 1000.0))
        ->default_str("0.1, or a hundredth of the scene where that is less");
    app.add_option("--exposure", options.look.exposure_ev, "Exposure")
        ->type_name("STOPS")
        ->default_str("chosen for the scene")
        ->check(number_in(-32.0, 32.0));
    app.add_option(
           "--tone-map", tone_curve,
           "How light becomes colour: base colours as they are (neutral), as film shows them (aces, agx), or cut "
           "off where the display ends (linear)")
        ->type_name("neutral|aces|agx|linear")
        ->check(readable_by(parse_tone_curve))
        ->capture_default_str();
    app.add_option("--clip", options.import.clips, "Animation clip to play, by name; may be given several times")
        ->type_name("NAME")
        ->allow_extra_args(false) // what follows its name is a scene
        ->default_str("all that fit together");
    CLI::Option* const watch =
        app.add_flag("--watch", options.watch, "Load the scene again when its files have changed; viewers stay");
    CLI::Option* const info =
        app.add_flag("--info", options.info, "Print what is in the scene and what was passed over, and exit")
            ->configurable(false);
    app.add_flag("--json", options.json, "With --info: as JSON")->needs(info)->configurable(false);
    app.add_option(
           "--clock-from", clock_from,
           "Follow the clock of another server of this scene, as of several behind one proxy, which has the "
           "same token; encrypted and with the same certificate where this one has --tls-cert, or as tls://HOST")
        ->type_name("HOST");
    app.add_flag("--paused", options.server.paused, "Start with the scene clock standing");

    app.option_defaults()->group("Connections");
    app.add_option("--bind", options.server.bind, "Address to listen on, or a name: all addresses that it stands for")
        ->type_name("ADDRESS")
        ->capture_default_str();
    app.add_option("--port", options.server.port, "Port to listen on; 0 picks a free one")
        ->check(number_in(0, 65535))
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeLast) // the viewer's PrivateServer gives one first
        ->capture_default_str();
    app.add_option("--token-file", options.token_file,
                   "File whose first line a viewer has to know, at least 16 characters; without it viewers of the "
                   "same user on this machine are let in, and find a token by themselves")
        ->type_name("FILE");
    app.add_flag_callback(
           "--make-token",
           [] {
               print_output(make_token() + "\n");
               throw CLI::Success();
           },
           "Print a token that nobody can guess, and exit")
        ->configurable(false);
    app.add_option("--tls-cert", options.server.tls_certificate, "Certificate chain (PEM): encrypt connections")
        ->type_name("FILE");
    app.add_option("--tls-key", options.server.tls_key, "Private key (PEM) of the certificate")->type_name("FILE");
    app.add_option(
           "--proxied", proxied,
           "Proxy in front of the server, or the network of several: connections from there begin with a header "
           "of PROXY protocol (version 2) that says who connects; may be given several times")
        ->type_name("ADDRESS[/BITS]")
        ->allow_extra_args(false); // what follows it is a scene
    app.add_option_function<int>(
           "--drain", [&options](int seconds) { options.server.drain = std::chrono::seconds(seconds); },
           "On SIGTERM say at --metrics that no more viewers are welcome, and end when all have left, or after so long")
        ->type_name("SECONDS")
        ->check(number_in(0, 86400))
        ->default_str("0");
    app.add_flag("--insecure", insecure, "Let everybody in, and listen beyond this machine without token and TLS");

    app.option_defaults()->group("Browsers");
    app.add_option("--web-files", options.web_files,
                   "Folder of the page for browsers, which the same port answers, and WebSockets with it")
        ->type_name("FOLDER")
        ->default_str("the page that is installed with this program, if it is");
    CLI::Option* const no_web = app.add_flag("--no-web", options.no_web, "Answer no browsers");
    app.add_flag("--browser", options.browser, "Open the page with the browser of this desktop, once there is a scene")
        ->excludes(no_web);
    app.add_option("--web-origin", options.web_origin,
                   "Let pages of this origin connect too, as https://HOST[:PORT]: where a proxy in front of the server "
                   "has another name")
        ->type_name("URL")
        ->excludes(no_web);

    app.option_defaults()->group("Viewers");
    app.add_option("--max-sessions", options.server.max_sessions, "Most viewers at a time")
        ->check(number_in(1, 1024))
        ->capture_default_str();
    app.add_option(
           "--session-memory", options.server.session_megabytes,
           "Most memory for the pictures of all viewers together: about 210 bytes a pixel and 40 MB each; a viewer "
           "whose picture does not fit is refused")
        ->type_name("MB")
        ->check(number_in(1, 1 << 20))
        ->capture_default_str();
    CLI::Option* const control = app.add_option("--control-token-file", options.control_token_file,
                                                "File with another such token: who knows it may play, pause and seek, "
                                                "the others watch")
                                     ->type_name("FILE")
                                     ->default_str("the viewer that has been there longest may");
    app.add_flag("--shared-control", options.server.shared_control, "Every viewer may play, pause and seek, for all")
        ->excludes(control);

    app.option_defaults()->group("Rendering");
    app.add_option("--threads", options.threads, "Threads to render with; 0: one a core")
        ->check(number_in(0, 1024))
        ->capture_default_str();
    app.add_option(
           "--work-for", work_for,
           "Serve nobody, but trace paths of light for the server at this address, which has the same scene and "
           "options, the same tokens, and --light full or reference; encrypted where it is tls://HOST, or --tls-cert "
           "is given")
        ->type_name("HOST")
        ->excludes(watch)
        ->excludes(info);
    app.add_option(
           "--nice", options.nice,
           "Niceness: 0 is that of other programs; with more the server leaves the processors to them, a viewer on "
           "this machine among them, whenever they want them")
        ->check(number_in(0, 19))
        ->capture_default_str();
    app.add_option("--batch", options.server.loop.stream.batch_framelets,
                   "Most framelets a batch; 0: what half a cycle has time for. A place's 16 stay together")
        ->check(number_in(std::size_t(0), max_batch_framelets))
        ->capture_default_str();
    app.add_option("--bias", options.server.loop.stream.bias, "What to favour: -1 detail, 1 freshness")
        ->check(number_in(-1.0, 1.0))
        ->capture_default_str();

    app.option_defaults()->group("Log and recordings");
    CLI::Option* const metrics =
        app.add_option("--metrics", options.metrics_port,
                       "Answer HTTP at this port: /metrics for Prometheus, /health, /ready (another viewer is "
                       "welcome); 0 picks a free one")
            ->type_name("PORT")
            ->check(number_in(0, 65535));
    app.add_option("--metrics-bind", options.metrics_bind,
                   "Address of that port. Whoever reaches it may ask, without token or TLS")
        ->type_name("ADDRESS")
        ->needs(metrics)
        ->capture_default_str();
    app.add_flag("--quiet", options.quiet, "Print warnings and errors only");
    std::string log = "text";
    CLI::Option const* const log_option =
        app.add_option("--log", log, "Print the log as text, or each line as a JSON object: time, level, message")
            ->type_name("text|json")
            ->check(readable_by(parse_log_format))
            ->multi_option_policy(CLI::MultiOptionPolicy::TakeLast) // the viewer's PrivateServer has the last word
            ->capture_default_str();
    // framelet becomes the server with this for a folder: what a line of the list of its scenes begins with.
    app.add_option("--list-as", options.list_as)->group("")->configurable(false);
    // The viewer's PrivateServer and the check of imports start the server with this.
    app.add_option("--news", options.news)->check(number_in(1, 1023))->group("")->configurable(false);
    app.add_option("--record-events", options.record_events,
                   "Write to this file what comes from each viewer, and when, and what was answered: framelet-bench "
                   "replay makes the same of it")
        ->type_name("FILE")
        ->excludes(watch);
    add_config_option(app);
    auto const end = [log_option](UsageProblem const& problem) {
        // Of a line that is of no use this may be known all the same, and whoever collects the log wants to read why.
        bool const is_json = log_option->count() > 0 && log_option->results().back() == "json";
        log_end(is_json ? LogFormat::json : LogFormat::text, problem.text);
        return problem.exit_code;
    };
    try {
        parse_command_line(app, argc, argv);
        options.log = parse_log_format(log);
        if (!light.empty()) {
            options.look.light_choice = LightChoice::told;
            options.look.light.method = parse_light_method(light);
        }
        auto const other_server = [insecure](std::string const& text) {
            ConnectionOptions other;
            other.server = parse_server_address(text);
            other.tls = asks_for_tls(text);
            other.insecure = insecure;
            return other;
        };
        if (clock_from) {
            options.server.clock_from = other_server(*clock_from);
        }
        if (work_for) {
            options.work_for = other_server(*work_for);
        }
        for (std::string const& network : proxied) {
            options.server.proxies.add(network);
        }
        options.look.tone_curve = options.server.loop.stream.tone_curve = parse_tone_curve(tone_curve);
        if (!options.import.scene.empty() && options.scenes.size() > 1) {
            throw InputError("--scene chooses a scene of one file: give that file alone");
        }
        require_protection(options, insecure);
    } catch (CLI::ParseError const& error) {
        return error.get_exit_code() == 0 ? exit_usage(app, error) : end(usage_problem(app, error));
    } catch (InputError const& error) {
        return end(usage_problem(error.what()));
    } catch (OutputError const& error) {
        return end({error.what(), 1});
    }
    options.import.memory_bytes = scene_megabytes << 20;
    options.local_token = options.token_file.empty() && !insecure;
    return options;
}

} // namespace framelet
