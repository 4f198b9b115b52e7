#include "client/video/film_writer.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include "common/error.h"

#ifdef FRAMELET_LIBAV
extern "C" {
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
}

#include "client/video/av_pointers.h"
#endif

namespace framelet {

namespace fs = std::filesystem;

bool is_film_name(fs::path const& file) {
    return file.extension() == ".mp4" || file.extension() == ".webp";
}

#ifdef FRAMELET_LIBAV

namespace {

struct ClosedFile {
    void operator()(AVFormatContext* file) const {
        if (file->pb != nullptr) {
            avio_closep(&file->pb);
        }
        avformat_free_context(file);
    }
};

struct Setting {
    char const* name;
    char const* value;
};

/// Settings of H.264. This preset takes half the processor time of "superfast", which is what the picture and its
/// server leave, for about as many bytes and a decibel less of some 50.
constexpr Setting mp4_settings[] = {{"preset", "ultrafast"}, {"crf", "18"}};
/// Settings of WebP. A picture of 1280x720 takes 50 ms of a core; compression level 4 takes twice as long for a
/// twentieth fewer bytes (cwebp -m, two scenes).
constexpr Setting webp_settings[] = {{"compression_level", "2"}, {"quality", "80"}};

struct FilmFormat {
    char const* extension;
    char const* encoder;
    AVPixelFormat pixels;
    int side; ///< width and height are a multiple of it
    int ticks; ///< units a second in which its times are counted
    std::span<Setting const> settings;
};

constexpr FilmFormat formats[] = {
    {".mp4", "libx264", AV_PIX_FMT_YUV420P, 2, 90000,
     mp4_settings}, // colour at half the resolution, as all players want it
    {".webp", "libwebp_anim", AV_PIX_FMT_RGB32, 1, 1000, webp_settings}, // its encoder converts the colours itself
};

FilmFormat const& format_of(fs::path const& file) {
    auto const found =
        std::ranges::find_if(formats, [&](FilmFormat const& f) { return file.extension() == f.extension; });
    FRAMELET_CHECK(found != std::end(formats));
    return *found;
}

/// A film in which each picture has its own time, so that it runs as what was shown did.
class Film final : public FilmWriter {
public:
    explicit Film(fs::path file) : path_(std::move(file)), format_(format_of(path_)) { av_log_set_level(AV_LOG_QUIET); }

    void add(Picture const& picture, double seconds) override {
        if (!context_) {
            open(picture.width, picture.height);
        }
        scale(picture);
        std::int64_t const time = std::llround(seconds * format_.ticks);
        frame_->pts = std::max(time, frame_->pts + 1);
        check(avcodec_send_frame(context_.get(), frame_.get()), "encode a picture");
        drain();
    }

    void finish() override {
        if (!context_) {
            throw InputError("cannot write " + path_.string() + ": no picture was shown while it was taken");
        }
        check(avcodec_send_frame(context_.get(), nullptr), "encode the last picture");
        drain();
        check(av_write_trailer(file_.get()), "write");
    }

    fs::path path() const override { return path_; }

private:
    void check(int result, char const* what) const {
        if (result < 0) {
            char reason[AV_ERROR_MAX_STRING_SIZE] = "";
            av_strerror(result, reason, sizeof reason);
            throw InputError(std::string("cannot ") + what + " to " + path_.string() + ": " + reason);
        }
    }

