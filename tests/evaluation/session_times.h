// Times that the stages of sessions take on this machine, beside what the table of costs charges for them: the table is
// calibrated by sessions as they run, whose viewer holds several moments and whose caches are full of other things.
#pragma once

#include <cstdint>

#include "tests/evaluation/cost_table.h"
#include "tests/evaluation/stopwatch.h"

namespace framelet::bench {

struct SessionTimes {
    /// Seconds of one thread that a stage took, and that the table charges for the same work.
    struct Stage {
        double measured = 0, charged = 0;

        /// Factor by which the table's entries of this stage are to be multiplied.
        double factor() const { return measured > 0 && charged > 0 ? measured / charged : 1; }
    };
    Stage plan, render, learn, encode, decode, insert, paint;
    /// Seconds for finding something to do where there was nothing, or nothing new to plan: the table has no entry.
    double looking = 0;
    std::uint64_t samples = 0; ///< samples sent
};

/// Does the work and, unless `times` is null, adds the time that it took to the stage's measured seconds.
template <class Work>
void clocked(SessionTimes* times, SessionTimes::Stage SessionTimes::*stage, Work&& work) {
    if (times == nullptr) {
        work();
    } else {
        (times->*stage).measured += processor_seconds_of(work);
    }
}

/// Adds what the table charges for work that `clocked` saw to the stage, unless `times` is null. Returns the seconds.
inline double charged(SessionTimes* times, SessionTimes::Stage SessionTimes::*stage, double seconds) {
    if (times != nullptr) {
        (times->*stage).charged += seconds;
    }
    return seconds;
}

/// The table scaled so that it charges these sessions what they took.
CostTable calibrated(CostTable costs, SessionTimes const& times);

} // namespace framelet::bench
