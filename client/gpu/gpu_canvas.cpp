#include "client/gpu/gpu_canvas.h"

#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <span>
#include <utility>

#include <epoxy/gl.h>

#include "client/gpu/far_passes.h"
#include "client/gpu/gl/gl_objects.h"
#include "client/gpu/gl/render_pass.h"
#include "client/gpu/patch_table.h"
#include "client/gpu/sample_atlas.h"
#include "client/gpu/shader_text.h"
#include "common/error.h"
#include "common/warp/warp_block.h"

namespace framelet {

namespace {

constexpr int side = WarpedBlock::side;
constexpr std::size_t words_of_report = 4; ///< that each of the two planes has for a block

/// All planes, targets and buffers whose size is that of a picture.
struct Planes {
    Planes(Viewport viewport, int columns, int rows, GlCount& count)
        : colors(TexelFormat::color, viewport.width, viewport.height, count),
          depths(TexelFormat::depth, viewport.width, viewport.height, count),
          claims(TexelFormat::four_numbers, viewport.width, viewport.height, count),
          winners(TexelFormat::number, viewport.width, viewport.height, count),
          picture(TexelFormat::color, viewport.width, viewport.height, count),
          block_claims(TexelFormat::four_numbers, columns, rows, count),
          block_figures(TexelFormat::four_numbers, columns, rows, count),
          painted({&colors, &depths, &claims, &winners}, count), filled({&colors}, count), filtered({&picture}, count),
          depths_alone({&depths}, count), reported({&block_claims, &block_figures}, count),
          report_buffer(GlName::Kind::buffer, count),
          report_words(2 * words_of_report * static_cast<std::size_t>(columns * rows)) {
        glBindBuffer(GL_PIXEL_PACK_BUFFER, report_buffer.get());
        glBufferData(GL_PIXEL_PACK_BUFFER, static_cast<GLsizeiptr>(report_words.size() * sizeof report_words[0]),
                     nullptr, GL_STREAM_READ);
        glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
        check_gl("what is reported of a picture");
    }

    GlPlane colors, depths, claims, winners; ///< as paint.frag writes them
    GlPlane picture; ///< the picture, filtered
    GlPlane block_claims, block_figures; ///< as report.frag writes them
    GlTarget painted, filled, filtered, depths_alone, reported;
    GlName report_buffer;
    std::vector<std::uint32_t> report_words; ///< claims of all blocks, figures of all blocks
};

/// The report on a block from when it was painted last.
class ReportedBlock {
public:
    ReportedBlock(std::vector<std::uint32_t> const& words, std::size_t index)
        : claims_(words.data() + words_of_report * index),
          figures_(words.data() + words.size() / 2 + words_of_report * index) {}

    BlockReport report() const { return {static_cast<std::int32_t>(figures_[2]), figures_[3]}; }

    /// Notes which patches showed, as `paint_warped_block` does: of the first `most_counted` those of whose group
    /// enough shows, of the others those of which something showed. Patches without a bit of their own are noted all
    /// together.
    void note_shown(std::span<PatchView const> patches) const {
        for (std::uint32_t word = 0; word < words_of_report; ++word) {
            for (std::uint32_t left = claims_[word]; left != 0; left &= left - 1) {
                std::uint32_t const i = 32 * word + static_cast<std::uint32_t>(std::countr_zero(left));
                std::size_t const end = i + 1 < PatchTable::most_claims ? i + 1 : patches.size();
                for (std::size_t k = i; k < std::min(end, patches.size()); ++k) {
                    if (i >= PatchTable::most_counted || shows_enough(patches, i)) {
                        note(patches[k]);
                    }
                }
            }
        }
    }

private:
    static void note(PatchView const& view) {
        if (view.shows != nullptr) {
            *view.shows = 1;
        }
    }
    bool shows_enough(std::span<PatchView const> patches, std::uint32_t index) const {
        std::int32_t const group = patches[index].patch->group;
        auto const leader = static_cast<std::uint32_t>(
            std::ranges::find_if(patches, [&](PatchView const& view) { return view.patch->group == group; }) -
            patches.begin());
        return (figures_[leader / 32] >> leader % 32 & 1) != 0;
    }

