// A value of its own for every thread that asks for one.
#pragma once

#include <memory>

#include <tbb/enumerable_thread_specific.h>

namespace framelet {

/// In memory of the common heap: TBB's own is not searched by leak checkers, which then take what a value holds for
/// lost.
template <typename Value>
using PerThread = tbb::enumerable_thread_specific<Value, std::allocator<Value>>;

} // namespace framelet
