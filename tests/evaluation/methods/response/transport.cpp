#include "tests/evaluation/methods/response/transport.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "common/error.h"

namespace framelet {
namespace {

/// The elements whose changes have one sign.
struct Side {
    double asked = 0; ///< sum of their changes' magnitudes
    double limit = 0; ///< sum of their limits' magnitudes
    /// Greatest common weight that the tightest limit allows (eq. 6.40, 6.41).
    double weight = std::numeric_limits<double>::infinity();

    double uniform_limit() const { return asked > 0 ? std::min(weight * asked, limit) : 0; }
};

Side measure(std::span<double const> changes, std::span<double const> limits, bool positive) {
    Side side;
    for (std::size_t i = 0; i < changes.size(); ++i) {
        if (changes[i] != 0 && (changes[i] > 0) == positive) {
            side.asked += std::abs(changes[i]);
            side.limit += std::abs(limits[i]);
            side.weight = std::min(side.weight, limits[i] / changes[i]);
        }
    }
    return side;
}

/// Sums that each side gives or takes, as magnitudes.
struct Totals {
    double positive, negative;
};

/// Sums of both sides by the strategy. `saved` may be spent beside what the negative side gives up; `room` may be
/// saved.
Totals balance(Side const& a, Side const& b, Transport strategy, double saved, double room) {
    if (strategy == Transport::grow_smaller) {
        double const positive = std::min(a.uniform_limit(), b.uniform_limit() + saved);
        return {positive, std::min(b.uniform_limit(), positive + room)};
    }
    bool const fill = strategy == Transport::fill_smaller;
    if (a.asked > b.asked + saved) {
        double const negative = fill ? std::min(b.limit, a.asked - saved) : b.asked;
        return {std::min(a.asked, negative + saved), negative};
    }
    if (b.asked > a.asked + room) {
        double const positive = fill ? std::min(a.limit, b.asked - room) : a.asked;
        return {positive, std::min(b.asked, positive + room)};
    }
    return {a.asked, b.asked};
}

void scale(std::span<double> changes, bool positive, double weight, std::span<double const> limits) {
    for (std::size_t i = 0; i < changes.size(); ++i) {
        if (changes[i] != 0 && (changes[i] > 0) == positive) {
            double const change = weight * changes[i];
            changes[i] = std::abs(change) < std::abs(limits[i]) ? change : limits[i];
        }
    }
}

/// Scales one side by water-filling: by the one weight at which the changes, each cut at its limit, add up to `total`.
/// The changes are ordered by the weight at which they are cut; all sums are of magnitudes and none is a difference, as
/// sizes may be far apart.
void fill(std::span<double> changes, bool positive, double total, std::span<double const> limits,
          TransportScratch& scratch) {
    auto& [order, free] = scratch;
    order.clear();
    for (std::size_t i = 0; i < changes.size(); ++i) {
        if (changes[i] != 0 && (changes[i] > 0) == positive) {
            order.push_back(static_cast<std::uint32_t>(i));
        }
    }
    std::ranges::sort(order, {}, [&](std::uint32_t i) { return limits[i] / changes[i]; });
    free.resize(order.size());
    double sum = 0;
    for (std::size_t rank = order.size(); rank-- > 0;) {
        sum += std::abs(changes[order[rank]]);
        free[rank] = sum;
    }
    double weight = 0; // weight at which all changes before this rank are cut
    double cut = 0;
    for (std::size_t rank = 0; rank < order.size(); ++rank) {
        std::uint32_t const i = order[rank];
        double const here = limits[i] / changes[i];
        if (cut + here * free[rank] >= total) {
            weight = std::max(weight, (total - cut) / free[rank]);
            break;
        }
        weight = here;
        cut += std::abs(limits[i]);
    }
    scale(changes, positive, weight, limits);
}

} // namespace

void transport(std::span<double> changes, std::span<double const> limits, Transport strategy, Surplus& surplus,
               TransportScratch& scratch) {
    FRAMELET_CHECK(changes.size() == limits.size());
    Side const a = measure(changes, limits, true);
    Side const b = measure(changes, limits, false);
    Totals const totals = balance(a, b, strategy, surplus.saved, std::max(0.0, surplus.most - surplus.saved));
    auto const settle = [&](Side const& side, bool positive, double total) {
        if (total > side.asked && strategy == Transport::fill_smaller) {
            fill(changes, positive, total, limits, scratch);
        } else if (side.asked > 0) {
            scale(changes, positive, total / side.asked, limits);
        }
    };
    settle(a, true, totals.positive);
    settle(b, false, totals.negative);
    double const given = std::accumulate(changes.begin(), changes.end(), 0.0);
    surplus.saved = std::clamp(surplus.saved - given, 0.0, surplus.most);
}

} // namespace framelet
