// Helpers that tests of the client core share: its options, waiting, batches of one colour.
#pragma once

#include <algorithm>
#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "client/core/client_core.h"
#include "common/error.h"
#include "tests/client/fake_server.h"
#include "tests/picture/synthetic_framelets.h"

namespace framelet::test {

inline constexpr std::chrono::seconds patience{60}; // nothing waits for it when all is well

inline ConnectionOptions options_for(FakeServer const& server) {
    ConnectionOptions out;
    out.server = server.address();
    return out;
}

/// Waits for what the core has to say until `wanted` holds.
inline bool wait_for(ClientCore& core, std::function<bool()> const& wanted) {
    auto const end = std::chrono::steady_clock::now() + patience;
    while (!wanted()) {
        if (std::chrono::steady_clock::now() > end) {
            return false;
        }
        core.wait_for_news(std::chrono::milliseconds(100));
    }
    return true;
}

/// The line that says why no session could be opened.
inline std::string why_not(ConnectionOptions const& options) {
    try {
        ClientCore const core(options);
    } catch (ConnectionError const& error) {
        return error.what();
    }
    return "it worked";
}

inline bool one_line_with(std::string const& text, std::vector<std::string> const& parts) {
    return text.find('\n') == std::string::npos && std::all_of(parts.begin(), parts.end(), [&](auto const& part) {
               return text.find(part) != std::string::npos;
           });
}

inline Batch constant_batch(ImagePlane const& plane, int depth, std::uint8_t value, std::uint64_t camera) {
    Batch batch = make_batch(plane, 0, {});
    batch.view.number = camera;
    for (Tile const tile : visible_tiles(plane, depth)) {
        batch.framelets.push_back(constant_framelet(plane, tile, value));
    }
    return batch;
}

} // namespace framelet::test
