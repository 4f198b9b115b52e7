#include "client/video/film_sink.h"

#include <algorithm>

#include "client/frames/output_folder.h"
#include "common/error.h"

namespace framelet {

namespace {

/// Number of pictures of that size, at most, that are kept until they are written.
std::size_t most_kept(Viewport size) {
    constexpr std::size_t most_bytes = std::size_t{256} << 20;
    return std::max(most_bytes /
                        (std::size_t{4} * static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height)),
                    std::size_t{2});
}

} // namespace

FilmSink::FilmSink(std::filesystem::path const& file, Viewport size)
    : recorder_(make_film_writer(file), most_kept(size), WhenWritten::at_the_end) {
    make_folder_of(file);
}

void FilmSink::show(ShownFrame const& frame) {
    throw_if_failed();
    if (!begin_ && frame.changed) {
        begin_ = frame.seconds;
    }
    seconds_ = frame.seconds - begin_.value_or(frame.seconds);
    if (frame.changed) {
        recorder_.add(frame.picture, seconds_);
    }
}

void FilmSink::finish() {
    recorder_.stop(seconds_);
    recorder_.wait();
    throw_if_failed();
}

void FilmSink::throw_if_failed() const {
    if (auto const failure = recorder_.progress().failure) {
        throw InputError(*failure);
    }
}

} // namespace framelet
