#include "server/program/progress_bar.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <mutex>
#include <string>

#include <unistd.h>

namespace framelet {
namespace {

int percent_of(double fraction) {
    return static_cast<int>(100 * std::clamp(fraction, 0.0, 1.0));
}

struct Bar {
    std::mutex mutex; // loading reports from several threads
    std::string stage;
    int percent = -1;

    void show(std::string_view what, double fraction) {
        std::scoped_lock const lock(mutex);
        bool const new_stage = stage != what;
        int const now = percent_of(fraction);
        if (!new_stage && now <= percent) {
            return;
        }
        if (new_stage && !stage.empty() && percent < 100) {
            std::fputc('\n', stderr);
        }
        stage = what;
        percent = now;
        constexpr int width = 40;
        std::string const done(static_cast<std::size_t>(width * now / 100), '#');
        std::fprintf(stderr, "\r%-24s [%-*s] %3d%%%s", stage.c_str(), width, done.c_str(), now, now == 100 ? "\n" : "");
        std::fflush(stderr);
    }
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
