// What the project uses of TBB's arenas, with one thread.
#pragma once

namespace tbb::this_task_arena {

inline int max_concurrency() {
    return 1;
}
inline int current_thread_index() {
    return 0;
}

} // namespace tbb::this_task_arena