    std::uint32_t const* claims_;
    std::uint32_t const* figures_; ///< two words of bits, holes, slots
};

} // namespace

struct GpuCanvas::Impl {
    GlCount count;
    RenderPass paint_pass{{shaders::tables_glsl, shaders::block_vert},
                          {shaders::tables_glsl, shaders::painting_glsl, shaders::paint_frag},
                          {"samples", "patches", "entries", "lists", "splats", "blocks", "hidden"},
                          count};
    RenderPass hidden_pass{{shaders::screen_vert},
                           {shaders::tables_glsl, shaders::painting_glsl, shaders::hidden_frag},
                           {"samples", "patches", "entries", "lists", "splats", "blocks", "earlier"},
                           count};
    RenderPass report_pass{{shaders::screen_vert}, {shaders::report_frag}, {"claims", "winners"}, count};
    RenderPass filter_pass{{shaders::screen_vert}, {shaders::filter_frag}, {"colors"}, count};
    FarPasses far_passes{count};
    GlName vertices{GlName::Kind::vertex_array, count}; ///< empty: corners come from their numbers
    SampleAtlas atlas{count};
    PatchTable table;
    GlTable patches{TexelFormat::four_numbers, 4, count};
    GlTable entries{TexelFormat::four_numbers, 4, count};
    GlTable lists{TexelFormat::number, 1, count};
    GlTable splats{TexelFormat::four_numbers, 4, count};
    GlTable blocks{TexelFormat::four_numbers, 4, count};
    /// A number for each splat, 1 where it is hidden: as the passes find it in turn.
    std::array<GlPlane, 2> hidden;
    std::array<GlTarget, 2> hidden_targets;
    std::optional<Planes> planes;
    bool is_asked_for = false; ///< the picture of these planes has been asked for
    GlPlane kept; ///< the picture of the planes before, which may be on the display
    void const* owner = nullptr;
    Viewport viewport{0, 0};
    int columns = 0, rows = 0;

    void set_size(Viewport size) {
        if (planes && is_asked_for) {
            kept = std::move(planes->picture);
        }
        is_asked_for = false;
        planes.reset();
        viewport = {0, 0}; // until all is there
        forget_errors();
        columns = (size.width + side - 1) / side;
        rows = (size.height + side - 1) / side;
        planes.emplace(size, columns, rows, count);
        far_passes.set_size(size);
        viewport = size;
    }

    void prepare_gl() const {
        forget_errors();
        glDisable(GL_BLEND);
        glDisable(GL_DEPTH_TEST);
        glDisable(GL_SCISSOR_TEST);
        glDisable(GL_CULL_FACE);
        glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
        glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
        glPixelStorei(GL_PACK_ALIGNMENT, 4);
        glActiveTexture(GL_TEXTURE0);
        glBindVertexArray(vertices.get());
    }
    void leave_gl() const {
        glBindFramebuffer(GL_FRAMEBUFFER, 0);
        glUseProgram(0);
        glBindVertexArray(0);
    }

    void upload(CanvasJobs const& jobs) {
        table.make(jobs, atlas);
        patches.upload(table.patches);
        entries.upload(table.entries);
        lists.upload(table.lists);
        splats.upload(table.splats);
        blocks.upload(table.blocks);
    }

    /// Each pass is right of splats that wait for one more of others; an even number, so that the last one writes
    /// `hidden[1]`.
    static constexpr std::size_t hidden_passes = 4;

