// How much of a picture a link has room for: how many samples a second, in which batches, and how coarsely they are
// coded. In: what the link carries, what the renderer makes. Out: the same, bounded, and a quality.
#pragma once

#include <cstddef>
#include <cstdint>

#include "server/stream/flow/link_estimate.h"

namespace framelet {

/// The coarsest quality that is chosen: its loss, about 32 dB, is what sampling leaves of a picture that moves anyway.
inline constexpr std::uint8_t most_loss = 24;
/// The finest quality of what is rendered while anything moves, however wide the link: it is replaced within moments,
/// and exact samples of it take 2.5 times the bytes for 0.2 dB of the picture that is shown.
inline constexpr std::uint8_t moving_loss = 3;

/// How many samples are sent for each ray that is rendered, lately: fewer where rays go into probes, into several a
/// sample, and into what the viewer has already.
class SentShare {
public:
    void add(double rays, double sent_samples);
    double value() const { return value_; }

private:
    double value_ = 1;
};

/// Goes step by step, so that one odd measurement does not show.
class QualityChoice {
public:
    /// `samples_per_second`: what would be sent if the link took it. 0: exact, wherever the link takes all of that and
    /// nothing moves.
    std::uint8_t choose(LinkState const& link, double samples_per_second, double now, bool moves);

private:
    void follow(LinkState const& link, double samples_per_second, double now);

    std::uint8_t quality_ = 0; ///< that the link asks for
    double changed_ = 0; ///< when, seconds
};

/// Samples a second that renderer and link both have time for.
double bounded_rate(LinkState const& link, double samples_per_second);

/// Most framelets of a batch that the link takes at once, at least one.
std::size_t bounded_batch(LinkState const& link);

} // namespace framelet
