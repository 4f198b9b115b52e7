#include "client/processes/end_signals.h"

#include <atomic>
#include <csignal>

namespace framelet {
namespace {

std::atomic<bool> told_to_end = false;
static_assert(std::atomic<bool>::is_always_lock_free); // so a signal's handler may set it

void note(int number) {
    told_to_end = true;
    if (number != SIGHUP) {
        std::signal(number, SIG_DFL);
    }
}

} // namespace

void note_end_signals() {
    std::signal(SIGINT, note);
    std::signal(SIGTERM, note);
    if (std::signal(SIGHUP, note) == SIG_IGN) {
        std::signal(SIGHUP, SIG_IGN);
    }
}

bool is_told_to_end() {
    return told_to_end;
}

} // namespace framelet
