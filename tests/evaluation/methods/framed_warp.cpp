// The method `framed+warp`: whole frames in turn, colour through x264, with the shapes of each frame (where its samples
// lie and what carries them), by which the viewer moves the last frame to its own camera and scene time whenever it
// shows a picture. This is what remote hybrid rendering and the runtimes of headsets do with a frame's depth plane, by
// the project's own shapes. A margin around the viewport is rendered, sent and held besides, for what a turn brings
// into view.
#include <algorithm>
#include <map>

#include "protocol/codec/batch_codec.h"
#include "protocol/messages/message_codec.h"
#include "server/stream/layers/shape_feed.h"
#include "tests/evaluation/methods/h264_frames.h"
#include "tests/evaluation/methods/methods.h"
#include "tests/evaluation/methods/warp_viewer.h"
#include "tests/evaluation/methods/whole_frame.h"

namespace framelet::bench {
namespace {

/// Share of a frame's bytes that colour gets, however much its shapes take.
constexpr double least_colour_share = 0.1;

/// A viewer that holds more than it shows: a margin around the viewport, which a turn of the camera brings into view
/// before any message knows of it.
class MarginViewer {
public:
    /// The margin is that of `setup.rivals`.
    explicit MarginViewer(MethodSetup const& setup)
        : viewport_(setup.viewport), margin_x_(margin_pixels(setup.rivals.margin, viewport_.width)),
          margin_y_(margin_pixels(setup.rivals.margin, viewport_.height)),
          wide_(with_margin(viewport_, margin_x_, margin_y_), setup.costs),
          picture_(viewport_.width, viewport_.height) {}

    /// Takes a batch of the larger viewport.
    ViewerStep insert(Batch const& batch) { return wide_.insert(batch); }

    /// Draws the picture; charges only for what is shown, since a viewer need not paint the margin.
    ViewerStep present(Camera const& camera, SceneTime time) {
        ViewerStep step = wide_.present(with_margin(camera, viewport_, margin_y_), time);
        Picture const& wide = wide_.picture();
        for (int y = 0; y < picture_.height; ++y) {
            std::copy_n(wide.row(y + margin_y_) + 4 * static_cast<std::ptrdiff_t>(margin_x_),
                        4 * static_cast<std::ptrdiff_t>(picture_.width), picture_.row(y));
        }
        step.seconds.reconstruct *= pixel_count(picture_) / pixel_count(wide);
        return step;
    }

    Picture const& picture() const { return picture_; }

private:
    Viewport const viewport_;
    int const margin_x_, margin_y_;
    WarpViewer wide_;
    Picture picture_;
};

class FramedWarp final : public Method {
public:
    explicit FramedWarp(MethodSetup const& setup)
        : setup_(setup), frame_(setup, 1e-9 * pixel_count(setup.viewport) * setup.costs.h264_decode_pixel),
          encoder_(setup.frames_per_second), viewer_(setup) {
        for (int const spacing : frame_.spacings()) {
            Batch blank;
            blank.view.viewport = frame_.viewport();
            FrameGrid const grid(frame_.viewport(), spacing);
            for (DisplayFramelet const& framelet : grid.framelets()) {
                blank.framelets.push_back({framelet.tile, {}, {}, {}});
            }
            blanks_[grid.framelets().front().tile.depth()] = {spacing, codec_.encode(blank)};
        }
    }

    ServerStep produce(StepInput const& input) override {
        moves_ = input.scene.duration > 0;
        ServerStep step = frame_.render(input);
        if (!frame_.is_due() && !frame_.repeats(input, last_bytes_)) {
            return step;
        }
        FrameGrid& grid = frame_.grid();
        Batch batch;
        batch.number = ++number_;
        batch.view = frame_.view();
        batch.scene_time = moves_ ? frame_.time() : 0;
        batch.framelets = grid.framelets();
        std::vector<std::uint8_t> const all(batch.framelets.size(), 1);
        shapes_.fit(grid.rendered(), all, make_view_rays(batch.view.camera, batch.view.viewport), grid.plane(),
                    input.now, batch.shapes);
        shapes_.track(input.scene.posed->poses(), input.scene.render_scene->bodies(), -1, batch.scene_time,
                      batch.scene_time, batch.tracks, batch.camera_track);
        // The message is a batch whose payload is the access unit; of its tiles only the first is kept, which tells the
        // spacing.
        EncodedBatch message = codec_.encode(batch, &sent_, false);
        message.tiles.resize(1);
        message.payload.clear();
        Picture const& picture = grid.picture();
        double const encoding = 1e-9 * (pixel_count(picture) * setup_.costs.h264_encode_pixel +
                                        static_cast<double>(grid.samples()) * setup_.costs.shape_sample);
        double const budget = frame_.budget(input, step, encoding);
        double const beside = static_cast<double>(encode_message(message).size());
        message.payload =
            encoder_.encode(grid.spacing(), picture, std::max(budget - beside, least_colour_share * budget));
        last_bytes_ = message.payload.size();
        step.message = encode_message(message);
        step.seconds.encode += encoding;
        return step;
    }

    ViewerStep consume(std::vector<std::byte> const& message) override {
        auto encoded = std::get<EncodedBatch>(decode_message(message));
        auto const& [spacing, blank] = blanks_.at(encoded.tiles.front().depth());
        decoder_.decode(spacing, encoded.payload, decoded_);
        encoded.payload = blank.payload;
        encoded.tiles = blank.tiles;
        Batch batch = codec_.decode(encoded, &received_);
        for (DisplayFramelet& framelet : batch.framelets) {
            take_samples(decoded_, framelet);
        }
        time_ = batch.scene_time;
        ViewerStep step = viewer_.insert(batch);
        step.seconds.decode += 1e-9 * pixel_count(decoded_) * setup_.costs.h264_decode_pixel;
        return step;
    }

    ViewerStep present(NumberedView const& view, SceneTime time) override { return viewer_.present(view.camera, time); }

    Picture const& picture() const override { return viewer_.picture(); }
    double mean_sample_time() const override { return time_; }
    void sent(double now, double) override { frame_.sent(now); }
    void answered(double, double arrived) override { frame_.answered(arrived); }

private:
    MethodSetup const setup_;
    bool moves_ = false; ///< the scene moves
    WholeFrame frame_;
    ShapeFeed shapes_;
    ScaledH264Encoder encoder_;
    ScaledH264Decoder decoder_;
    std::size_t last_bytes_ = 0;
    BatchCodec codec_;
    BatchMemory sent_, received_;
    /// Spacing of a frame, and a batch of its tiles with a payload that stands in for the colours, which are sent
    /// otherwise. In `blanks_` by the depth of the tiles.
    struct Blank {
        int spacing = 1;
        EncodedBatch batch;
    };
    std::map<int, Blank> blanks_;
    std::uint64_t number_ = 0;
    Picture decoded_;
    MarginViewer viewer_;
    double time_ = 0;
};

} // namespace

std::unique_ptr<Method> make_framed_warp(MethodSetup const& setup) {
    return std::make_unique<FramedWarp>(setup);
}

} // namespace framelet::bench
