#include "server/program/progress_bar.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include <unistd.h>

#include "common/one_line.h"
#include "server/program/progress_line.h"

namespace framelet {
namespace {

int percent_of(double fraction) {
    return static_cast<int>(100 * std::clamp(fraction, 0.0, 1.0));
}

/// The line, drawn anew with each report and, for the time in it, now and then between reports.
class Bar {
public:
    Bar() : ticker_([this](std::stop_token const& stop) { tick(stop); }) {}
    ~Bar() {
        ticker_.request_stop();
        ticker_.join();
        end_line();
    }
    Bar(Bar const&) = delete;
    Bar& operator=(Bar const&) = delete;

    void show(std::string_view what, double fraction) {
        std::scoped_lock const lock(mutex_);
        bool const is_new = stage_ != what;
        if (is_new) {
            end_line();
            stage_ = what;
            began_ = Clock::now();
            fraction_ = 0;
        } else if (percent_of(fraction) <= percent_of(fraction_)) {
            return; // of threads that report at once the later ones may be heard first
        }
        fraction_ = fraction;
        draw();
    }

private:
    using Clock = std::chrono::steady_clock;

    bool is_open() const { return !stage_.empty() && percent_of(fraction_) < 100; }

    void end_line() const {
        if (is_open()) {
            std::fputc('\n', stderr);
        }
    }

    void draw() const {
        constexpr char const* to_the_end = "\x1b[K"; // erases what is left of a longer line
        double const seconds = std::chrono::duration<double>(Clock::now() - began_).count();
        std::fprintf(stderr, "\r%s%s%s", progress_line(stage_, fraction_, seconds).c_str(), to_the_end,
                     is_open() ? "" : "\n");
        std::fflush(stderr);
    }

    void tick(std::stop_token const& stop) {
        constexpr std::chrono::milliseconds interval{500};
        std::unique_lock lock(mutex_);
        while (!stop.stop_requested()) {
            stopped_.wait_for(lock, stop, interval, [] { return false; });
            if (is_open() && !stop.stop_requested()) {
                draw();
            }
        }
    }

    std::mutex mutex_; // loading reports from several threads
    std::string stage_;
    double fraction_ = 0;
    Clock::time_point began_;
    std::condition_variable_any stopped_;
    std::jthread ticker_; ///< after what it uses
};

} // namespace

Progress make_progress_bar(bool quiet) {
    if (quiet || ::isatty(STDERR_FILENO) == 0) {
        return [](std::string_view, double) {};
    }
    return [bar = std::make_shared<Bar>()](std::string_view what, double fraction) { bar->show(what, fraction); };
}

Progress make_progress_lines(int descriptor) {
    struct Told {
        std::mutex mutex; // as above
        std::string stage;
        int percent = -1;
    };
    return [told = std::make_shared<Told>(), descriptor](std::string_view what, double fraction) {
        std::scoped_lock const lock(told->mutex);
        int const now = percent_of(fraction);
        if (what == told->stage && now <= told->percent) {
            return;
        }
        told->stage = what;
        told->percent = now;
        ::dprintf(descriptor, "loading %d%% %s\n", now, to_one_line(what).c_str());
    };
}

} // namespace framelet
