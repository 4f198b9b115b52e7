#include "server/sampling/plan/moment/moment_refresh.h"

#include <algorithm>

#include <tbb/parallel_for.h>

#include "common/error.h"
#include "common/marked_indices.h"
#include "server/sampling/mirror/mirror_checks.h"
#include "server/sampling/plan/moment/decorrelation.h"

namespace framelet {
namespace {

/// Spacing, pixels, of the finest grid whose positions cost no more than so many samples at `cost` each: `least` times
/// a power of two, at most `most`.
int grid_spacing(Viewport viewport, int least, int most, double cost, double samples) {
    int spacing = least;
    auto const positions = [&] { return (viewport.width / spacing) * (viewport.height / spacing); };
    while (spacing < most && cost * positions() > samples) {
        spacing *= 2;
    }
    return spacing;
}

MirrorView view_of(RenderedMoment const& moment) {
    return {moment.rays, moment.scene_time};
}

} // namespace

double MomentChecks::cost(Viewport viewport) const {
    return visibility ? visibility_cost * visibility->columns(viewport) * visibility->rows(viewport) : 0;
}

MomentChecks MomentRefresh::look(RenderedMoment const& moment, double begun, double visibility_samples,
                                 double probe_samples, std::vector<Probe>& probes) {
    constexpr int most_visibility_spacing = 16, least_probe_spacing = 16, most_probe_spacing = 64;
    Viewport const viewport = mirror_.viewport();
    looked_ = begun;
    ++looks_taken_;
    mirror_.look(view_of(moment), *moment.motions, moment.moves_samples);
    MomentChecks checks;
    if (visibility_samples > 0) {
        checks.visibility = cell_grid(
            cell_side, grid_spacing(viewport, cell_side, most_visibility_spacing, visibility_cost, visibility_samples),
            looks_taken_);
    }
    if (probe_samples > 0) {
        checks.probe_spacing =
            grid_spacing(viewport, least_probe_spacing, most_probe_spacing, probe_cost, probe_samples);
        list_probes(mirror_, cell_grid(cell_side, checks.probe_spacing, looks_taken_), moment.light_changes, probes);
    }
    return checks;
}

void MomentRefresh::plan(RegionGrid const& regions, MomentBudget const& budget, std::vector<RatedPatch>& rated) {
    is_checked_ = false;
    plan_.find(mirror_, regions, budget, rated);
}

void MomentRefresh::note_visibility(RenderedMoment const& moment, RayGrid const& grid,
                                    std::span<float const> inverse_depth) {
    if (mirror_.looks_at(view_of(moment))) {
        is_checked_ = mirror_.mark(find_wrong(mirror_, grid, inverse_depth)) || is_checked_;
    }
}

void MomentRefresh::note_looks(RenderedMoment const& moment, std::span<Probe const> probes, ProbeLooks const& looks,
                               int probe_spacing) {
    if (mirror_.looks_at(view_of(moment))) {
        is_checked_ = mirror_.mark(find_stale(mirror_, probes, looks, probe_spacing)) || is_checked_;
    }
}

void MomentRefresh::note_sent(RenderedMoment const& moment, std::uint64_t batch,
                              std::span<DisplayFramelet const> framelets, std::span<Framelet const> rendered,
                              std::span<std::uint8_t const> sent, std::span<FrameletShape> shapes,
                              bool expects_change) {
    FRAMELET_CHECK(framelets.size() == sent.size() && rendered.size() == sent.size());
    constexpr std::size_t at_once = 64; // framelets
    list_marked(sent, sent_);
    FRAMELET_CHECK(shapes.size() == sent_.size());
    ImagePlane const plane(mirror_.viewport());
    std::size_t const lists = (sent_.size() + at_once - 1) / at_once;
    pieces_.resize(std::max(pieces_.size(), lists));
    tbb::parallel_for(std::size_t{0}, lists, [&](std::size_t list) {
        pieces_[list].clear();
        for (std::size_t k = list * at_once; k < std::min((list + 1) * at_once, sent_.size()); ++k) {
            FrameletShape& shape = shapes[k];
            std::size_t const first = pieces_[list].size();
            cut_pieces(rendered[sent_[k]], framelets[sent_[k]], shape, plane, moment.scene_time, batch, pieces_[list]);
            std::span<Piece> const pieces = std::span(pieces_[list]).subspan(first);
            bool const rests = is_at_rest(shape, moment.scene_time, *moment.motions);
            std::ranges::for_each(pieces, [&](Piece& piece) {
                piece.rests = rests;
                piece.is_outlier = piece.is_outlier && moment.moves_samples; // else all are alike
            });
            bool const has_outline = shape.layer_count > 1 || !shape.outliers.empty();
            shape.decorrelation = expects_change ? expect_decorrelation(pieces, mirror_.camera_stands(), has_outline)
                                                 : DecorrelationCode{0};
        }
    });
    mirror_.add(moment.rays, *moment.motions, std::span(pieces_).first(lists));
}

} // namespace framelet
