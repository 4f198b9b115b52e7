#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "server/sampling/mirror/mirror.h"
#include "tests/sampling/rendered_planes.h"

namespace framelet {
namespace {

std::size_t bytes_in_use() {
#ifdef __GLIBC__
    struct mallinfo2 const info = ::mallinfo2();
    return info.uordblks + info.hblkhd;
#else
    return 0;
#endif
}

TEST(Mirror, MomentsThatAreGoneLeaveNoRoomForWholePictures) {
#if !defined(__GLIBC__) || defined(FRAMELET_SANITIZE)
    GTEST_SKIP() << "memory is another library's here";
#endif
    Viewport const size{640, 480};
    ImagePlane const plane{size};
    std::vector<Piece> pieces = render_pieces(plane, plane.pixel_depth(), [](float, float) { return Seen{}; });
    BodyMotions const no_motions;
    Mirror mirror(size);
    Camera camera;
    mirror.look({make_view_rays(camera, size), 0}, no_motions);
    std::size_t const before = bytes_in_use();
    std::vector<SentTile> sent;
    for (std::uint64_t i = 1; i <= 2 * FrameletPool::most_moments; ++i) { // as many as it has slots
        for (Piece& piece : pieces) {
            piece.of.batch = i;
            sent.push_back(piece.of);
        }
        camera.position.x += 0.01f;
        mirror.add(make_view_rays(camera, size), no_motions, pieces);
    }
    std::size_t const full = bytes_in_use();
    mirror.forget(sent);
    mirror.look({make_view_rays(camera, size), 0}, no_motions);
    EXPECT_LT(bytes_in_use() - before, (full - before) / 4);
}

} // namespace
} // namespace framelet
