#include "tests/evaluation/live/serve.h"

#include <chrono>
#include <cmath>
#include <iostream>
#include <mutex>

#include <tbb/global_control.h>

#include "client/core/picture/display_timing.h"
#include "client/core/picture/making_time.h"
#include "client/frames/frame_choice.h"
#include "client/frames/frame_log.h"
#include "client/frames/frame_writer.h"
#include "common/cpu_clock.h"
#include "common/error.h"
#include "protocol/connection/server_connection.h"
#include "server/session/loop/priority.h"
#include "server/session/server.h"
#include "tests/evaluation/live/method_stream.h"

namespace framelet::bench {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_between(Clock::time_point from, Clock::time_point to) {
    return std::chrono::duration<double>(to - from).count();
}

double unix_seconds() {
    return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

/// Messages that have come and were not looked at yet, and the scene's clock.
class Mailbox {
public:
    void add(Message message) {
        std::scoped_lock const lock(mutex_);
        if (auto const* const status = std::get_if<Status>(&message)) {
            set_clock(status->clock);
        } else if (auto* const batch = std::get_if<EncodedBatch>(&message)) {
            messages_.push_back(std::move(batch->payload));
        }
    }
    void set_clock(ClockState const& clock) {
        clock_ = clock;
        clock_read_ = Clock::now();
    }
    std::vector<Bytes> take() {
        std::scoped_lock const lock(mutex_);
        return std::exchange(messages_, {});
    }
    SceneTime scene_time(Clock::time_point then) const {
        std::scoped_lock const lock(mutex_);
        double const elapsed = clock_.playing ? seconds_between(clock_read_, then) : 0;
        return clock_.time + elapsed * static_cast<double>(clock_.speed);
    }

private:
    mutable std::mutex mutex_;
    std::vector<Bytes> messages_;
    ClockState clock_;
    Clock::time_point clock_read_ = Clock::now();
};

} // namespace

void serve_method(ServeOptions const& options) {
    give_way(default_nice); // as framelet-server does, so that no method gets more of the processors
    std::size_t const threads = options.threads > 0
                                    ? static_cast<std::size_t>(options.threads)
                                    : tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    tbb::global_control const limit(tbb::global_control::max_allowed_parallelism, threads);
    auto const scene = load_bench_scene(options.scene, Clips::usual, {}, parse_light_method(options.light));
    scene->exposure = std::exp2(options.exposure_ev);
    ServerOptions server_options;
    server_options.port = 0;
    server_options.paused = true; // until the viewer lets it run
    server_options.loop.make_stream = [&](StreamOptions const&, std::uint32_t) {
        MethodSetup setup;
        setup.costs = options.costs;
        setup.rivals = options.rivals;
        return std::make_unique<MethodStream>(options.method, *scene, setup);
    };
    PosedScene posed(scene->scene, scene->clips, *scene->render_scene);
    Server server(posed, server_options);
    server.take_signals();
    std::cout << "listening on " << server.addresses().front() << std::endl;
    server.run();
}

void look_at_method(LookOptions const& options) {
    auto const scene = load_bench_scene(options.scene);
    std::optional<CameraPath> const path =
        options.camera_file.empty() ? std::nullopt : std::optional(read_camera_path(options.camera_file));
    int const scene_camera = path ? path->scene_camera : static_cast<int>(scene->scene_camera);
    MethodSetup setup;
    setup.viewport = options.viewport;
    setup.costs = options.costs;
    setup.rivals = options.rivals;
    auto const method = make_method(options.method, setup);
    FrameWriter writer{FramePattern(options.output), WhenWritten::at_the_end};
    FrameLog log(options.frames_file);
    Mailbox mailbox;
    std::uint64_t batches = 0, bytes = 0;
    std::mutex mutex; // guards `batches`, `bytes`, `lost` and `connected`
    ServerConnection* connected = nullptr;
    ServerConnection::Handlers handlers;
    handlers.on_message = [&](Message message) {
        if (auto const* const batch = std::get_if<EncodedBatch>(&message)) {
            auto const received =
                std::chrono::duration_cast<std::chrono::microseconds>(Clock::now().time_since_epoch());
            std::scoped_lock const lock(mutex);
            batches = batch->number;
            bytes += batch->payload.size();
            if (connected != nullptr) {
                connected->send(Ack{batch->number, static_cast<std::uint64_t>(received.count()), 0});
            }
        }
        mailbox.add(std::move(message));
    };
    std::string lost;
    handlers.on_lost = [&](std::string const& reason) {
        std::scoped_lock const lock(mutex);
        lost = reason;
    };
    handlers.on_sent = [] {};
    ServerConnection connection(options.connection, handlers);
    {
        std::scoped_lock const lock(mutex);
        connected = &connection;
        mailbox.set_clock(connection.welcome().clock);
    }
    connection.send(ClockRequest{ClockRequest::playing, {0, true, 1}});
    FrameChoice choice(options.output_times);
    Clock::time_point const start = Clock::now();
    NumberedView view{0, {}, options.viewport};
    Picture const* shown = &method->picture();
    DisplayTiming timing(start, options.rate);
    MakingTime making;
    for (std::uint64_t frame = 0; seconds_between(start, Clock::now()) < options.duration; ++frame) {
        std::this_thread::sleep_until(timing.begin(making.expected()));
        Clock::time_point const begun = Clock::now();
        Clock::time_point const shown_at = timing.show(begun, making.expected());
        SceneTime const time = mailbox.scene_time(shown_at);
        Camera const camera = scene_camera >= 0 ? camera_at(*scene, time)
                              : path            ? path->at(seconds_between(start, begun))
                                                : scene->camera;
        if (view.number == 0 || !(view.camera == camera)) {
            bool const tells = view.number == 0 || scene_camera < 0;
            view = {view.number + 1, camera, options.viewport};
            if (tells) {
                connection.send(CameraUpdate{view, scene_camera});
            }
        }
        bool changed = false;
        for (Bytes const& message : mailbox.take()) {
            method->consume(message);
            changed = true;
        }
        ViewerStep const presented = method->present(view, time);
        making.note(seconds_between(begun, Clock::now()));
        changed = changed || presented.seconds.reconstruct > 0;
        shown = &method->picture();
        std::this_thread::sleep_until(shown_at);
        double const photon = changed ? seconds_between(begun, Clock::now()) : -1;
        std::uint64_t received = 0;
        {
            std::scoped_lock const lock(mutex);
            received = bytes;
        }
        log.add({frame, unix_seconds(), mailbox.scene_time(Clock::now()), changed, false, received,
                 cpu_seconds_of(CLOCK_PROCESS_CPUTIME_ID) - writer.cpu_seconds(), 0, photon, scene_camera, camera});
        writer.add(*shown, true, choice.takes(mailbox.scene_time(Clock::now())));
        timing.note_shown(Clock::now());
    }
    writer.finish();
    std::scoped_lock const lock(mutex);
    if (!lost.empty()) {
        throw ConnectionError(lost);
    }
}

} // namespace framelet::bench
