#include "server/program/progress_bar.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <mutex>
#include <string>

#include <unistd.h>

#include "server/program/progress_line.h"

namespace framelet {
namespace {

int percent_of(double fraction) {
    return static_cast<int>(100 * std::clamp(fraction, 0.0, 1.0));
}

class Bar {
public:
    void show(std::string_view what, double fraction) {
        std::scoped_lock const lock(mutex_);
        Clock::time_point const now = Clock::now();
        bool const is_new = stage_ != what;
        int const percent = percent_of(fraction);
        if (is_new) {
            if (!stage_.empty() && percent_ < 100) {
                std::fputc('\n', stderr);
            }
            stage_ = what;
            began_ = now;
            fraction_ = 0;
        } else if (percent_ == 100 || (percent <= percent_ && now - drawn_ < least_pause)) {
            return;
        }
        fraction_ = std::max(fraction_, fraction); // of threads that report at once the later ones may be heard first
        percent_ = percent_of(fraction_);
        drawn_ = now;
        constexpr char const* to_the_end = "\x1b[K"; // erases what is left of a longer line
        std::string const line = progress_line(stage_, fraction_, std::chrono::duration<double>(now - began_).count());
        std::fprintf(stderr, "\r%s%s%s", line.c_str(), to_the_end, percent_ == 100 ? "\n" : "");
        std::fflush(stderr);
    }

private:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::milliseconds least_pause{100}; ///< between lines that differ by their times alone

    std::mutex mutex_; // loading reports from several threads
    std::string stage_;
    double fraction_ = 0;
    int percent_ = 0;
    Clock::time_point began_, drawn_;
};

} // namespace

Progress make_progress_bar(bool quiet) {
    if (quiet || ::isatty(STDERR_FILENO) == 0) {
        return [](std::string_view, double) {};
    }
    return [bar = std::make_shared<Bar>()](std::string_view what, double fraction) { bar->show(what, fraction); };
}

Progress make_progress_lines() {
    struct Told {
        std::mutex mutex; // as above
        std::string stage;
        int percent = -1;
    };
    return [told = std::make_shared<Told>()](std::string_view what, double fraction) {
        std::scoped_lock const lock(told->mutex);
        int const now = percent_of(fraction);
        if (what == told->stage && now <= told->percent) {
            return;
        }
        told->stage = what;
        told->percent = now;
        std::printf("loading %d%% %s\n", now, told->stage.c_str());
        std::fflush(stdout);
    };
}

} // namespace framelet
