// A picture on the graphics card and the triangle that shows it. Needs a current OpenGL 3.3 context, at destruction
// too.
#pragma once

#include <cstdint>
#include <span>

#include "common/framelet/tile.h"
#include "common/image.h"

namespace framelet {

class PictureTexture {
public:
    /// Throws InputError where the card's compiler refuses the shaders.
    PictureTexture();
    ~PictureTexture();
    PictureTexture(PictureTexture const&) = delete;
    PictureTexture& operator=(PictureTexture const&) = delete;

    /// Copies the changed rectangles; everything where the size is another than before. Rectangles that begin at the
    /// same row go as one.
    void upload(Picture const& picture, std::span<PixelRect const> changed);
    /// Draws another texture of this size instead, rows from the top, until something is uploaded; it has to stay as
    /// long.
    void show(std::uint32_t texture, int width, int height);
    /// Fills a framebuffer of this size, stretching the picture; black before the first upload.
    void draw(int width, int height);

private:
    std::uint32_t texture_ = 0;
    std::uint32_t program_ = 0;
    std::uint32_t vertices_ = 0; ///< an empty array: the corners come from their number
    int width_ = 0; ///< of the texture
    int height_ = 0;
    std::uint32_t shown_ = 0; ///< texture that is drawn; 0: none
    int shown_width_ = 0;
    int shown_height_ = 0;
};

} // namespace framelet
