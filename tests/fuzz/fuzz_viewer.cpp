// Does what a viewer does with the messages of a server, one after the other: batches into the memory that later ones
// are decoded with, into the cache, and into what pictures are made of. From the first one on a picture is shown, so
// that batches may wait. Input: bodies of messages, each with its length, two bytes, in front.
#include <algorithm>
#include <set>

#include <sanitizer/allocator_interface.h>

#include "client/core/picture/picture_maker.h"
#include "common/error.h"
#include "common/framelet/body_motion.h"
#include "common/held/framelet_cache.h"
#include "protocol/codec/batch_codec.h"
#include "protocol/messages/message_codec.h"

namespace {

/// What a viewer with so small a picture may take, bytes, besides what it has for all its life, what shows in pictures,
/// and the tracks that it keeps.
constexpr std::size_t most_held = 64 << 20;

/// What the tracks of so many bodies may take, bytes: of the things that move, and of cameras.
std::size_t most_track_bytes(std::size_t bodies) {
    return 2 * std::min(bodies * framelet::kept_track_keys, 2 * framelet::most_kept_keys) * sizeof(framelet::BodyPose);
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
    using namespace framelet;
    static BatchCodec codec;
    Viewport const viewport{256, 256};
    FrameletCache cache{ImagePlane(viewport)};
    PictureMaker maker(viewport, {});
    Picture picture;
    std::vector<PixelRect> changed;
    BatchMemory memory;
    std::set<BodyNumber> bodies;
    std::size_t const at_first = __sanitizer_get_current_allocated_bytes();
    try {
        while (size >= 2) {
            std::size_t const length = std::min(data[0] | std::size_t{data[1]} << 8, size - 2);
            Message const message = decode_message({reinterpret_cast<std::byte const*>(data + 2), length});
            data += 2 + length;
            size -= 2 + length;
            auto const* const encoded = std::get_if<EncodedBatch>(&message);
            // Another viewport is decoded all the same; the seeds' own is enough here, and small.
            if (encoded == nullptr || (encoded->moment && encoded->moment->view.viewport != viewport)) {
                continue;
            }
            Batch const batch = codec.decode(*encoded, &memory);
            FRAMELET_CHECK(cache.insert(batch) <= batch.framelets.size());
            maker.insert(batch);
            for (BodyTrack const& track : batch.tracks) {
                bodies.insert(track.body);
            }
            if (batch.camera_track) {
                bodies.insert(batch.camera_track->body);
            }
            if (picture.rgba.empty()) {
                maker.show({batch.view.camera, 1, -1, batch.scene_time, 1, 0, false}, picture, changed);
            }
        }
    } catch (ProtocolError const&) {
    }
    std::size_t const most = at_first + most_held + maker.pool().memory_bytes() + most_track_bytes(bodies.size());
    FRAMELET_CHECK(__sanitizer_get_current_allocated_bytes() < most);
    return 0;
}
