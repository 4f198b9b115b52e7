#include "client/gpu/far_passes.h"

#include "client/gpu/shader_text.h"
#include "common/color.h"
#include "common/picture/reconstruction.h"
#include "common/warp/warp_block.h"

namespace framelet {

namespace {

int blocks_of(int pixels) {
    return (pixels + WarpedBlock::side - 1) / WarpedBlock::side;
}

} // namespace

FarPasses::Cells::Cells(int width, int height, GlCount& count)
    : plane(TexelFormat::four_floats, width, height, count), target({&plane}, count) {}

FarPasses::FarPasses(GlCount& count)
    : count_(count),
      pull_pixels_({shaders::screen_vert}, {shaders::far_glsl, shaders::pull_pixels_frag}, {"colors", "depths"}, count),
      pull_({shaders::screen_vert}, {shaders::far_glsl, shaders::pull_frag}, {"fine"}, count),
      block_mean_({shaders::screen_vert}, {shaders::far_glsl, shaders::block_mean_frag},
                  {"colors", "depths", "level3", "figures"}, count),
      pull_means_({shaders::screen_vert}, {shaders::far_glsl, shaders::pull_means_frag}, {"fine"}, count),
      push_means_({shaders::screen_vert}, {shaders::far_glsl, shaders::push_means_frag}, {"fine", "coarse"}, count),
      push_({shaders::screen_vert}, {shaders::far_glsl, shaders::push_frag}, {"fine", "coarse"}, count),
      fill_({shaders::screen_vert}, {shaders::far_glsl, shaders::fill_frag}, {"depths", "level1"}, count) {}

void FarPasses::set_size(Viewport viewport) {
    viewport_ = viewport;
    pulled_.clear();
    means_.clear();
    pushed_means_.clear();
    pushed_.clear();
    int columns = blocks_of(viewport.width);
    int rows = blocks_of(viewport.height);
    for (int cells : {8, 4, 2}) {
        pulled_.emplace_back(cells * columns, cells * rows, count_);
    }
    for (int cells : {2, 4, 8}) {
        pushed_.emplace_back(cells * columns + 2, cells * rows + 2, count_);
    }
    means_.emplace_back(columns, rows, count_);
    while (columns > 1 || rows > 1) {
        pushed_means_.emplace_back(columns, rows, count_);
        columns = (columns + 1) / 2;
        rows = (rows + 1) / 2;
        means_.emplace_back(columns, rows, count_);
    }
}

void FarPasses::fill(GlPlane const& colors, GlPlane const& depths, GlPlane const& figures,
                     GlTarget const& target) const {
    pull_pixels_.begin(pulled_[0].target, {colors.texture(), depths.texture()});
    pull_pixels_.set("viewport", viewport_.width, viewport_.height);
    pull_pixels_.draw_all();
    for (std::size_t i = 1; i < pulled_.size(); ++i) {
        pull_.begin(pulled_[i].target, {pulled_[i - 1].plane.texture()});
        pull_.draw_all();
    }
    block_mean_.begin(means_[0].target,
                      {colors.texture(), depths.texture(), pulled_.back().plane.texture(), figures.texture()});
    block_mean_.set("viewport", viewport_.width, viewport_.height);
    block_mean_.draw_all();
    for (std::size_t i = 1; i < means_.size(); ++i) {
        pull_means_.begin(means_[i].target, {means_[i - 1].plane.texture()});
        pull_means_.draw_all();
    }
    GlPlane const* coarse = &means_.back().plane;
    for (std::size_t i = pushed_means_.size(); i-- > 0;) {
        push_means_.begin(pushed_means_[i].target, {means_[i].plane.texture(), coarse->texture()});
        push_means_.draw_all();
        coarse = &pushed_means_[i].plane;
    }
    for (std::size_t i = 0; i < pushed_.size(); ++i) {
        push_.begin(pushed_[i].target, {pulled_[pulled_.size() - 1 - i].plane.texture(), coarse->texture()});
        push_.set("coarse_border", i == 0 ? 0 : 1);
        push_.draw_all();
        coarse = &pushed_[i].plane;
    }
    fill_.begin(target, {depths.texture(), coarse->texture()});
    fill_.set("uncovered", static_cast<float>(srgb_byte_from_linear(uncovered_light)) / 255.0f);
    fill_.draw_all();
}

} // namespace framelet
