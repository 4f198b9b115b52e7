// Chooses how much of a picture a link has room for: how many samples a second, in which batches, and how coarsely they
// are coded. In: what the link carries, what the renderer makes. Out: the same, bounded, and a QP.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "server/sampling/held/held_tiles.h"
#include "server/stream/flow/link_estimate.h"

namespace framelet {

/// The coarsest QP that is chosen: its loss, about 32 dB, is what sampling leaves of a picture that moves anyway.
inline constexpr std::uint8_t most_loss = 24;

/// Running mean of how many samples are sent for each ray that is rendered: fewer where rays go into probes, into
/// several a sample, and into what the viewer has already.
class SentShare {
public:
    /// Takes in how many rays were rendered and how many samples sent of them. `rays_per_second`: how many are rendered
    /// lately, > 0.
    void add(double rays, double sent_samples, double rays_per_second);
    double value() const { return value_; }

private:
    double value_ = 1;
};

/// Chooses the QP step by step, so that one odd measurement does not show.
class QpChoice {
public:
    /// Returns the QP of the next batch. `samples_per_second`: what would be sent if the link took it; `now`: seconds,
    /// steady. 0 (exact) wherever the link takes all of that; but within the first half second, when little is known of
    /// the link, only where there is hardly one.
    std::uint8_t choose(LinkState const& link, double samples_per_second, double now);

private:
    std::uint8_t qp_ = 0; ///< chosen last
    std::optional<double> begun_; ///< when it was asked first, seconds
    double changed_ = 0; ///< when it changed last, seconds
};

/// Chooses which framelets of a batch go to the viewer and how they are coded. `tiles`: of the picture of `held`, none
/// over another. `needed`: what the scheduler says of each; those that are not needed, because the viewer shows the
/// same, are added where it holds them with loss. `qp`: of the batch. `last_depth`: of tiles that are the last
/// that come, as the picture stands still: they are sent exactly; < 0: of none. Replaces `qps` by one for each framelet
/// that is sent, in order, or by none where all are exact; keeps account in `held`.
void choose_qps(std::span<Tile const> tiles, std::span<std::uint8_t> needed, std::uint8_t qp, int last_depth,
                HeldTiles& held, std::vector<std::uint8_t>& qps);

/// Samples a second that renderer and link both have time for.
double bounded_rate(LinkState const& link, double samples_per_second);

/// Seconds that the link takes for a batch that is worth what it takes besides its framelets; 0 where nothing is known
/// of the link.
double worthwhile_seconds(LinkState const& link);

/// Returns the largest number of framelets of a batch that the link takes at once, at least one.
std::size_t bounded_batch(LinkState const& link);

} // namespace framelet
