// The verb `gate`: whether `framelet` errs more than the committed figures say (`gate.json`). In: scenes, two machines.
// Out: mean squared errors; where their geometric mean over the scenes has grown by 5%, a failure with the figures
// before and after. Not less, and not each scene's: what should change nothing (a bias of 0.001) moves single scenes by
// 2.4% and the mean by 1.3%, and other processors round otherwise.
#pragma once

#include <filesystem>

#include <nlohmann/json_fwd.hpp>

#include "tests/evaluation/study.h"

namespace framelet::bench {

/// Runs each scene on each machine at several phases, prints the errors beside those of `file`. What is worse is in
/// `failures` of its row. `write`: the figures go to the file instead. Throws InputError where it cannot be read or
/// written, or lacks a scene.
nlohmann::json measure_gate(StudyOptions const& study, std::filesystem::path const& file, bool write);

} // namespace framelet::bench
