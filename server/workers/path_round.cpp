#include "server/workers/path_round.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include <tbb/parallel_for.h>

#include "server/render/path/path_tracing.h"
#include "server/workers/order_tracing.h"

namespace framelet {
namespace {

/// True where an order may say it: what deforms to nothing may have no place.
bool can_travel(PlaceGathering const& wanted) {
    auto const is_within = [](Vec3 const& value, float most) {
        return glm::all(glm::lessThanEqual(glm::abs(value), Vec3(most))); // not for NaN
    };
    return is_within(wanted.place.position, max_camera_coordinate) && is_within(wanted.place.normal, 1.0005f);
}

} // namespace

void PathRound::begin(WorkerPool* workers, PathLight const& light, Moment const& moment, std::vector<TilePath> tiles,
                      LightGathering* gathering, std::size_t packets) {
    workers_ = workers;
    path_light_ = &light;
    gathering_ = gathering;
    moment_ = moment;
    tiles_ = std::move(tiles);
    light_.resize(std::max(light_.size(), tiles_.size()));
    packets_.resize(packets);
    std::iota(packets_.begin(), packets_.end(), std::size_t{0});
    shared_packets_ = 0;
    chunks_.clear();
    if (workers_ != nullptr && workers_->workers() > 0) {
        share();
    }
}

void PathRound::share() {
    std::vector<PathOrder> orders;
    std::vector<PlacePaths> places;
    std::vector<std::size_t> stay;
    for (std::size_t packet = 0; packet < packets_.size(); ++packet) {
        auto const wanted = gathering_->order(packet);
        if (wanted && can_travel(*wanted)) {
            packets_[places.size()] = packet;
            places.push_back({wanted->place.frame, wanted->place.position, wanted->place.normal, wanted->seed,
                              wanted->first, wanted->bright});
        } else {
            stay.push_back(packet);
        }
    }
    shared_packets_ = places.size();
    std::ranges::copy(stay, packets_.begin() + static_cast<std::ptrdiff_t>(shared_packets_));
    auto const split = [&](bool is_of_tiles, auto const& all, auto PathOrder::*part, std::size_t at_once) {
        for (std::size_t first = 0; first < all.size(); first += at_once) {
            Chunk const chunk{is_of_tiles, first, std::min(at_once, all.size() - first)};
            PathOrder order;
            order.scene_time = moment_.scene_time;
            order.view = moment_.view;
            order.display = path_light_->scene().scene.display;
            auto const begin = all.begin() + static_cast<std::ptrdiff_t>(first);
            (order.*part).assign(begin, begin + static_cast<std::ptrdiff_t>(chunk.count));
            chunks_.push_back(chunk);
            orders.push_back(std::move(order));
        }
    };
    std::size_t const paths = workers_->paths_a_chunk();
    split(true, tiles_, &PathOrder::tiles, std::clamp<std::size_t>(paths / framelet_samples, 1, max_order_tiles));
    split(false, places, &PathOrder::places, std::clamp<std::size_t>(paths / lanes, 1, max_order_places));
    workers_->begin(std::move(orders));
}

/// Traces one of the tiles, or of the packets, which are numbered behind the tiles.
void PathRound::trace(std::size_t index) {
    if (index >= tiles_.size()) {
        gathering_->follow(packets_[index - tiles_.size()]);
        return;
    }
    NumberedView const& view = moment_.view;
    trace_tile(*path_light_, make_view_rays(view.camera, view.viewport), ImagePlane(view.viewport), tiles_[index].tile,
               static_cast<int>(tiles_[index].number), light_[index]);
}

bool PathRound::take(Chunk const& chunk, PathAnswer const& answer) {
    if (chunk.is_of_tiles) {
        return read_tiles(answer, std::span(light_).subspan(chunk.first, chunk.count));
    }
    std::vector<GatheredPacket> gathered(chunk.count);
    if (!read_places(answer, gathered)) {
        return false;
    }
    for (std::size_t i = 0; i < chunk.count; ++i) {
        gathering_->take_gathered(packets_[chunk.first + i], gathered[i]);
    }
    return true;
}

void PathRound::finish() {
    if (chunks_.empty()) {
        tbb::parallel_for(std::size_t{0}, tiles_.size() + packets_.size(), [&](std::size_t i) { trace(i); });
        return;
    }
    tbb::parallel_for(tiles_.size() + shared_packets_, tiles_.size() + packets_.size(),
                      [&](std::size_t i) { trace(i); });
    double const waited = workers_->finish(
        [&](std::size_t index) {
            Chunk const& chunk = chunks_[index];
            std::size_t const first = (chunk.is_of_tiles ? 0 : tiles_.size()) + chunk.first;
            for (std::size_t i = first; i < first + chunk.count; ++i) {
                trace(i);
            }
        },
        [&](std::size_t index, PathAnswer const& answer) { return take(chunks_[index], answer); });
    if (gathering_ != nullptr) {
        gathering_->note_waited(waited);
    }
}

} // namespace framelet
