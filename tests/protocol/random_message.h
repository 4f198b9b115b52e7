// Random valid messages for property tests. In: a seeded generator. Out: values inside the ranges of PROTOCOL.md, with
// the ends of the ranges more often than chance would have it.
#pragma once

#include <algorithm>
#include <random>
#include <set>

#include "protocol/messages/message.h"

namespace framelet {

class RandomMessages {
public:
    explicit RandomMessages(std::uint64_t seed) : generator_(seed) {}

    std::uint64_t integer(std::uint64_t lowest, std::uint64_t highest) {
        return std::uniform_int_distribution<std::uint64_t>(lowest, highest)(generator_);
    }
    double number(double lowest, double highest) {
        switch (integer(0, 9)) {
        case 0:
            return lowest;
        case 1:
            return highest;
        default:
            return std::uniform_real_distribution<double>(lowest, highest)(generator_);
        }
    }
    float small(double lowest, double highest) { return static_cast<float>(number(lowest, highest)); }
    bool coin() { return integer(0, 1) == 1; }
    std::uint64_t any64() { return coin() ? generator_() : integer(0, 3); }
    std::uint32_t any32() { return static_cast<std::uint32_t>(any64()); }
    Vec3 vector() { return {small(-1e6, 1e6), small(-1e6, 1e6), small(-1e6, 1e6)}; }

    std::string text(std::size_t longest) {
        static constexpr char const* characters[] = {"a", "Z", "0", " ", "~", "\u00e9", "\u4e16", "\U0001f600"};
        std::string text;
        std::size_t const length = integer(0, 5) == 0 ? longest : integer(0, 20);
        for (;;) {
            std::string const next = characters[integer(0, std::size(characters) - 1)];
            if (text.size() + next.size() > length) {
                return text;
            }
            text += next;
        }
    }

    Camera camera() {
        Camera camera;
        camera.position = vector();
        camera.orientation = glm::normalize(Quat(small(0.1, 1), small(-1, 1), small(-1, 1), small(-1, 1)));
        camera.projection = coin() ? Projection::perspective : Projection::orthographic;
        camera.vertical_extent = small(0.01, 3.1);
        return camera;
    }
    Viewport viewport() {
        return {static_cast<int>(number(1, max_viewport_side)), static_cast<int>(number(1, max_viewport_side))};
    }
    NumberedView view() { return {any64(), camera(), viewport(), any64()}; }
    Ticket ticket() { return {any64(), any64()}; }
    ClockState clock() { return {number(0, 1e9), coin(), small(-16, 16)}; }

    Welcome welcome() {
        Welcome welcome;
        welcome.version = static_cast<std::uint16_t>(any64());
        welcome.server = text(1024);
        welcome.scene_name = text(1024);
        if (coin()) {
            welcome.scene_bounds.include(vector());
            welcome.scene_bounds.include(vector());
        }
        welcome.start_camera = camera();
        for (std::uint64_t i = integer(0, 5); i > 0; --i) {
            welcome.cameras.push_back({text(1024), camera()});
        }
        welcome.animation_duration = number(0, 1e6);
        welcome.clock = clock();
        welcome.scene_identity = any64();
        welcome.controls = coin();
        welcome.ticket = ticket();
        welcome.resumed = coin();
        welcome.evicted = any64();
        welcome.scene_source = any64();
        welcome.scene_origin = {number(-1e10f, 1e10f), 0.1, number(-1e3f, 1e3f)};
        return welcome;
    }

    /// At most so many tiles that a plane accepts, no two the same.
    std::vector<Tile> tiles(ImagePlane const& plane, std::size_t most) {
        std::set<Tile> tiles;
        for (std::size_t i = 0; i < most; ++i) {
            auto const depth = static_cast<int>(
                integer(static_cast<std::uint64_t>(plane.min_depth()), static_cast<std::uint64_t>(plane.max_depth())));
            std::uint32_t const side = (1u << depth) - 1;
            Tile const tile = make_tile(depth, static_cast<std::uint32_t>(integer(0, side)),
                                        static_cast<std::uint32_t>(integer(0, side)));
            if (plane.accepts(tile)) {
                tiles.insert(tile);
            }
        }
        std::vector<Tile> shuffled(tiles.begin(), tiles.end());
        std::shuffle(shuffled.begin(), shuffled.end(), generator_);
        return shuffled;
    }

