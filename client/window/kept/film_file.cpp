// The file that the window records to: a film where the program can make one, else a folder of PNG files.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <utility>

#include "client/window/kept/film_file.h"
#include "client/window/kept/user_files.h"
#include "common/error.h"
#include "common/files/picture_writer.h"

namespace framelet {

namespace fs = std::filesystem;

namespace {

/// A folder of 00000.png and so on, 30 a second: a picture is written for each thirtieth that has begun since the last.
class PictureSeries final : public FilmWriter {
public:
    explicit PictureSeries(fs::path folder) : folder_(std::move(folder)) {}

    void add(Picture const& picture, double seconds) override {
        constexpr double rate = 30;
        auto const until = static_cast<std::uint64_t>(std::ceil(seconds * rate));
        fs::path first;
        for (; next_ < until && !last_.rgba.empty(); ++next_) {
            write(first, last_);
        }
        last_ = picture;
    }
    void finish() override {
        fs::path first;
        if (!last_.rgba.empty()) {
            write(first, last_);
        }
    }
    fs::path path() const override { return folder_; }

private:
    /// Writes the picture to the next file. It is compressed once, to `first`, however often it is shown.
    void write(fs::path& first, Picture const& picture) {
        char name[32];
        std::snprintf(name, sizeof name, "%05llu.png", static_cast<unsigned long long>(next_));
        std::error_code error;
        fs::create_directories(folder_, error);
        if (!first.empty()) {
            fs::copy_file(first, folder_ / name, fs::copy_options::overwrite_existing, error);
            if (error) {
                throw InputError("cannot write " + (folder_ / name).string() + ": " + error.message());
            }
            return;
        }
        first = folder_ / name;
        write_png(first, picture);
    }

    fs::path const folder_;
    Picture last_; ///< not written yet: how long it is shown is not known
    std::uint64_t next_ = 0;
};

} // namespace

std::unique_ptr<FilmWriter> make_film_file(fs::path const& folder) {
    fs::path const film = new_file_name(folder, ".mp4");
    if (can_write_film(film)) {
        return make_film_writer(film);
    }
    return std::make_unique<PictureSeries>(new_file_name(folder, "-film"));
}

} // namespace framelet
