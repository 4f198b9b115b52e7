// YUV4MPEG2, the video format that says of itself how large its pictures are and how fast they follow each other. In:
// pictures. Out: bytes as mjpegtools' yuv4mpeg(5) has them. 8 bits, 4:4:4, limited range.
#pragma once

#include <cstdint>
#include <string>

#include "client/video/video_clock.h"
#include "common/camera.h"
#include "common/image.h"

namespace framelet {

/// The matrix by which luma is made of red, green and blue. The format has no field for it.
enum class YuvMatrix : std::uint8_t { bt601, bt709 };

/// The matrix that players take a video of this size to be in: BT.709 from 1280 pixels of width, or more than 576 of
/// height, on.
YuvMatrix yuv_matrix(Viewport size);

/// The line that the stream begins with.
std::string y4m_header(Viewport size, PictureRate rate);

/// Replaces `out` by one picture: the line before it, then all of Y, of Cb, of Cr.
void encode_y4m_picture(Picture const& picture, YuvMatrix matrix, std::string& out);

} // namespace framelet
