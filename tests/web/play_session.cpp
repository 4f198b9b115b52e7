// Makes the pictures of a session, by the same code as compiled for this machine or for browsers:
// web_pictures SESSION write FILE, or SESSION compare FILE, which fails where they are not the file's.
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <fstream>
#include <iostream>
#include <iterator>
#include <optional>
#include <string_view>

#include "client/core/picture/picture_maker.h"
#include "common/error.h"
#include "protocol/codec/batch_codec.h"
#include "protocol/messages/message_codec.h"
#include "protocol/stream/message_frame.h"

namespace framelet {
namespace {

constexpr double least_decibels = 60;
constexpr double most_share_off = 1e-4; // of pixels, by more than
constexpr int most_off = 2; // of 255

Bytes read(char const* file) {
    std::ifstream in(file, std::ios::binary);
    std::string const text{std::istreambuf_iterator<char>(in), {}};
    Bytes out(text.size());
    std::memcpy(out.data(), text.data(), text.size());
    return out;
}

/// Compares pictures with those of a file, one after the other.
class Comparison {
public:
    explicit Comparison(char const* file) : wanted_(read(file)) {}

    void add(Picture const& picture, bool is_still) {
        FRAMELET_CHECK(at_ + picture.rgba.size() <= wanted_.size());
        double squares = 0;
        std::size_t off = 0;
        for (std::size_t i = 0; i < picture.rgba.size(); i += 4) {
            int worst = 0;
            for (std::size_t channel = 0; channel < 3; ++channel) {
                int const error =
                    std::abs(picture.rgba[i + channel] - std::to_integer<int>(wanted_[at_ + i + channel]));
                squares += error * error;
                worst = std::max(worst, error);
            }
            off += worst > most_off ? 1 : 0;
        }
        at_ += picture.rgba.size();
        double const pixels = static_cast<double>(picture.rgba.size()) / 4;
        double const decibels = squares == 0 ? 99 : 10 * std::log10(255.0 * 255 * 3 * pixels / squares);
        double const share_off = static_cast<double>(off) / pixels;
        ++pictures_;
        equal_ += squares == 0 ? 1 : 0;
        least_ = std::min(least_, decibels);
        if (decibels < least_decibels || share_off > most_share_off || (is_still && squares > 0)) {
            std::cout << "picture " << pictures_ << ": " << decibels << " dB, share off " << share_off << "\n";
            fails_ = true;
        }
    }
    bool passes() const {
        std::cout << equal_ << " of " << pictures_ << " pictures are equal, the worst has " << least_ << " dB\n";
        return !fails_ && equal_ > 0 && at_ == wanted_.size();
    }

private:
    Bytes const wanted_;
    std::size_t at_ = 0;
    int pictures_ = 0, equal_ = 0;
    double least_ = 99;
    bool fails_ = false;
};

/// Calls `see(picture, is_still)` for each picture of the session.
template <class See>
void play(ByteView session, See const& see) {
    BatchCodec codec;
    BatchMemory memory;
    std::optional<PictureMaker> maker;
    NumberedView view;
    Picture picture;
    std::vector<PixelRect> changed;
    for (double now = 0; !session.empty();) {
        FramePrefix prefix;
        std::memcpy(prefix.data(), session.data(), prefix.size());
        std::size_t const end = prefix.size() + body_size(prefix);
        Message const message = decode_message(session.subspan(prefix.size(), body_size(prefix)));
        session = session.subspan(end);
        if (auto const* update = std::get_if<CameraUpdate>(&message)) {
            view = update->view;
            if (!maker) {
                maker.emplace(view.viewport, PictureSettings{});
            }
        } else if (auto const* encoded = std::get_if<EncodedBatch>(&message)) {
            maker->insert(codec.decode(*encoded, &memory));
        } else {
            auto const& status = std::get<Status>(message);
            double const speed = status.clock.playing ? static_cast<double>(status.clock.speed) : 0;
            maker->show({view.camera, view.number, -1, status.clock.time, speed, now, status.converged}, picture,
                        changed);
            now += 1.0 / 30;
            if (picture.width > 0) {
                see(picture, status.converged);
            }
        }
    }
}

bool run(char const* session, std::string_view verb, char const* file) {
    if (verb == "write") {
        std::ofstream out(file, std::ios::binary);
        play(read(session), [&](Picture const& picture, bool) {
            out.write(reinterpret_cast<char const*>(picture.rgba.data()),
                      static_cast<std::streamsize>(picture.rgba.size()));
        });
        return static_cast<bool>(out.flush());
    }
    Comparison comparison(file);
    play(read(session), [&](Picture const& picture, bool is_still) { comparison.add(picture, is_still); });
    return comparison.passes();
}

} // namespace
} // namespace framelet

int main(int count, char** arguments) {
    if (count != 4) {
        return 2;
    }
    try {
        return framelet::run(arguments[1], arguments[2], arguments[3]) ? 0 : 1;
    } catch (std::exception const& error) {
        std::cerr << error.what() << "\n";
        return 1;
    }
}
