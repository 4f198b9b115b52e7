#include "common/picture/mix_shares.h"

#include <algorithm>
#include <cstddef>

#include "common/error.h"

namespace framelet {

namespace {

constexpr MixShare none = -1;

struct Mean {
    std::int64_t sum = 0, count = 0;

    void add(MixShare share) {
        if (share != none) {
            sum += share;
            ++count;
        }
    }
    MixShare value_or(MixShare other) const {
        return count > 0 ? static_cast<MixShare>((sum + count / 2) / count) : other;
    }
};

} // namespace

std::optional<double> mix_amount(std::optional<SceneTime> older, std::optional<SceneTime> newer, SceneTime shown,
                                 SceneTime longest) {
    if (!older || !newer) {
        return 1;
    }
    if (*older == *newer) {
        return std::nullopt;
    }
    double const change = std::clamp(*newer - *older, -longest, longest);
    return change == 0 ? 1 : std::clamp(1 + (shown - *newer) / change, 0.0, 1.0);
}

void mix_shares(ShownTimes const& older, ShownTimes const& newer, int columns, SceneTime shown, SceneTime longest,
                std::vector<MixShare>& shares) {
    FRAMELET_CHECK(older.size() == newer.size() && columns > 0 &&
                   newer.size() % static_cast<std::size_t>(columns) == 0);
    std::vector<MixShare> changing(newer.size());
    Mean all;
    for (std::size_t i = 0; i < newer.size(); ++i) {
        std::optional<double> const amount = mix_amount(older[i], newer[i], shown, longest);
        changing[i] = amount ? mix_share(*amount) : none;
        all.add(changing[i]);
    }
    int const rows = static_cast<int>(newer.size()) / columns;
    auto const index = [columns](int column, int row) {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
    };
    auto const around = [&](int column, int row) {
        Mean mean;
        for (int y = std::max(row - 1, 0); y < std::min(row + 2, rows); ++y) {
            for (int x = std::max(column - 1, 0); x < std::min(column + 2, columns); ++x) {
                mean.add(changing[index(x, y)]);
            }
        }
        return mean;
    };
    shares.resize(newer.size());
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            std::size_t const i = index(column, row);
            shares[i] = changing[i] != none ? changing[i] : around(column, row).value_or(all.value_or(whole_share));
        }
    }
}

} // namespace framelet