    /// Finds which splats are mostly hidden, so that nothing of them is to show.
    void find_hidden() {
        auto const count_of_splats = static_cast<int>(table.splat_count());
        auto const height = static_cast<unsigned>((count_of_splats + table_width - 1) / table_width);
        for (std::size_t i = 0; i < hidden.size(); ++i) {
            if (hidden[i].height() < std::max(static_cast<int>(height), 1)) {
                auto const rows_of_plane = static_cast<int>(std::bit_ceil(std::max(height, 1u)));
                hidden[i] = GlPlane(TexelFormat::number, table_width, rows_of_plane, count);
                hidden_targets[i] = GlTarget({&hidden[i]}, count);
            }
        }
        for (std::size_t pass = 0; pass < hidden_passes && count_of_splats > 0; ++pass) {
            hidden_pass.begin(hidden_targets[pass % 2],
                              {atlas.texture(), patches.texture(), entries.texture(), lists.texture(), splats.texture(),
                               blocks.texture(), hidden[(pass + 1) % 2].texture()},
                              true);
            glViewport(0, 0, table_width, static_cast<GLsizei>(height));
            hidden_pass.set("is_first", pass == 0 ? 1 : 0);
            hidden_pass.set("count", count_of_splats);
            hidden_pass.draw_all();
        }
    }

    void paint_blocks() {
        auto const count_of_blocks = static_cast<GLsizei>(table.block_count());
        paint_pass.begin(planes->painted,
                         {atlas.texture(), patches.texture(), entries.texture(), lists.texture(), splats.texture(),
                          blocks.texture(), hidden[1].texture()},
                         true);
        paint_pass.set("size", static_cast<float>(viewport.width), static_cast<float>(viewport.height));
        glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, count_of_blocks);
    }

    /// Uploads the colours of blocks in place: what is not to be moved has them in memory. Blocks beside each other go
    /// as one.
    void upload_in_place(CanvasJobs const& jobs) const {
        glBindTexture(GL_TEXTURE_2D, planes->colors.texture());
        glPixelStorei(GL_UNPACK_ROW_LENGTH, viewport.width);
        auto const is_uploaded = [](BlockJob const& job) { return job.is_painted && job.is_in_place; };
        for (RowJobs const& row : jobs.row_jobs) {
            for (auto first = row.blocks.begin(); first != row.blocks.end();) {
                auto last = first + 1;
                if (is_uploaded(*first)) {
                    while (last != row.blocks.end() && is_uploaded(*last) && last->column == (last - 1)->column + 1) {
                        ++last;
                    }
                    int const left = first->column * side;
                    int const top = first->row * side;
                    glTexSubImage2D(GL_TEXTURE_2D, 0, left, top,
                                    std::min(static_cast<int>(last - first) * side, viewport.width - left),
                                    std::min(side, viewport.height - top), GL_RGBA, GL_UNSIGNED_BYTE,
                                    jobs.in_place.row(top) + 4 * static_cast<std::size_t>(left));
                }
                first = last;
            }
        }
        glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
    }

    /// Begins to report what showed: the card writes that to a buffer while it goes on with the picture.
    void begin_report() {
        report_pass.begin(planes->reported, {planes->claims.texture(), planes->winners.texture()});
        report_pass.set("viewport", viewport.width, viewport.height);
        report_pass.draw_all();
        glBindBuffer(GL_PIXEL_PACK_BUFFER, planes->report_buffer.get());
        std::size_t offset = 0;
        for (GLenum const attachment : {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1}) {
            glReadBuffer(attachment);
            // OpenGL takes an offset into the buffer that is bound as a pointer.
            // NOLINTNEXTLINE(performance-no-int-to-ptr)
            glReadPixels(0, 0, columns, rows, GL_RGBA_INTEGER, GL_UNSIGNED_INT, reinterpret_cast<void*>(offset));
            offset += planes->report_words.size() / 2 * sizeof planes->report_words[0];
        }
        glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    }
    void end_report() {
        glBindBuffer(GL_PIXEL_PACK_BUFFER, planes->report_buffer.get());
        glGetBufferSubData(GL_PIXEL_PACK_BUFFER, 0,
                           static_cast<GLsizeiptr>(planes->report_words.size() * sizeof planes->report_words[0]),
                           planes->report_words.data());
        glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    }