    EncodedBatch batch() {
        EncodedBatch batch;
        batch.number = any64() | 1u;
        BatchMoment const moment{view(), number(0, 1e9), number(0, 1e9), coin()};
        batch.tiles = tiles(ImagePlane(moment.view.viewport), integer(0, 60));
        if (batch.moment = moment; coin()) {
            batch.moment.reset();
        }
        batch.payload.resize(integer(0, 3000));
        for (std::byte& byte : batch.payload) {
            byte = static_cast<std::byte>(generator_());
        }
        if (coin()) {
            batch.shapes.resize(integer(1, 100), std::byte{7});
            batch.tracks.resize(integer(0, 100), std::byte{5});
        }
        return batch;
    }

    Evicted evicted() {
        Evicted message;
        for (std::uint64_t batch = integer(0, 4); batch > 0; --batch) {
            for (std::uint64_t count = integer(1, 30); count > 0; --count) {
                auto const depth = static_cast<int>(integer(0, 15));
                auto const index = static_cast<std::uint32_t>(any32() & ((1u << 2 * depth) - 1));
                message.framelets.push_back({batch, Tile{(1u << 2 * depth) + index}});
            }
        }
        return message;
    }

    Hello hello() {
        Hello hello{static_cast<std::uint16_t>(any64()), text(4096), any32(), ticket(), any64()};
        if (coin()) {
            hello.work = {any64(), any64(), static_cast<std::uint16_t>(any64())};
        }
        return hello;
    }

    PathOrder order() {
        PathOrder order{any64(), any64(), number(0, 1e9), view(), {}, {}, {}};
        order.display = {small(1e-5, 1e5), static_cast<ToneCurve>(integer(0, 3))};
        if (coin()) {
            for (Tile const tile : tiles(ImagePlane(order.view.viewport), max_order_tiles)) {
                order.tiles.push_back({tile, any32()});
            }
            return order;
        }
        for (std::uint64_t i = integer(0, 3) == 0 ? max_order_places : integer(0, 5); i > 0; --i) {
            order.places.push_back(
                {any32(), vector(), glm::normalize(vector() + Vec3(0.1f)), any32(), any32(), small(0, 1e9)});
        }
        return order;
    }

    PathAnswer path_answer() {
        PathAnswer answer{any64(), any32(), {}};
        answer.light.resize(integer(0, 3) == 0 ? max_order_tiles * 3 * framelet_samples : integer(0, 9));
        std::ranges::generate(answer.light, [this] { return small(-1e6, 1e6); });
        return answer;
    }

    Message message() {
        switch (integer(0, 11)) {
        case 0:
            return hello();
        case 1:
            return CameraUpdate{view(), static_cast<int>(number(-1, 4095))};
        case 2:
            return ViewerSettings{small(-16, 16), small(-1, 1), coin(), coin()};
        case 3:
            return ClockRequest{static_cast<std::uint8_t>(integer(0, 7)), clock()};
        case 4:
            return Ack{any64(), any64(), any32()};
        case 5:
            return evicted();
        case 6:
            return welcome();
        case 7:
            return batch();
        case 8:
            return Status{clock(), any64(),         any64(),
                          coin(),  number(0, 1e12), any32(),
                          coin(),  any64(),         static_cast<float>(number(0, 1))};
        case 9:
            return order();
        case 10:
            return path_answer();
        default:
            return Failure{text(4096), coin()};
        }
    }

    /// Any message but Status, of which a stream sends only the newest.
    Message lasting_message() {
        Message const any = message();
        return std::holds_alternative<Status>(any) ? lasting_message() : any;
    }

private:
    std::mt19937_64 generator_;
};

/// True where two messages are the same in every field. `Bounds` has no comparison of its own.
inline bool same(Message const& left, Message const& right) {
    auto const* const a = std::get_if<Welcome>(&left);
    auto const* const b = std::get_if<Welcome>(&right);
    if (left.index() != right.index()) {
        return false;
    }
    if (a != nullptr) {
        return a->version == b->version && a->server == b->server && a->scene_name == b->scene_name &&
               a->scene_bounds.lower == b->scene_bounds.lower && a->scene_bounds.upper == b->scene_bounds.upper &&
               a->start_camera == b->start_camera && a->cameras == b->cameras &&
               a->animation_duration == b->animation_duration && a->clock == b->clock &&
               a->scene_identity == b->scene_identity && a->controls == b->controls && a->ticket == b->ticket &&
               a->resumed == b->resumed && a->evicted == b->evicted && a->scene_source == b->scene_source &&
               a->scene_origin == b->scene_origin;
    }
    return std::visit(
        [&](auto const& value) {
            using Value = std::decay_t<decltype(value)>;
            if constexpr (std::is_same_v<Value, Welcome>) {
                return false; // compared above
            } else {
                return value == std::get<Value>(right);
            }
        },
        left);
}

} // namespace framelet
