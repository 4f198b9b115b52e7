#include "server/sampling/plan/probe_selection.h"

#include <algorithm>

namespace framelet {
namespace {

/// A region is probed again after so many seconds, sooner beside something that moves.
constexpr double probe_period = 0.25;
/// A region that is refreshed again and again but has not been seen for so many seconds is probed all the same.
constexpr double most_unseen = 0.5;

} // namespace

void select_probed(RegionField const& field, Choices const& choices, double now, std::size_t most,
                   ProbeScratch& scratch, std::vector<std::uint32_t>& probed) {
    scratch.active.assign(field.size(), 0);
    for (std::uint32_t const index : field.visible()) {
        scratch.active[index] = field[index].model.motion > 0 ? 1 : 0;
    }
    auto const is_active = [&](int column, int row) {
        int const side = 1 << field.depth();
        if (column < 0 || row < 0 || column >= side || row >= side) {
            return false;
        }
        return scratch.active[morton_index(static_cast<std::uint32_t>(column), static_cast<std::uint32_t>(row))] != 0;
    };
    auto const suspicion = [&](std::uint32_t index) {
        Region const& region = field[index];
        int const column = static_cast<int>(morton_x(index));
        int const row = static_cast<int>(morton_y(index));
        bool beside = false;
        for (int y = row - 1; y <= row + 1; ++y) {
            for (int x = column - 1; x <= column + 1; ++x) {
                beside = beside || is_active(x, y);
            }
        }
        return (now - region.asked) * (beside ? 8 : 1);
    };
    probed.clear();
    scratch.suspicions.assign(field.size(), 0);
    for (std::uint32_t const index : field.visible()) {
        Region const& region = field[index];
        if (region.level < 0 || region.taken.level >= 0 || region.probe_count == 0) {
            continue;
        }
        // A region that is refreshed again and again needs no probes, as long as it is.
        bool const planned = region.model.motion > 0 && choices.size() == field.size() && choices[index].recurring &&
                             static_cast<double>(choices[index].period) < probe_period;
        double const expected = planned ? most_unseen : 0;
        scratch.suspicions[index] = suspicion(index);
        if (scratch.suspicions[index] > probe_period && now - region.asked > expected) {
            probed.push_back(index);
        }
    }
    auto const count = static_cast<std::ptrdiff_t>(std::min(probed.size(), most));
    std::partial_sort(probed.begin(), probed.begin() + count, probed.end(), [&](std::uint32_t a, std::uint32_t b) {
        std::vector<double> const& keys = scratch.suspicions;
        return keys[a] != keys[b] ? keys[a] > keys[b] : a < b;
    });
    probed.resize(static_cast<std::size_t>(count));
}

} // namespace framelet
