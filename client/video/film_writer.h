// A film's file. In: pictures, and when each was shown. Out: MP4 with H.264, or animated WebP, through FFmpeg's
// libraries.
#pragma once

#include <filesystem>
#include <memory>

#include "common/image.h"

namespace framelet {

/// The destination of a film's pictures. All calls come from one thread, and may take long.
class FilmWriter {
public:
    virtual ~FilmWriter() = default;
    /// Adds a picture that is shown `seconds` after the film began, never less than the time before. Pictures of other
    /// sizes than the first are scaled to it. Throws InputError, one line.
    virtual void add(Picture const& picture, double seconds) = 0;
    /// Completes the film after its last picture. Throws InputError, one line.
    virtual void finish() = 0;
    /// The file, or the folder of many.
    virtual std::filesystem::path path() const = 0;
};

/// True where a file of that name is a film: .mp4 or .webp.
bool is_film_name(std::filesystem::path const& file);

/// True where the program was built with the libraries for such a film, and they can make it.
bool can_write_film(std::filesystem::path const& file);

/// Makes a writer of what `can_write_film` says can be written; throws InputError of others. The file is made with the
/// first picture.
std::unique_ptr<FilmWriter> make_film_writer(std::filesystem::path const& file);

} // namespace framelet