    void filter(int contrast) const {
        filter_pass.begin(planes->filtered, {planes->colors.texture()});
        filter_pass.set("viewport", viewport.width, viewport.height);
        filter_pass.set("contrast", static_cast<float>(contrast));
        filter_pass.draw_all();
    }

    void note(CanvasJobs const& jobs, std::vector<BlockReport>& reports) const {
        reports.clear();
        for (RowJobs const& row : jobs.row_jobs) {
            for (BlockJob const& job : row.blocks) {
                ReportedBlock const block(planes->report_words,
                                          static_cast<std::size_t>(job.row * columns + job.column));
                block.note_shown(std::span(row.patches).subspan(job.first_patch, job.patches));
                reports.push_back(block.report());
            }
        }
    }
};

GpuCanvas::GpuCanvas() : impl_(std::make_unique<Impl>()) {
    begin(nullptr, true, {side, side}); // finds out whether the card can render to such textures
    impl_->owner = nullptr;
}

GpuCanvas::~GpuCanvas() = default;

bool GpuCanvas::begin(void const* owner, bool is_new, Viewport viewport) {
    Impl& canvas = *impl_;
    bool const has_other_size = viewport != canvas.viewport || !canvas.planes;
    if (!is_new && owner == canvas.owner && !has_other_size) {
        return false;
    }
    if (is_new || owner != std::exchange(canvas.owner, nullptr)) { // nobody's until all is there
        canvas.atlas.clear();
    }
    if (has_other_size) {
        canvas.set_size(viewport);
    }
    canvas.owner = owner;
    return true;
}

void GpuCanvas::paint(CanvasJobs const& jobs, std::vector<BlockReport>& reports) {
    Impl& canvas = *impl_;
    FRAMELET_CHECK(canvas.planes && jobs.viewport == canvas.viewport);
    bool const paints = std::ranges::any_of(jobs.row_jobs, [](RowJobs const& row) {
        return std::ranges::any_of(row.blocks, [](BlockJob const& job) { return job.is_painted; });
    });
    if (paints) {
        void const* const owner = std::exchange(canvas.owner, nullptr); // nobody's, if anything fails
        canvas.prepare_gl();
        canvas.upload(jobs);
        canvas.find_hidden();
        canvas.paint_blocks();
        canvas.upload_in_place(jobs);
        canvas.begin_report();
        canvas.far_passes.fill(canvas.planes->colors, canvas.planes->depths, canvas.planes->block_figures,
                               canvas.planes->filled);
        canvas.filter(jobs.flat_contrast);
        canvas.leave_gl();
        canvas.end_report();
        check_gl("painting a picture");
        canvas.owner = owner;
    }
    canvas.note(jobs, reports);
}

std::uint32_t GpuCanvas::texture() {
    impl_->is_asked_for = true;
    return impl_->planes ? impl_->planes->picture.texture() : 0;
}

Viewport GpuCanvas::size() const {
    return impl_->viewport;
}

void GpuCanvas::show() const {
    show_on_screen(impl_->planes->filtered);
}

void GpuCanvas::read(Picture& picture) const {
    Viewport const size = impl_->viewport;
    if (picture.width != size.width || picture.height != size.height) {
        picture = Picture(size.width, size.height);
    }
    glBindFramebuffer(GL_FRAMEBUFFER, impl_->planes->filtered.get());
    glReadBuffer(GL_COLOR_ATTACHMENT0);
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glReadPixels(0, 0, size.width, size.height, GL_RGBA, GL_UNSIGNED_BYTE, picture.rgba.data());
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

void GpuCanvas::read_inverse_depths(std::vector<float>& out) const {
    Viewport const size = impl_->viewport;
    out.resize(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height));
    glBindFramebuffer(GL_FRAMEBUFFER, impl_->planes->depths_alone.get());
    glReadBuffer(GL_COLOR_ATTACHMENT0);
    glReadPixels(0, 0, size.width, size.height, GL_RED, GL_FLOAT, out.data());
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

std::size_t GpuCanvas::made_objects() const {
    return impl_->count.made;
}

} // namespace framelet
