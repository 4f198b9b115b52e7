#include "tests/evaluation/charts/picture_sheet.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/error.h"
#include "common/files/picture_writer.h"

namespace framelet::bench {
namespace {

Picture error_picture(Picture const& shown, Picture const& reference) {
    Picture out(reference.width, reference.height);
    for (std::size_t i = 0; i < out.rgba.size(); i += 4) {
        double squares = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            double const difference = static_cast<double>(shown.rgba[i + c]) - reference.rgba[i + c];
            squares += difference * difference;
        }
        auto const level = std::lround(std::min(255.0, error_gain * std::sqrt(squares / 3)));
        std::fill_n(&out.rgba[i], 3, static_cast<std::uint8_t>(level));
        out.rgba[i + 3] = 255;
    }
    return out;
}

void check_sizes(std::span<Picture const> pictures) {
    auto const is_other = [&](Picture const& one) {
        return one.width != pictures.front().width || one.height != pictures.front().height;
    };
    if (pictures.empty() || pictures.front().rgba.empty() || std::ranges::any_of(pictures, is_other)) {
        throw InputError("a sheet needs pictures, all of one size");
    }
}

/// Sheet of pictures of one size in rows of `columns`, white between them.
Picture picture_sheet(std::span<Picture const> pictures, int columns) {
    int const width = pictures.front().width, height = pictures.front().height;
    int const gap = std::max(4, width / 64);
    int const rows = (static_cast<int>(pictures.size()) + columns - 1) / columns;
    Picture sheet(columns * (width + gap) + gap, rows * (height + gap) + gap);
    std::ranges::fill(sheet.rgba, std::uint8_t(255));
    for (int i = 0; i < static_cast<int>(pictures.size()); ++i) {
        int const left = gap + i % columns * (width + gap);
        int const top = gap + i / columns * (height + gap);
        for (int y = 0; y < height; ++y) {
            std::copy_n(pictures[static_cast<std::size_t>(i)].row(y), width * 4,
                        sheet.row(top + y) + static_cast<std::ptrdiff_t>(left) * 4);
        }
    }
    return sheet;
}

} // namespace

Picture beside_reference(Picture const& reference, std::span<Picture const> shown) {
    std::vector<Picture> pictures{reference};
    pictures.insert(pictures.end(), shown.begin(), shown.end());
    check_sizes(pictures);
    std::size_t const columns = pictures.size();
    for (std::size_t i = 0; i < columns; ++i) {
        pictures.push_back(error_picture(pictures[i], reference));
    }
    return picture_sheet(pictures, static_cast<int>(columns));
}

void write_beside_reference(std::filesystem::path const& file, Picture const& reference,
                            std::span<Picture const> shown) {
    std::filesystem::create_directories(file.parent_path());
    write_png(file, beside_reference(reference, shown));
}

} // namespace framelet::bench
