#include "server/session/limits/session_memory.h"

#include "protocol/codec/color/reference_picture.h"
#include "server/sampling/held/held_tiles.h"
#include "server/sampling/held/region_grid.h"
#include "server/sampling/mirror/mirror.h"

namespace framelet {
namespace {

constexpr std::size_t megabyte = 1'000'000;

/// Bytes that any picture takes: batches that are being made, and what grows with the scene's bodies.
constexpr std::size_t least_bytes = 4 * megabyte;
/// Pieces for each cell of the picture, over all moments, and as many again for samples on their way to becoming some.
/// They are a measured bound of scenes with much detail: of a picture at rest, and of a flight that is rendered whole
/// ten times a second.
constexpr std::size_t pieces_per_cell = 17;

std::string text_of(std::size_t bytes) {
    return std::to_string((bytes + megabyte - 1) / megabyte);
}

} // namespace

std::size_t session_bytes(Viewport viewport, bool predicts) {
    ImagePlane const plane(viewport);
    // Batches without an answer are kept as they are, and those that the socket has not taken as they are sent.
    std::size_t bytes = 2 * most_kept_bytes + least_bytes;
    // What is known of each region, and as much again for what is worked out from it in every cycle.
    bytes += (std::size_t{2} << (2 * region_depth(plane))) * sizeof(Region);
    bytes += HeldTiles::bytes(viewport);
    auto const pixels = static_cast<std::size_t>(viewport.width) * static_cast<std::size_t>(viewport.height);
    constexpr std::size_t bytes_per_cell = sizeof(Cell) + sizeof(std::uint64_t); // and the newest batch of each
    constexpr std::size_t bytes_per_piece = sizeof(Piece) + sizeof(ReprojectedPiece);
    bytes += pixels / cell_pixels * (bytes_per_cell + pieces_per_cell * bytes_per_piece);
    if (predicts && ReferencePicture::holds(viewport)) {
        bytes += ReferencePicture::bytes(viewport);
    }
    return bytes;
}

std::optional<std::string> SessionMemory::reserve(std::uint64_t session, Viewport viewport, bool predicts) {
    auto const pixels = static_cast<std::size_t>(viewport.width) * static_cast<std::size_t>(viewport.height);
    std::size_t const wanted = session_bytes(viewport, predicts) + pixels * more_per_pixel_;
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
