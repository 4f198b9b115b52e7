#include "server/options.h"

#include <iostream>

#include <CLI/CLI.hpp>

#include "common/error.h"
#include "common/number_range.h"
#include "protocol/token.h"

namespace framelet {
namespace {

void require_protection(ServerOptions const& server, bool insecure) {
    bool const protected_link = !server.token.empty() && !server.tls_certificate.empty();
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
    std::string token_file, control_token_file;
    bool insecure = false;
    std::uint64_t scene_megabytes = options.import.memory_bytes >> 20;

    CLI::App app("Renders a scene for remote viewers: every ray where their pictures gain most.", "framelet-server");
    app.set_version_flag("--version", "framelet-server " FRAMELET_VERSION);
    app.add_option("SCENE", options.scene, "Scene file: .gltf, .glb, .obj and what else the import library reads")
        ->required();
    app.add_flag("--allow-outside", options.import.allow_outside,
                 "Read files that the scene names outside its own folder as well");
    app.add_option("--scene-memory", scene_megabytes, "Most memory for what is made of the scene file, MB")
        ->check(CLI::Range(1, 1 << 20))
        ->capture_default_str();
    app.add_option("--bind", options.server.bind, "Address to listen on, or a name: all addresses that it stands for")
        ->capture_default_str();
    app.add_option("--port", options.server.port, "Port to listen on; 0 picks a free one")->capture_default_str();
    app.add_option("--threads", options.threads, "Threads to render with; 0: one a core")
        ->check(CLI::Range(0, 1024))
        ->capture_default_str();
    app.add_option("--environment", options.environment, "Environment map (.hdr, .exr) that lights the scene");
    app.add_option("--exposure", options.exposure_ev, "Exposure in stops; default: chosen for the scene")
        ->check(number_in(-32.0, 32.0));
    app.add_option("--clip", options.clips, "Animation clip to play, by name; may be given several times");
    app.add_flag("--paused", options.server.paused, "Start with the scene clock standing");
    app.add_option("--batch", options.server.loop.stream.batch_framelets,
                   "Most framelets a batch; 0: what half a cycle has time for. A place's 16 stay together")
        ->check(CLI::Range(std::size_t(0), max_batch_framelets))
        ->capture_default_str();
    app.add_option("--bias", options.server.loop.stream.bias, "What to favour: -1 detail .. 1 freshness")
        ->check(number_in(-1.0, 1.0))
        ->capture_default_str();
    app.add_option("--max-sessions", options.server.max_sessions, "Most viewers at a time")
        ->check(CLI::Range(1, 1024))
        ->capture_default_str();
    app.add_option("--session-memory", options.server.session_megabytes,
                   "Most memory for the pictures of all viewers together, MB: 20 bytes a pixel each; a viewer whose "
                   "picture does not fit is refused")
        ->check(CLI::Range(1, 1 << 20))
        ->capture_default_str();
    app.add_option("--token-file", token_file,
                   "File whose first line a viewer has to know, at least 16 characters; without it viewers of the "
                   "same user on this machine are let in, and find a token by themselves");
    CLI::Option* const control = app.add_option(
        "--control-token-file", control_token_file,
        "File with another such token: who knows it may play, pause and seek, the others watch (default: the viewer "
        "that has been there longest may)");
    app.add_flag("--shared-control", options.server.shared_control, "Every viewer may play, pause and seek, for all")
        ->excludes(control);
    app.add_flag_callback(
        "--make-token",
        [] {
            std::cout << make_token() << '\n';
            throw CLI::Success();
        },
        "Print a token that nobody can guess, and exit");
    app.add_option("--tls-cert", options.server.tls_certificate, "Certificate chain (PEM): encrypt connections");
    app.add_option("--tls-key", options.server.tls_key, "Private key (PEM) of the certificate");
    app.add_flag("--insecure", insecure, "Let everybody in, and listen beyond this machine without token and TLS");
    app.add_option(
        "--record", options.record,
        "Write what is planned for each viewer into this folder: a line of JSON for each batch, and for viewers "
        "that move nothing pictures of tiles, density, error and motion");
    app.add_option("--record-rate", options.record_rate, "Sets of such pictures a second, for each viewer")
        ->check(number_in(0.01, 1000.0))
        ->capture_default_str();
    app.add_option("--record-events", options.record_events,
                   "Write to this file what comes from each viewer, and when, and what was answered: framelet-bench "
                   "replay makes the same of it");
    app.add_flag("--quiet", options.quiet, "Print warnings and errors only");
    try {
        app.parse(argc, argv);
        options.import.memory_bytes = scene_megabytes << 20;
        if (!token_file.empty()) {
            options.server.token = read_token_file(token_file);
        }
        if (!control_token_file.empty()) {
            options.server.control_token = read_token_file(control_token_file);
        }
        require_protection(options.server, insecure);
        options.local_token = options.server.token.empty() && !insecure;
    } catch (CLI::CallForHelp const& help) {
        return app.exit(help);
    } catch (CLI::CallForVersion const& version) {
        return app.exit(version);
    } catch (CLI::Success const&) {
        return 0;
    } catch (std::exception const& error) {
        std::cerr << "framelet-server: " << error.what() << " (--help lists the options)\n";
        return 2;
    }
    return options;
}

} // namespace framelet
