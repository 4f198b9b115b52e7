#include "server/session/loop/priority.h"

#include <algorithm>

#include <sys/resource.h>

namespace framelet {

void give_way(int nice) {
    // On Linux the niceness is that of one thread, and inherited. Where it is refused the server runs as it was
    // started.
    ::setpriority(PRIO_PROCESS, 0, std::max(nice, ::getpriority(PRIO_PROCESS, 0)));
}

} // namespace framelet
