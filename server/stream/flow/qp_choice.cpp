#include "server/stream/flow/qp_choice.h"

#include <algorithm>
#include <cmath>

#include "common/error.h"
#include "common/framelet/framelet.h"

namespace framelet {
namespace {

/// Share of the link that is used; the rest is for batches that are larger than expected.
constexpr double link_share = 0.95;
/// Ratios of what is wanted to what the link carries beyond which the QP changes.
constexpr double too_much = 1.1, too_little = 0.9;
/// The finest QP with a loss: its step is below one of a display's, and what is finer costs like exact.
constexpr std::uint8_t least_loss = 4;
/// Bytes of exact samples over those of samples at `least_loss`, about.
constexpr double exact_cost = 3.5;
/// Seconds for which a link may yet turn out to be narrow: what is exact would be late on it. What comes first has
/// `first_qp`, a tenth of the bytes; where there is hardly a link the first answer says so.
constexpr double finding_seconds = 0.5;
constexpr std::uint8_t first_qp = 12;
/// Framelets that are worth what a batch takes besides them (camera, tiles, envelope: about 90 bytes), unless the
/// batch takes longer than `most_batch_seconds` on the link.
constexpr double worthwhile_framelets = 16, most_batch_seconds = 0.05;
/// The least time from one step of the QP to the next, seconds.
constexpr double step_seconds = 0.03;

double worthwhile_bytes(LinkState const& link) {
    return std::min(worthwhile_framelets * framelet_samples * link.bytes_per_sample,
                    most_batch_seconds * link.bytes_per_second);
}

} // namespace

void SentShare::add(double rays, double sent_samples, double rays_per_second) {
    if (!(rays > 0)) {
        return;
    }
    constexpr double memory_seconds = 0.2;
    value_ += (1 - std::exp(-rays / (memory_seconds * rays_per_second))) * (sent_samples / rays - value_);
}

std::uint8_t QpChoice::choose(LinkState const& link, double samples_per_second, double now) {
    if (!begun_) {
        begun_ = changed_ = now;
        qp_ = first_qp;
    }
    bool const is_short = link.base_seconds > 0 && link.base_seconds < least_round_trip;
    bool const may_be_exact = is_short || now - *begun_ >= finding_seconds;
    if (!may_be_exact) {
        qp_ = std::max(qp_, least_loss);
    }
    if (now - changed_ < step_seconds) {
        return qp_;
    }
    double const wanted = samples_per_second * link.bytes_per_sample / (link_share * link.bytes_per_second);
    std::uint8_t const before = qp_;
    if (wanted > too_much) {
        int const steps = wanted > 2 ? 2 : 1;
        qp_ = static_cast<std::uint8_t>(std::clamp(qp_ + steps, int{least_loss}, int{most_loss}));
    } else if (is_short && std::isinf(link.bytes_per_second)) {
        qp_ = lossless_qp;
    } else if (qp_ > least_loss && wanted < too_little) {
        --qp_;
    } else if (qp_ > 0 && may_be_exact && wanted * exact_cost < too_little) {
        qp_ = lossless_qp;
    }
    changed_ = qp_ == before ? changed_ : now;
    return qp_;
}

void choose_qps(std::span<Tile const> tiles, std::span<std::uint8_t> needed, std::uint8_t qp, int last_depth,
                HeldTiles& held, std::vector<std::uint8_t>& qps) {
    FRAMELET_CHECK(tiles.size() == needed.size());
    qps.clear();
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        bool const again = needed[i] == 0 && held.is_lossy(tiles[i]);
        if (needed[i] != 0 || again) {
            bool const last = tiles[i].depth() == last_depth;
            needed[i] = 1;
            qps.push_back(again || last ? lossless_qp : qp);
            held.set_lossy(tiles[i], qps.back() != lossless_qp);
        }
    }
    if (std::ranges::all_of(qps, [](std::uint8_t q) { return q == lossless_qp; })) {
        qps.clear();
    }
}

double bounded_rate(LinkState const& link, double samples_per_second) {
    if (!(link.bytes_per_sample > 0)) {
        return samples_per_second; // nothing but empty messages
    }
    return std::min(samples_per_second, std::max(1.0, link_share * link.bytes_per_second / link.bytes_per_sample));
}

double worthwhile_seconds(LinkState const& link) {
    return worthwhile_bytes(link) / link.bytes_per_second;
}

std::size_t bounded_batch(LinkState const& link) {
    double const most = static_cast<double>(max_batch_framelets);
    double const framelet = link.bytes_per_sample * framelet_samples;
    double const bytes = std::max(link.batch_bytes, worthwhile_bytes(link));
    return static_cast<std::size_t>(framelet > 0 ? std::clamp(bytes / framelet, 1.0, most) : most);
}

} // namespace framelet
