#include "client/gpu/sample_atlas.h"

#include <algorithm>
#include <bit>
#include <utility>

#include <epoxy/gl.h>

#include "common/picture/block_canvas.h"

namespace framelet {

namespace {

constexpr int first_layers = 4;

/// The smallest rectangle that has these children.
PixelRect rect_of(MergedSquare const& grid, std::uint64_t children) {
    PixelRect out{grid.side(), grid.side(), 0, 0};
    for (std::uint64_t left = children; left != 0; left &= left - 1) {
        auto const [column, row] = grid.position_of_child(static_cast<std::size_t>(std::countr_zero(left)));
        out.left = std::min(out.left, column);
        out.top = std::min(out.top, row);
        out.right = std::max(out.right, std::min(column + grid.child_side(), grid.side()));
        out.bottom = std::max(out.bottom, std::min(row + grid.child_side(), grid.side()));
    }
    return out;
}

} // namespace

void SampleAtlas::clear() {
    pages_.clear();
    small_pages_.clear();
    for (auto& free : free_) {
        free.clear();
    }
    used_layers_ = 0;
}

SampleAtlas::Position SampleAtlas::position_of(std::int32_t number, std::size_t size) {
    int const across = layer_side / side_of(size);
    int const page = number % (across * across);
    return {static_cast<std::uint32_t>(page % across * side_of(size)),
            static_cast<std::uint32_t>(page / across * side_of(size)),
            static_cast<std::uint32_t>(number / (across * across))};
}

SampleAtlas::Position SampleAtlas::position(std::size_t slot, std::uint32_t square) const {
    Page const& page = pages_[slot][square];
    return position_of(page.number, page.size);
}

/// Frees the pages that this picture has not used.
void SampleAtlas::evict() {
    for (auto& slot : pages_) {
        for (Page& page : slot) {
            if (page.number >= 0 && page.picture < picture_) {
                free_[page.size].push_back(page.number);
                page.number = -1;
            }
        }
    }
}

/// Grows to twice as many layers; what was in them has to be uploaded once more.
void SampleAtlas::grow() {
    GLint most = 0;
    glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &most);
    int const layers = std::min({std::max(2 * layers_, first_layers), static_cast<int>(most), most_layers});
    if (layers <= layers_) {
        throw CanvasError("the graphics card has no room for all samples that are held");
    }
    layers_ = layers;
    texture_ = GlName(GlName::Kind::texture, count_);
    glBindTexture(GL_TEXTURE_2D_ARRAY, texture_.get());
    glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_R32UI, layer_side, layer_side, layers, 0, GL_RED_INTEGER, GL_UNSIGNED_INT,
                 nullptr);
    for (GLenum const filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER}) {
        glTexParameteri(GL_TEXTURE_2D_ARRAY, filter, GL_NEAREST);
    }
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAX_LEVEL, 0);
    check_gl("the samples that are held");
    for (auto& slot : pages_) {
        for (Page& page : slot) {
            page.is_uploaded = false;
        }
    }
}

/// Takes a free page of this size, and returns its number.
std::int32_t SampleAtlas::take(std::size_t size) {
    auto& free = free_[size];
    if (free.empty()) {
        evict();
    }
    if (free.empty()) {
        if (used_layers_ == layers_) {
            grow();
        }
        int const across = layer_side / side_of(size);
        for (int i = across * across - 1; i >= 0; --i) {
            free.push_back(used_layers_ * across * across + i);
        }
        ++used_layers_;
    }
    std::int32_t const number = free.back();
    free.pop_back();
    return number;
}

/// The page of a grid, taken for it where it has none; the grid may not have been uploaded to it yet.
SampleAtlas::Page& SampleAtlas::prepare(Grid const& grid) {
    if (pages_.size() <= grid.slot) {
        pages_.resize(grid.slot + 1);
    }
    if (pages_[grid.slot].size() <= grid.square) {
        pages_[grid.slot].resize(grid.square + 1);
    }
    Page& page = pages_[grid.slot][grid.square];
    page.picture = picture_;
    auto const least = static_cast<unsigned>(least_side);
    auto const side = std::max(static_cast<unsigned>(grid.samples->side()), least);
    auto const size = static_cast<std::size_t>(std::countr_zero(side / least));
    if (page.number >= 0 && page.size != size) {
        free_[page.size].push_back(page.number);
        page.number = -1;
    }
    if (page.number < 0) {
        page.number = take(size);
        page.size = static_cast<std::uint8_t>(size);
        page.is_uploaded = false;
    }
    return page;
}

void SampleAtlas::upload(Grid const& grid, Page& page) {
    MergedSquare& samples = *grid.samples;
    std::uint64_t const written = samples.take_written();
    bool const is_whole = !std::exchange(page.is_uploaded, true) || written == ~std::uint64_t{0};
    if (!is_whole && written == 0) {
        return;
    }
    int const side = samples.side();
    PixelRect const rect = is_whole ? PixelRect{0, 0, side, side} : rect_of(samples, written);
    Position const at = position_of(page.number, page.size);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, side);
    glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, static_cast<GLint>(at.x) + rect.left, static_cast<GLint>(at.y) + rect.top,
                    static_cast<GLint>(at.layer), rect.width(), rect.height(), 1, GL_RED_INTEGER, GL_UNSIGNED_INT,
                    samples.grid().data() + static_cast<std::ptrdiff_t>(rect.top) * side + rect.left);
}

void SampleAtlas::update(std::span<Grid const> grids, std::span<SmallGrid const> small_ones) {
    ++picture_;
    for (Grid const& grid : grids) { // all of them before one is uploaded: growing loses what was
        prepare(grid);
    }
    while (small_pages_.size() < small_ones.size()) {
        small_pages_.push_back(take(0));
    }
    glBindTexture(GL_TEXTURE_2D_ARRAY, texture_.get());
    for (Grid const& grid : grids) {
        upload(grid, pages_[grid.slot][grid.square]);
    }
    for (std::size_t i = 0; i < small_ones.size(); ++i) {
        int const side = small_ones[i].side;
        Position const at = small_position(i);
        glPixelStorei(GL_UNPACK_ROW_LENGTH, side);
        glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, static_cast<GLint>(at.x), static_cast<GLint>(at.y),
                        static_cast<GLint>(at.layer), side, side, 1, GL_RED_INTEGER, GL_UNSIGNED_INT,
                        small_ones[i].samples);
    }
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
}

} // namespace framelet
