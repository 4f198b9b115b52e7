// The file that the window records to.
#pragma once

#include <filesystem>
#include <memory>

#include "client/video/film_writer.h"

namespace framelet {

/// Makes the writer of a film: H.264 in a new MP4 file in that folder, where the program was built with the libraries
/// for that and they can; else PNG files in a folder of their own there.
std::unique_ptr<FilmWriter> make_film_file(std::filesystem::path const& folder);

} // namespace framelet
