// What the project uses of TBB's loops, run one after the other: a page has one thread for its pictures.
#pragma once

#include <type_traits>

namespace tbb {

template <class Index, class Body>
void parallel_for(Index first, std::type_identity_t<Index> last, Body const& body) {
    for (; first < last; ++first) {
        body(first);
    }
}

} // namespace tbb
