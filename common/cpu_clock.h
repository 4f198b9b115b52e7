// CPU time, of this thread, this process or another one.
#pragma once

#include <ctime>

namespace framelet {

/// CPU seconds that `clock` has counted: CLOCK_THREAD_CPUTIME_ID, CLOCK_PROCESS_CPUTIME_ID, or what clock_getcpuclockid
/// gave. 0 where there is no such clock, or no longer.
inline double cpu_seconds_of(clockid_t clock) {
    timespec time{};
    clock_gettime(clock, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

} // namespace framelet
