// How far off the viewer shows what it moves ([Yang 2011] figure 11). In: scenes. Out: a table, one row a scene and
// time ahead.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "tests/evaluation/study.h"

namespace framelet::bench {

/// Framelets of a sample a pixel are rendered at one time, coded and decoded as on the wire, and shown by the viewer's
/// own code for the scene's camera 1/60, 1/15 and 1/5 s later. For every pixel that was visible already, the place that
/// it was taken from is compared with the exact one: primary ray, the animation's motion backwards, old camera. So at
/// so many `times` along the animation. Of `study`, scenes and size count. Throws InputError.
nlohmann::json measure_correspondence(StudyOptions const& study, int times);

} // namespace framelet::bench
