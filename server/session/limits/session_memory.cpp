#include "server/session/limits/session_memory.h"

#include "protocol/codec/color/reference_picture.h"
#include "server/sampling/plan/adaptive_refresh.h"
#include "server/stream/flow/lossy_tiles.h"

namespace framelet {
namespace {

constexpr std::size_t megabyte = 1'000'000;

std::string text_of(std::size_t bytes) {
    return std::to_string((bytes + megabyte - 1) / megabyte);
}

} // namespace

std::size_t session_bytes(Viewport viewport, bool predicts) {
    ImagePlane const plane(viewport);
    std::size_t bytes = most_kept_bytes;
    bytes += LumaHistory::default_entries * sizeof(LumaHistory::Entry);
    // What is known of each region, and as much again for what is worked out from it in every cycle.
    bytes += (std::size_t{2} << (2 * field_depth(plane))) * sizeof(Region);
    bytes += LossyTiles::bytes(plane);
    if (predicts && ReferencePicture::holds(viewport)) {
        bytes += ReferencePicture::bytes(viewport);
    }
    return bytes;
}

std::optional<std::string> SessionMemory::reserve(std::uint64_t session, Viewport viewport, bool predicts) {
    std::size_t const wanted = session_bytes(viewport, predicts);
    std::size_t& own = sessions_[session];
    if (wanted <= own) {
        return std::nullopt;
    }
    std::size_t const left = budget_ - (reserved_ - own);
    if (wanted > left) {
        return "a picture of " + std::to_string(viewport.width) + "x" + std::to_string(viewport.height) + " takes " +
               text_of(wanted) + " MB of the server's memory for viewers, of which " + text_of(left) + " of " +
               text_of(budget_) + " MB are left: ask for a smaller one or raise --session-memory";
    }
    reserved_ += wanted - own;
    own = wanted;
    return std::nullopt;
}

void SessionMemory::release(std::uint64_t session) {
    auto const found = sessions_.find(session);
    if (found != sessions_.end()) {
        reserved_ -= found->second;
        sessions_.erase(found);
    }
}

void SessionMemory::pass(std::uint64_t from, std::uint64_t to) {
    auto node = sessions_.extract(from);
    if (!node.empty()) {
        node.key() = to;
        sessions_.insert(std::move(node));
    }
}

} // namespace framelet
