#include "server/stream/cycle_record.h"

#include <nlohmann/json.hpp>

namespace framelet {

void describe(AdaptiveRefresh const& refresh, CycleRecord& record) {
    RegionField const& field = refresh.field();
    record.cycle = refresh.cycle_count();
    record.price = static_cast<double>(refresh.price());
    record.budget = refresh.cycle_budget();
    record.samples_planned = 0;
    std::vector<Tile> tiles;
    for (std::size_t i = 0; i < refresh.cycle().size(); ++i) {
        tiles.clear();
        append_tiles(field.plane(), refresh.cycle()[i], tiles);
        auto const rays = static_cast<std::size_t>(i < refresh.first_supersampled() ? single_ray : four_rays);
        record.samples_planned += tiles.size() * framelet_samples * rays;
    }
    record.regions_by_level.fill(0);
    double error = 0;
    double pixels = 0;
    for (std::uint32_t const index : field.visible()) {
        Region const& region = field[index];
        ++record.regions_by_level[static_cast<std::size_t>(region.level + 1)];
        auto const area = static_cast<double>(field.pixels_of(index));
        error += area * static_cast<double>(shown_error(region, 0));
        pixels += area;
    }
    record.mean_shown_error = pixels > 0 ? error / pixels : 0;
}

std::string to_json_line(CycleRecord const& record) {
    nlohmann::ordered_json const line{{"session", record.session},
                                      {"cycle", record.cycle},
                                      {"seconds", record.seconds},
                                      {"scene_time", record.scene_time},
                                      {"price", record.price},
                                      {"budget", record.budget},
                                      {"samples_planned", record.samples_planned},
                                      {"samples_rendered", record.samples_rendered},
                                      {"framelets_sent", record.framelets_sent},
                                      {"framelets_unchanged", record.framelets_unchanged},
                                      {"probes", record.probes},
                                      {"regions_by_level", record.regions_by_level},
                                      {"mean_shown_error", record.mean_shown_error},
                                      {"stage_seconds",
                                       {{"plan", record.stage_seconds.plan},
                                        {"render", record.stage_seconds.render},
                                        {"learn", record.stage_seconds.learn},
                                        {"wait", record.stage_seconds.wait}}}};
    return line.dump();
}

} // namespace framelet
