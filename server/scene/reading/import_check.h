// Has a scene file read by a process of its own, before a server reads it that has viewers: what a library takes
// without asking cannot be bounded for one thread, and a process that crashes takes all its threads along. In: a file.
// Out: nothing, or an InputError.
#pragma once

#include <filesystem>

#include "server/scene/reading/import_options.h"
#include "server/scene/reading/progress.h"

namespace framelet {

/// Throws InputError, without the file's name, where `options.checker` cannot read the file within `options`, or does
/// not come to an end of it: it is ended once its standard output has said nothing for longer than its patience. Where
/// `progress` throws the process is ended too. What the file has become meanwhile is not known.
void check_import(std::filesystem::path const& file, ImportOptions const& options, Progress const& progress);

} // namespace framelet
