// framelet-server: loads a scene and serves it to viewers.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <iterator>
#include <memory>

#include <fcntl.h>
#include <poll.h>
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>
#include <sys/prctl.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include "common/command_line/program_failure.h"
#include "common/command_line/standard_files.h"
#include "common/command_line/standard_output.h"
#include "common/counted.h"
#include "common/error.h"
#include "common/large_blocks.h"
#include "common/one_line.h"
#include "protocol/stream/local_token.h"
#include "protocol/stream/tls.h"
#include "protocol/stream/token.h"
#include "protocol/stream/web_door.h"
#include "server/program/options.h"
#include "server/program/progress_bar.h"
#include "server/program/shell_word.h"
#include "server/program/web_address.h"
#include "server/scene/scene_list.h"
#include "server/scene/summary/scene_summary.h"
#include "server/scene/summary/visibility.h"
#include "server/session/figures/metrics_port.h"
#include "server/session/listener.h"
#include "server/session/loaded_scene.h"
#include "server/session/loop/priority.h"
#include "server/session/scene_reloader.h"
#include "server/session/workers/work_for.h"
#include "server/stream/event_log.h"

namespace framelet {
namespace {

/// The folder of the page: the one that is named, else the one that is installed with this program. Empty: there is
/// none, or nobody wants it, as whoever starts this program for a window.
std::filesystem::path page_folder(Options const& options) {
    if (options.no_web || (options.news && options.web_files.empty())) {
        return {};
    }
    if (!options.web_files.empty()) {
        return options.web_files;
    }
    std::error_code error;
    std::filesystem::path const program = std::filesystem::read_symlink("/proc/self/exe", error);
    std::filesystem::path const folder = program.parent_path().parent_path() / "share/framelet/web";
    return std::filesystem::exists(folder / "index.html", error) ? folder : std::filesystem::path();
}

/// Reads the tokens, and tries the certificate. Throws InputError where a file is of no use; to find
/// that out only when it is needed could take as long as the scene does.
void read_files(Options& options) {
    ServerOptions& server = options.server;
    if (!options.token_file.empty()) {
        server.token = read_token_file(options.token_file);
    }
    if (!options.control_token_file.empty()) {
        server.control_token = read_token_file(options.control_token_file);
    }
    for (auto* const other : {&server.clock_from, &options.work_for}) {
        if (*other) {
            (*other)->token = server.control_token.empty() ? server.token : server.control_token;
            (*other)->tls = (*other)->tls || !server.tls_certificate.empty();
            (*other)->authority_file = server.tls_certificate;
        }
    }
    if (!server.tls_certificate.empty()) {
        make_tls_server_context(server.tls_certificate, server.tls_key);
        if (is_readable_by_all(server.tls_key)) {
            spdlog::warn("every user of this machine can read --tls-key '{}': take that right from others (chmod o=)",
                         server.tls_key);
        }
    }
    if (std::filesystem::path const folder = page_folder(options); !folder.empty()) {
        WebPage page = read_web_page(folder);
        page.origin = options.web_origin;
        server.web = std::make_shared<WebPage>(std::move(page));
    } else if (options.browser || !options.web_origin.empty()) {
        throw InputError("there is no page for browsers beside this program: say where it is with --web-files");
    }
}

/// Says where the page is: with the token where a person reads it, since others keep what they read. Returns what a
/// browser was opened with, if one was wanted.
std::unique_ptr<WebAddressFile> tell_page(Options const& options, std::string const& endpoint) {
    ServerOptions const& server = options.server;
    bool const is_encrypted = !server.tls_certificate.empty();
    bool const is_read_by_person = ::isatty(STDOUT_FILENO) != 0;
    std::cout << "in a browser " << web_address(endpoint, is_encrypted, is_read_by_person ? server.token : "")
              << std::endl;
    if (!options.browser) {
        return nullptr;
    }
    auto file = std::make_unique<WebAddressFile>(web_address(endpoint, is_encrypted, server.token));
    if (!open_in_browser(file->path())) {
        spdlog::warn("--browser: there is no desktop here whose browser could be opened");
    }
    return file;
}

std::vector<Index> chosen_clips(Scene const& scene, ImportOptions const& import) {
    return import.clips.empty() ? default_clips(scene) : clips_named(scene, import.clips);
}

/// Progress for people, or for the program that has started this one.
Progress report(Options const& options) {
    bool const is_unwanted = options.quiet || options.log == LogFormat::json; // whose lines it would stand among
    return options.news ? make_progress_lines(*options.news) : make_progress_bar(is_unwanted);
}

/// From now on this process ends with the one that has started it and waits for what it says.
void end_with_who_asked(int news) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    pollfd told{news, 0, 0};
    if (::poll(&told, 1, 0) > 0 && (told.revents & POLLERR) != 0) { // it has ended before that
        std::_Exit(1);
    }
}

/// Prints what is in the scene, also where a server would refuse it because there is nothing to see: that is what one
/// asks about.
void print_info(Options& options) {
    if (options.news) {
        end_with_who_asked(*options.news);
        options.import.checker.clear(); // this is it
    }
    Scene const scene = import_scenes(options.scenes, report(options), options.import);
    std::vector<Index> const clips = chosen_clips(scene, options.import);
    print_output(options.json ? scene_summary_json(scene, clips) : scene_summary_text(scene, clips));
}

/// Prints how to serve each scene below the folder, a line each. Throws InputError where there is none.
void list_scenes(std::filesystem::path const& folder, std::string const& command) {
    std::vector<std::filesystem::path> const files = scene_files_in(folder);
    if (files.empty()) {
        throw InputError("there is no scene file below folder '" + folder.string() +
                         "': name a scene file, or a folder that has some");
    }
    for (std::filesystem::path const& file : files) {
        print_output(command + " " + shell_word(file.string()) + "\n");
    }
}

/// True where scenes are asked for that a folder has, by a person: whoever else starts this program wants a scene.
bool asks_for_list(Options const& options) {
    std::error_code code;
    return options.scenes.size() == 1 && !options.info && !options.news &&
           std::filesystem::is_directory(options.scenes.front(), code);
}

/// Light as the scene's files want it, where they do and it is not told otherwise.
std::optional<LightMethod> light_of_files(Options const& options, Scene const& scene) {
    if (options.look.light_choice == LightChoice::by_view && !scene.light.empty()) {
        try {
            return parse_light_method(scene.light);
        } catch (InputError const& error) {
            spdlog::warn("asset.extras.framelet_light: {}", to_one_line(error.what(), 80)); // the file's words
        }
    }
    return std::nullopt;
}

/// Which light a scene has, and why, for the log.
std::string light_text(LoadedScene const& loaded) {
    std::string const word = std::string(name_of(loaded.light.method)) + " light";
    return loaded.light_difference
               ? fmt::format("{} ({:.1f} steps of 255 from direct to full)", word, *loaded.light_difference)
               : word;
}

/// Loads scenes and environment. Throws InputError where the files are of no use.
std::unique_ptr<LoadedScene> load_scene(Options const& options, Progress const& progress) {
    auto const began = std::chrono::steady_clock::now();
    std::optional<Environment> environment; // first: it takes less time to find out what is wrong with it
    if (options.environment) {
        environment = Environment::load(*options.environment);
    }
    Scene scene = import_scenes(options.scenes, progress, options.import);
    for (std::string const& warning : scene.warnings) {
        spdlog::warn("{}", warning);
    }
    if (!has_anything_to_see(scene)) {
        std::string const one = "scene '" + options.scenes.front().string() + "': it has";
        throw InputError("there is nothing to see in " +
                         (options.scenes.size() == 1 ? one : "these scenes: they have") +
                         " no triangles, or none with an area");
    }
    std::vector<Index> clips = chosen_clips(scene, options.import);
    LookOptions look = options.look;
    if (std::optional<LightMethod> const wanted = light_of_files(options, scene)) {
        look.light.method = *wanted;
        look.light_choice = LightChoice::told;
    }
    auto loaded =
        std::make_unique<LoadedScene>(std::move(scene), std::move(clips), std::move(environment), look, progress);
    Scene const& s = loaded->scene;
    double const seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    spdlog::info("{}: {}, {}, {}, {}, {}; {}, exposure {:+.1f} stops; loaded in {:.1f} s", s.name,
                 counted(s.nodes.size(), "node"), counted(count_triangles(s), "triangle"),
                 counted(s.clips.size(), "clip"), counted(s.lights.size(), "light"),
                 counted(s.cameras.size(), "camera"), light_text(*loaded), std::log2(loaded->exposure), seconds);
    return loaded;
}

/// True where the terminal that the program was started in is still there.
bool has_terminal() {
    int const terminal = ::open("/dev/tty", O_RDWR | O_CLOEXEC | O_NOCTTY);
    if (terminal >= 0) {
        ::close(terminal);
    }
    return terminal >= 0;
}

/// Holds back SIGHUP until the end of the scope, on this thread and those that begin meanwhile.
class HangUpsWait {
public:
    HangUpsWait() {
        sigset_t hang_up;
        ::sigemptyset(&hang_up);
        ::sigaddset(&hang_up, SIGHUP);
        ::pthread_sigmask(SIG_BLOCK, &hang_up, &before_);
    }
    ~HangUpsWait() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
    HangUpsWait(HangUpsWait const&) = delete;
    HangUpsWait& operator=(HangUpsWait const&) = delete;

private:
    sigset_t before_{};
};

/// How many threads render.
std::size_t thread_count(Options const& options) {
    return options.threads > 0 ? static_cast<std::size_t>(options.threads)
                               : tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
}

/// Traces paths for another server, until a signal ends it.
void work(Options& options) {
    read_files(options);
    std::size_t const threads = thread_count(options);
    tbb::global_control const limit(tbb::global_control::max_allowed_parallelism, threads);
    options.look.exposure_ev = 0; // it is the server's that counts
    options.look.light.method = LightMethod::reference;
    options.look.light_choice = LightChoice::told;
    std::unique_ptr<LoadedScene> const loaded = load_scene(options, report(options));
    work_for(*options.work_for, *loaded, threads);
}

void serve(Options& options) {
    std::optional<HangUpsWait> until_ready(std::in_place); // it is for a scene that is served
    auto listener = std::make_unique<Listener>(options.server.bind, options.server.port);
    std::unique_ptr<MetricsPort> metrics =
        options.metrics_port ? std::make_unique<MetricsPort>(options.metrics_bind, *options.metrics_port) : nullptr;
    read_files(options);
    std::optional<EventLog> event_log;
    if (!options.record_events.empty()) {
        event_log.emplace(options.record_events, [](std::string const& problem) { spdlog::warn("{}", problem); });
        options.server.loop.event_log = &*event_log;
    }
    std::optional<LocalToken> local_token;
    if (options.local_token) {
        std::vector<std::string> addresses;
        std::ranges::transform(listener->endpoints(), std::back_inserter(addresses), text_of);
        options.server.token = local_token.emplace(addresses).token();
    }
    tbb::global_control const threads(tbb::global_control::max_allowed_parallelism, thread_count(options));
    bool const had_terminal = has_terminal();
    std::vector<std::filesystem::path> scene_files;
    for (std::filesystem::path const& file : options.scenes) {
        scene_files.push_back(std::filesystem::absolute(file));
    }
    std::filesystem::path const environment_file = options.environment.value_or("");
    std::optional<FileWatch> watch;
    if (options.watch) { // from before the scene is loaded: what changes meanwhile counts
        std::vector<std::filesystem::path> named = scene_files;
        named.push_back(environment_file);
        watch.emplace().watch(named);
    }
    std::unique_ptr<LoadedScene> loaded = load_scene(options, report(options));
    std::vector<std::filesystem::path> const files = loaded->scene.files;

    if (event_log) {
        StreamOptions const& stream = options.server.loop.stream;
        event_log->begin({{scene_files.begin(), scene_files.end()},
                          options.environment ? std::filesystem::absolute(*options.environment).string() : "",
                          loaded->clips,
                          loaded->light,
                          loaded->exposure,
                          stream.tone_curve,
                          stream.bias,
                          stream.batch_framelets});
    }
    Server server(std::move(loaded), options.server, std::move(listener));
    // What asks the server, or tells it something, ends before it.
    std::unique_ptr<MetricsPort> const answering = std::move(metrics);
    options.import.is_serving = true;
    SceneReloader reloader(
        std::move(watch), scene_files, environment_file, files,
        [&options](Progress const& progress) { return load_scene(options, progress); },
        [&server](std::shared_ptr<LoadedScene> scene) { server.replace_scene(std::move(scene)); });
    server.take_signals([&] { // before anybody is told that there is a server to signal to
        if (had_terminal && !has_terminal()) { // that is why the signal came: nobody is there to end the server later
            return false;
        }
        if (event_log) {
            spdlog::warn("the scene is not loaded again: a recording of --record-events is of one scene");
        } else {
            reloader.ask();
        }
        return true;
    });
    until_ready.reset();
    for (std::string const& address : server.addresses()) {
        std::cout << "listening on " << address << std::endl;
        if (options.news) {
            ::dprintf(*options.news, "listening on %s\n", address.c_str());
        }
    }
    if (!options.server.tls_certificate.empty()) {
        std::cout << "certificate SHA-256 " << certificate_fingerprint(options.server.tls_certificate) << std::endl;
    }
    std::unique_ptr<WebAddressFile> const page_file =
        options.server.web ? tell_page(options, server.addresses().front()) : nullptr;
    if (answering) {
        answering->start([&server] { return server.figures(); });
        std::cout << "metrics at http://" << answering->address() << "/metrics" << std::endl;
    }
    server.run();
}

} // namespace
} // namespace framelet

// NOLINTNEXTLINE(bugprone-exception-escape): what nobody expects may end the program.
int main(int argc, char** argv) {
    framelet::open_standard_files();
    framelet::give_back_large_blocks();
    std::signal(SIGPIPE, SIG_IGN); // whoever reads the log may go away; viewers stay
    std::signal(SIGCHLD, SIG_DFL); // where it is ignored, perhaps since before this was started, no child is heard of
    auto parsed = framelet::parse_options(argc, argv);
    if (int const* const exit_code = std::get_if<int>(&parsed)) {
        return *exit_code;
    }
    auto& options = std::get<framelet::Options>(parsed);
    options.import.checker = "/proc/self/exe";
    framelet::open_log(options.log, options.quiet);
    framelet::give_way(options.nice); // before there are threads
    try {
        if (framelet::asks_for_list(options)) {
            framelet::list_scenes(options.scenes.front(), options.list_as);
        } else {
            auto* const does = options.info       ? &framelet::print_info
                               : options.work_for ? &framelet::work
                                                  : &framelet::serve;
            does(options);
        }
        return 0;
    } catch (std::exception const& error) {
        framelet::log_end(options.log, framelet::failure_text(error));
        return 1;
    }
}
