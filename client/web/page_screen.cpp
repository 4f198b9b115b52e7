#include "client/web/page_screen.h"

#include <epoxy/gl.h>

namespace framelet {

void PageScreen::show(Picture const& picture) {
    if (picture.width != plane_.width() || picture.height != plane_.height()) {
        plane_ = GlPlane(TexelFormat::color, picture.width, picture.height, count_);
        target_ = GlTarget({&plane_}, count_);
    }
    glBindTexture(GL_TEXTURE_2D, plane_.texture());
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, picture.width, picture.height, GL_RGBA, GL_UNSIGNED_BYTE,
                    picture.rgba.data());
    show_on_screen(target_);
}

} // namespace framelet
