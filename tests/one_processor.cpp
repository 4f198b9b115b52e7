// Linked into what runs under the thread sanitizer: the test and the programs that it starts stay on the processor on
// which the test begins, and TBB has one thread in each. The sanitizer does not see how the packaged TBB hands work
// over, and takes every hand-over for a race. All other threads are as many as ever.
#include <sched.h>

namespace {

bool const on_one_processor = [] {
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(static_cast<unsigned>(::sched_getcpu()), &one);
    return ::sched_setaffinity(0, sizeof one, &one) == 0;
}();

} // namespace
