// How much of a picture a link has room for: how many samples a second, in which batches, and how coarsely they are
// coded. In: what the link carries, what the renderer makes. Out: the same, bounded, and a quality.
#pragma once

#include <cstddef>
#include <cstdint>

#include "server/flow/link_estimate.h"

namespace framelet {

/// The coarsest quality that is chosen: its loss, about 32 dB, is what sampling leaves of a picture that moves anyway.
inline constexpr std::uint8_t most_loss = 24;

/// Goes step by step, so that one odd measurement does not show.
class QualityChoice {
public:
    /// `samples_per_second`: what would be sent if the link took it. 0: exact, wherever the link takes all of that.
    std::uint8_t choose(LinkState const& link, double samples_per_second, double now);

private:
    std::uint8_t quality_ = 0;
    double changed_ = 0; ///< when, seconds
};

/// Samples a second that renderer and link both have time for.
double bounded_rate(LinkState const& link, double samples_per_second);

/// Most framelets of a batch that the link takes at once, at least one.
std::size_t bounded_batch(LinkState const& link);

} // namespace framelet
