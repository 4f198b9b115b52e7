// Pointers to what FFmpeg's libraries allocate, freed by themselves.
#pragma once

#include <memory>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libswscale/swscale.h>
}

namespace framelet {

template <auto Free>
struct AvFree {
    template <class T>
    void operator()(T* pointer) const {
        Free(&pointer);
    }
};
struct AvFreeScaler {
    void operator()(SwsContext* scaler) const { sws_freeContext(scaler); }
};

using AvCoder = std::unique_ptr<AVCodecContext, AvFree<avcodec_free_context>>;
using AvPicture = std::unique_ptr<AVFrame, AvFree<av_frame_free>>;
using AvData = std::unique_ptr<AVPacket, AvFree<av_packet_free>>;
using AvScaler = std::unique_ptr<SwsContext, AvFreeScaler>;

} // namespace framelet
