#include "tests/evaluation/codecs/h264_codec.h"

#include <algorithm>
#include <array>
#include <cmath>

extern "C" {
#include <libavutil/opt.h>
}

#include "client/video/av_pointers.h"
#include "common/error.h"

namespace framelet::bench {
namespace {

/// Pixel format with colour at full resolution: at half of it, RGB pictures cannot come nearer than some 37 dB at any
/// rate, and are worse at every rate tried.
constexpr AVPixelFormat coded_format = AV_PIX_FMT_YUV444P;

/// Makes a converter between full-range BT.709 YCbCr and the picture's RGB, as exact as the library allows.
AvScaler make_scaler(int width, int height, AVPixelFormat from, AVPixelFormat to) {
    AvScaler scaler(sws_getContext(width, height, from, width, height, to,
                                   SWS_BILINEAR | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INT | SWS_FULL_CHR_H_INP, nullptr,
                                   nullptr, nullptr));
    FRAMELET_CHECK(scaler);
    int const* const coefficients = sws_getCoefficients(SWS_CS_ITU709);
    sws_setColorspaceDetails(scaler.get(), coefficients, 1, coefficients, 1, 0, 1 << 16, 1 << 16);
    return scaler;
}

AvCoder make_context(AVCodec const* codec) {
    av_log_set_level(AV_LOG_QUIET);
    if (!codec) {
        throw InputError("libavcodec here has no H.264 with x264");
    }
    AvCoder context(avcodec_alloc_context3(codec));
    FRAMELET_CHECK(context);
    context->thread_count = 1;
    return context;
}

} // namespace

struct H264Encoder::State {
    AvCoder context;
    AvPicture frame{av_frame_alloc()};
    AvData packet{av_packet_alloc()};
    AvScaler scaler;
    double frames_per_second = 0;
    std::int64_t number = 0;

    /// Limits the next frame to so many bytes, or to the picture's own size if that is less. libavcodec's x264 looks at
    /// these fields before every frame and reconfigures the encoder where they have changed. The buffer is one frame:
    /// what is saved in one is not to be spent in a later one.
    void limit_frame(double bytes) {
        AVCodecContext& c = *context;
        double const bits = 8 * std::min(bytes, 3.0 * c.width * c.height);
        c.rc_buffer_size = static_cast<int>(std::max(bits, 1000.0)); // x264 counts in thousands
        c.rc_max_rate = std::llround(c.rc_buffer_size * frames_per_second);
    }
};

H264Encoder::H264Encoder(int width, int height, double frames_per_second) : state_(std::make_unique<State>()) {
    FRAMELET_CHECK(width > 0 && height > 0 && frames_per_second > 0);
    State& s = *state_;
    s.frames_per_second = frames_per_second;
    s.context = make_context(avcodec_find_encoder_by_name("libx264"));
    AVCodecContext& c = *s.context;
    c.width = width;
    c.height = height;
    c.pix_fmt = coded_format;
    c.color_range = AVCOL_RANGE_JPEG;
    c.colorspace = AVCOL_SPC_BT709;
    c.framerate = av_d2q(frames_per_second, 100000);
    c.time_base = av_inv_q(c.framerate);
    c.max_b_frames = 0;
    c.gop_size = 1 << 20;
    av_opt_set(c.priv_data, "preset", "veryfast", 0);
    // Tune psnr leaves out psychovisual choices, which look good and are further from the reference.
    av_opt_set(c.priv_data, "tune", "psnr,zerolatency", 0);
    av_opt_set(c.priv_data, "crf", "8", 0);
    s.limit_frame(INFINITY); // a limit cannot be set later unless there is one from the start
    if (avcodec_open2(&c, c.codec, nullptr) < 0) {
        throw InputError("x264 refuses pictures of " + std::to_string(width) + "x" + std::to_string(height));
    }
    s.frame->format = c.pix_fmt;
    s.frame->width = c.width;
    s.frame->height = c.height;
    FRAMELET_CHECK(av_frame_get_buffer(s.frame.get(), 0) == 0);
    s.scaler = make_scaler(c.width, c.height, AV_PIX_FMT_RGBA, coded_format);
}

H264Encoder::~H264Encoder() = default;

std::vector<std::byte> H264Encoder::encode(Picture const& picture, double most_bytes) {
    State& s = *state_;
    FRAMELET_CHECK(picture.width == s.context->width && picture.height == s.context->height && most_bytes > 0);
    s.limit_frame(most_bytes);
    FRAMELET_CHECK(av_frame_make_writable(s.frame.get()) == 0);
    std::array<std::uint8_t const*, 1> const planes{picture.rgba.data()};
    std::array<int, 1> const strides{picture.width * 4};
    sws_scale(s.scaler.get(), planes.data(), strides.data(), 0, picture.height, s.frame->data, s.frame->linesize);
    s.frame->pts = s.number++;
    FRAMELET_CHECK(avcodec_send_frame(s.context.get(), s.frame.get()) == 0);
    FRAMELET_CHECK(avcodec_receive_packet(s.context.get(), s.packet.get()) == 0); // zero latency: there is one at once
    auto const* const data = reinterpret_cast<std::byte const*>(s.packet->data);
    std::vector<std::byte> unit(data, data + s.packet->size);
    av_packet_unref(s.packet.get());
    return unit;
}

struct H264Decoder::State {
    AvCoder context;
    AvPicture frame{av_frame_alloc()};
    AvData packet{av_packet_alloc()};
    AvScaler scaler;
    int width = 0, height = 0;
    std::vector<std::uint8_t> input; ///< a unit and the padding that the decoder reads over
};

H264Decoder::H264Decoder() : state_(std::make_unique<State>()) {
    state_->context = make_context(avcodec_find_decoder(AV_CODEC_ID_H264));
    state_->context->flags |= AV_CODEC_FLAG_LOW_DELAY;
    FRAMELET_CHECK(avcodec_open2(state_->context.get(), state_->context->codec, nullptr) == 0);
}

H264Decoder::~H264Decoder() = default;

void H264Decoder::decode(std::span<std::byte const> unit, Picture& out) {
    State& s = *state_;
    s.input.assign(unit.size() + AV_INPUT_BUFFER_PADDING_SIZE, 0);
    std::ranges::transform(unit, s.input.begin(), [](std::byte b) { return std::to_integer<std::uint8_t>(b); });
    s.packet->data = s.input.data();
    s.packet->size = static_cast<int>(unit.size());
    if (unit.empty() || avcodec_send_packet(s.context.get(), s.packet.get()) != 0 ||
        avcodec_receive_frame(s.context.get(), s.frame.get()) != 0) {
        throw InputError("H.264: damaged access unit");
    }
    AVFrame const& frame = *s.frame;
    if (!s.scaler || s.width != frame.width || s.height != frame.height) {
        s.width = frame.width;
        s.height = frame.height;
        s.scaler = make_scaler(s.width, s.height, coded_format, AV_PIX_FMT_RGBA);
    }
    if (out.width != s.width || out.height != s.height) {
        out = Picture(s.width, s.height);
    }
    std::array<std::uint8_t*, 1> const planes{out.rgba.data()};
    std::array<int, 1> const strides{s.width * 4};
    sws_scale(s.scaler.get(), frame.data, frame.linesize, 0, s.height, planes.data(), strides.data());
}

} // namespace framelet::bench
