// The films of the recorder: MP4 through FFmpeg's libraries, or numbered PNG files.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <utility>

#include "client/window/kept/recorder.h"
#include "client/window/kept/user_files.h"
#include "common/error.h"
#include "common/files/picture_writer.h"

#ifdef FRAMELET_LIBAV
extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
#include <libswscale/swscale.h>
}
#endif

namespace framelet {

namespace fs = std::filesystem;

namespace {

/// A folder of 00000.png and so on, 30 a second: a picture is written for each thirtieth that has begun since the last.
class PictureSeries final : public FilmWriter {
public:
    explicit PictureSeries(fs::path folder) : folder_(std::move(folder)) {}

    void add(Picture const& picture, double seconds) override {
        constexpr double rate = 30;
        auto const until = static_cast<std::uint64_t>(std::ceil(seconds * rate));
        fs::path first;
        for (; next_ < until && !last_.rgba.empty(); ++next_) {
            write(first, last_);
        }
        last_ = picture;
    }
    void finish() override {
        fs::path first;
        if (!last_.rgba.empty()) {
            write(first, last_);
        }
    }
    fs::path path() const override { return folder_; }

private:
    /// Compressed once, `first`, however often it is shown.
    void write(fs::path& first, Picture const& picture) {
        char name[32];
        std::snprintf(name, sizeof name, "%05llu.png", static_cast<unsigned long long>(next_));
        std::error_code error;
        fs::create_directories(folder_, error);
        if (!first.empty()) {
            fs::copy_file(first, folder_ / name, fs::copy_options::overwrite_existing, error);
            if (error) {
                throw InputError("cannot write " + (folder_ / name).string() + ": " + error.message());
            }
            return;
        }
        first = folder_ / name;
        write_png(first, picture);
    }

    fs::path const folder_;
    Picture last_; ///< not written yet: how long it is shown is not known
    std::uint64_t next_ = 0;
};

#ifdef FRAMELET_LIBAV

template <auto Free>
struct Freed {
    template <class T>
    void operator()(T* pointer) const {
        Free(&pointer);
    }
};
struct FreedScaler {
    void operator()(SwsContext* scaler) const { sws_freeContext(scaler); }
};
struct ClosedFile {
    void operator()(AVFormatContext* file) const {
        if (file->pb != nullptr) {
            avio_closep(&file->pb);
        }
        avformat_free_context(file);
    }
};

/// Each picture with its own time, so that the film runs as the window did.
class Film final : public FilmWriter {
public:
    static bool is_possible() { return encoder() != nullptr; }

    explicit Film(fs::path file) : path_(std::move(file)) { av_log_set_level(AV_LOG_QUIET); }

    void add(Picture const& picture, double seconds) override {
        if (!context_) {
            open(picture.width, picture.height);
        }
        scale(picture);
        std::int64_t const time = std::llround(seconds * ticks);
        frame_->pts = std::max(time, frame_->pts + 1);
        check(avcodec_send_frame(context_.get(), frame_.get()), "encode a picture");
        drain();
    }

    void finish() override {
        if (!context_) {
            throw InputError("there was no picture");
        }
        check(avcodec_send_frame(context_.get(), nullptr), "encode the last picture");
        drain();
        check(av_write_trailer(file_.get()), "write");
    }

    fs::path path() const override { return path_; }

private:
    static constexpr int ticks = 90000; ///< a second, as films count

    static AVCodec const* encoder() { return avcodec_find_encoder_by_name("libx264"); }

    void check(int result, char const* what) const {
        if (result < 0) {
            char reason[AV_ERROR_MAX_STRING_SIZE] = "";
            av_strerror(result, reason, sizeof reason);
            throw InputError(std::string("cannot ") + what + " to " + path_.string() + ": " + reason);
        }
    }

    void open(int width, int height) {
        AVFormatContext* file = nullptr;
        check(avformat_alloc_output_context2(&file, nullptr, "mp4", path_.c_str()), "write");
        file_.reset(file);
        context_.reset(avcodec_alloc_context3(encoder()));
        FRAMELET_CHECK(context_);
        AVCodecContext& c = *context_;
        c.width = std::max(width & ~1, 2); // colour is at half the resolution, as all players want it
        c.height = std::max(height & ~1, 2);
        c.pix_fmt = AV_PIX_FMT_YUV420P;
        c.color_range = AVCOL_RANGE_MPEG;
        c.colorspace = AVCOL_SPC_BT709;
        c.color_primaries = AVCOL_PRI_BT709;
        c.color_trc = AVCOL_TRC_IEC61966_2_1;
        c.time_base = {1, ticks};
        c.framerate = {60, 1}; // a hint: times count
        c.gop_size = 120;
        c.thread_count = 1; // the other processors are for the picture
        c.flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
        av_opt_set(c.priv_data, "preset", "superfast", 0);
        av_opt_set(c.priv_data, "crf", "18", 0);
        check(avcodec_open2(&c, c.codec, nullptr), "encode");
        stream_ = avformat_new_stream(file, nullptr);
        FRAMELET_CHECK(stream_ != nullptr);
        stream_->time_base = c.time_base;
        check(avcodec_parameters_from_context(stream_->codecpar, &c), "encode");
        check(avio_open(&file->pb, path_.c_str(), AVIO_FLAG_WRITE), "write");
        check(avformat_write_header(file, nullptr), "write");
        frame_->format = c.pix_fmt;
        frame_->width = c.width;
        frame_->height = c.height;
        frame_->pts = -1;
        check(av_frame_get_buffer(frame_.get(), 0), "encode");
    }

    void scale(Picture const& picture) {
        // Of a side that is odd the last line is left out, not squeezed in.
        bool const is_cropped = (picture.width & ~1) == frame_->width && (picture.height & ~1) == frame_->height;
        int const width = is_cropped ? frame_->width : picture.width;
        int const height = is_cropped ? frame_->height : picture.height;
        // The one of before where it is for these sizes.
        scaler_.reset(sws_getCachedContext(scaler_.release(), width, height, AV_PIX_FMT_RGBA, frame_->width,
                                           frame_->height, AV_PIX_FMT_YUV420P, SWS_BILINEAR, nullptr, nullptr,
                                           nullptr));
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
    std::unique_ptr<AVFormatContext, ClosedFile> file_;
    std::unique_ptr<AVCodecContext, Freed<avcodec_free_context>> context_;
    std::unique_ptr<AVFrame, Freed<av_frame_free>> frame_{av_frame_alloc()};
    std::unique_ptr<AVPacket, Freed<av_packet_free>> packet_{av_packet_alloc()};
    std::unique_ptr<SwsContext, FreedScaler> scaler_;
    AVStream* stream_ = nullptr; ///< the file's
};

#endif

} // namespace

std::unique_ptr<FilmWriter> make_film_writer(fs::path const& folder) {
#ifdef FRAMELET_LIBAV
    if (Film::is_possible()) {
        return std::make_unique<Film>(new_file_name(folder, ".mp4"));
    }
#endif
    return std::make_unique<PictureSeries>(new_file_name(folder, "-film"));
}

} // namespace framelet