    void open(int width, int height) {
        AVFormatContext* file = nullptr;
        check(avformat_alloc_output_context2(&file, nullptr, nullptr, path_.c_str()), "write");
        file_.reset(file);
        context_.reset(avcodec_alloc_context3(avcodec_find_encoder_by_name(format_.encoder)));
        FRAMELET_CHECK(context_);
        AVCodecContext& c = *context_;
        c.width = whole_side(width);
        c.height = whole_side(height);
        c.pix_fmt = format_.pixels;
        if (c.pix_fmt == AV_PIX_FMT_YUV420P) {
            c.color_range = AVCOL_RANGE_MPEG;
            c.colorspace = AVCOL_SPC_BT709;
            c.color_primaries = AVCOL_PRI_BT709;
            c.color_trc = AVCOL_TRC_IEC61966_2_1;
        }
        c.time_base = {1, format_.ticks};
        c.framerate = {60, 1}; // a hint: times count
        c.gop_size = 120;
        c.thread_count = 1; // the other processors are for the picture
        c.flags |= (file->oformat->flags & AVFMT_GLOBALHEADER) != 0 ? AV_CODEC_FLAG_GLOBAL_HEADER : 0;
        for (Setting const& setting : format_.settings) {
            check(av_opt_set(&c, setting.name, setting.value, AV_OPT_SEARCH_CHILDREN), "encode");
        }
        check(avcodec_open2(&c, c.codec, nullptr), "encode");
        stream_ = avformat_new_stream(file, nullptr);
        FRAMELET_CHECK(stream_ != nullptr);
        stream_->time_base = c.time_base;
        check(avcodec_parameters_from_context(stream_->codecpar, &c), "encode");
        check(avio_open(&file->pb, path_.c_str(), AVIO_FLAG_WRITE), "write");
        AVDictionary* options = nullptr;
        av_dict_set(&options, "loop", "0", 0); // repeated for ever; formats without this option ignore it
        int const written = avformat_write_header(file, &options);
        av_dict_free(&options);
        check(written, "write");
        frame_->format = c.pix_fmt;
        frame_->width = c.width;
        frame_->height = c.height;
        frame_->pts = -1;
        check(av_frame_get_buffer(frame_.get(), 0), "encode");
    }

    int whole_side(int length) const { return std::max(length - length % format_.side, format_.side); }

    void scale(Picture const& picture) {
        // The last line of a side that is odd is left out, not squeezed in.
        bool const is_cropped =
            whole_side(picture.width) == frame_->width && whole_side(picture.height) == frame_->height;
        int const width = is_cropped ? frame_->width : picture.width;
        int const height = is_cropped ? frame_->height : picture.height;
        // The scaler of before is used again where it is for these sizes.
        scaler_.reset(sws_getCachedContext(scaler_.release(), width, height, AV_PIX_FMT_RGBA, frame_->width,
                                           frame_->height, format_.pixels, SWS_BILINEAR, nullptr, nullptr, nullptr));
        FRAMELET_CHECK(scaler_);
        int const* const coefficients = sws_getCoefficients(SWS_CS_ITU709);
        sws_setColorspaceDetails(scaler_.get(), coefficients, 1, coefficients, 0, 0, 1 << 16, 1 << 16);
        check(av_frame_make_writable(frame_.get()), "encode");
        std::uint8_t const* const planes[] = {picture.rgba.data()};
        int const strides[] = {picture.width * 4};
        sws_scale(scaler_.get(), planes, strides, 0, height, frame_->data, frame_->linesize);
    }

    void drain() {
        for (;;) {
            int const result = avcodec_receive_packet(context_.get(), packet_.get());
            if (result == AVERROR(EAGAIN) || result == AVERROR_EOF) {
                return;
            }
            check(result, "encode a picture");
            av_packet_rescale_ts(packet_.get(), context_->time_base, stream_->time_base);
            packet_->stream_index = stream_->index;
            check(av_interleaved_write_frame(file_.get(), packet_.get()), "write");
        }
    }

    fs::path const path_;
    FilmFormat const& format_;
    std::unique_ptr<AVFormatContext, ClosedFile> file_;
    AvCoder context_;
    AvPicture frame_{av_frame_alloc()};
    AvData packet_{av_packet_alloc()};
    AvScaler scaler_;
    AVStream* stream_ = nullptr; ///< owned by the file
};

} // namespace

bool can_write_film(fs::path const& file) {
    return is_film_name(file) && avcodec_find_encoder_by_name(format_of(file).encoder) != nullptr;
}

#else

bool can_write_film(fs::path const&) {
    return false;
}

#endif

std::unique_ptr<FilmWriter> make_film_writer(fs::path const& file) {
#ifdef FRAMELET_LIBAV
    if (can_write_film(file)) {
        return std::make_unique<Film>(file);
    }
#endif
    throw InputError("cannot write " + file.string() + ": " +
                     (is_film_name(file) ? "this program was built without FFmpeg's encoder for it"
                                         : "a film is called .mp4 or .webp"));
}

} // namespace framelet
