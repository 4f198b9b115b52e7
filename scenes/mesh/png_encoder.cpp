#include "scenes/mesh/png_encoder.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "common/error.h"

namespace framelet {

std::string encode_png(TexturePixels const& pixels) {
    std::vector<unsigned char> file;
    OIIO::Filesystem::IOVecOutput memory(file);
    OIIO::Filesystem::IOProxy* const proxy = &memory;
    OIIO::ImageSpec spec(pixels.width, pixels.height, pixels.channels, OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    spec.attribute("oiio:UnassociatedAlpha", 1);
    spec.attribute("png:compressionLevel", 9);
    spec.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    auto const output = OIIO::ImageOutput::create("texture.png");
    FRAMELET_CHECK(output != nullptr);
    FRAMELET_CHECK(output->open("texture.png", spec));
    FRAMELET_CHECK(output->write_image(OIIO::TypeDesc::UINT8, pixels.bytes.data()));
    FRAMELET_CHECK(output->close());
    return {file.begin(), file.end()};
}

} // namespace framelet
