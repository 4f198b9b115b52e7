// Measures how far from its true position the viewer shows what it moves ([Yang 2011] figure 11). In: scenes. Out: a
// table, one row a scene and time ahead.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "tests/evaluation/study.h"

namespace framelet::bench {

/// Renders framelets of a sample a pixel at one time, codes and decodes them as on the wire, and has the viewer's own
/// code show them for the scene's camera 1/60, 1/15 and 1/5 s later. For every pixel that was visible already, compares
/// the position that it was taken from with the exact one: primary ray, the animation's motion backwards, old camera.
/// Repeats this at `times` times along the animation. Of `study` only scenes and size count. Throws InputError.
nlohmann::json measure_correspondence(StudyOptions const& study, int times);

} // namespace framelet::bench
