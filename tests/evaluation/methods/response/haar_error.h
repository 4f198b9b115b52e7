// Error estimate by a streaming Haar transform ([Stephens 2011] section 5.3). In: the samples of a framelet and the
// coefficients of the previous one of the same place. Out: sample-rate errors by block, and the coefficients to keep.
#pragma once

#include "tests/evaluation/methods/response/rate_error.h"

namespace framelet {

/// Spatial coefficients of the previous framelet of a place, octave after octave.
using HaarHistory = ErrorHistory;

/// Templates of `estimate_haar`, fitted to errors of rendered pictures.
inline constexpr RateTemplates haar_templates{{-16.5f, 5.25f}, {-11.75f, -3.125f}};

/// Error of each block ([Stephens 2011] section 5.3.4).
///
/// `samples`: display-encoded luma in [0, 1], Morton order; 256 or 1024 (framelets of 16x16 or 32x32).
/// `history`: that of a framelet of the same place and size; is replaced by what the next call needs.
/// `seconds_since`: > 0, time since the history's framelet; not read where the history is empty.
/// `elements`: 1, 4, 16, 64 or 256 equal blocks of the framelet, in Morton order.
///
/// Each octave takes a step of the transform in x and y, which gives the coefficients A, and one in time, against the
/// cached A'; what is low pass in all three goes on to the next octave, A into the cache. Energy in space is that of
/// ghh, hgh and ggh, in time of hhg, hgg and ghg, as mean square over the block; where coefficients are wider than the
/// block it has its share of them. Error is the weighted mean over the octaves of (energy - template) / (energy +
/// template), which is tanh of half the difference of their natural logarithms: signed, 0 where they agree, within [-1,
/// 1] however far apart they are. Weights halve from each octave to the next coarser one, since denser sampling adds
/// energy next to the finest (with equal weights fewer signs agree with the ideal density). Without a history the error
/// in time is 0, and the one in space that of the framelet alone.
void estimate_haar(std::span<float const> samples, HaarHistory& history, float seconds_since,
                   RateTemplates const& templates, std::span<RateError> elements);

} // namespace framelet
