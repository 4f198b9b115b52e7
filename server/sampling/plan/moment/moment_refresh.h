// Finds what of a moment is worth rendering for a viewer. In: moments, what was rendered and sent of them, what the
// viewer evicted. Out: patches, and where to check what the viewer shows.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "server/render/probe.h"
#include "server/render/ray_grid.h"
#include "server/sampling/mirror/mirror.h"
#include "server/sampling/plan/moment/moment_plan.h"

namespace framelet {

/// Costs, in samples, of a visibility ray, which is not shaded, and of a probe, which is traced together with none of
/// its neighbours.
inline constexpr double visibility_cost = 0.25, probe_cost = 2;

/// The moment at which framelets are rendered, and how its viewer shows another one.
struct RenderedMoment {
    ViewRays rays{};
    SceneTime scene_time = 0;
    BodyMotions const* motions = nullptr; ///< of bodies, as the viewer knows them or would; not null
    bool moves_samples = true; ///< the viewer moves what it holds, from and to perspective cameras
    bool light_changes = false; ///< also that of what stands: more is learnt of it
};

/// Positions at which what a moment really shows is compared with what the viewer would show of it.
struct MomentChecks {
    std::optional<RayGrid> visibility; ///< none: nowhere
    int probe_spacing = 0; ///< pixels from one probe to the next; 0: none

    /// Cost of the visibility rays, in samples.
    double cost(Viewport viewport) const;
};

class MomentRefresh {
public:
    explicit MomentRefresh(Viewport viewport = {}) : mirror_(viewport) {}

    Mirror const& mirror() const { return mirror_; }
    /// False when another moment has begun, or more is known of this one than when a plan was found last. Moments are
    /// told by when they began, seconds.
    bool is_planned(double moment_begun) const { return looked_ == moment_begun && !is_checked_; }
    /// True while the mirror looks at the moment that began then.
    bool looks_at(double moment_begun) const { return looked_ == moment_begun; }

    /// Finds what the viewer shows of a moment that begins, and where that is to be checked, by rays and by probes, for
    /// about so many samples each (0: not at all). Appends to `probes`.
    MomentChecks look(RenderedMoment const& moment, double begun, double visibility_samples, double probe_samples,
                      std::vector<Probe>& probes);
    /// Replaces `rated` by where what the viewer holds shows the moment worst: see `MomentPlan`.
    void plan(RegionGrid const& regions, MomentBudget const& budget, std::vector<RatedPatch>& rated);

    /// Takes in what checks of a moment have shown: inverse depths at the positions of their grid, 1 / metres, row by
    /// row (< 0: not known), or looks of the probes. Ignored where another moment is looked at by now.
    void note_visibility(RenderedMoment const& moment, RayGrid const& grid, std::span<float const> inverse_depth);
    void note_looks(RenderedMoment const& moment, std::span<Probe const> probes, ProbeLooks const& looks,
                    int probe_spacing);

    /// Notes that the viewer gets those framelets for which `sent` is not 0, in a batch of this number, with these
    /// shapes, in order; sets how soon what they show fades, unless nothing is expected to change.
    void note_sent(RenderedMoment const& moment, std::uint64_t batch, std::span<DisplayFramelet const> framelets,
                   std::span<Framelet const> rendered, std::span<std::uint8_t const> sent,
                   std::span<FrameletShape> shapes, bool expects_change);
    /// Notes that the viewer no longer holds these.
    void forget(std::span<SentTile const> framelets) { mirror_.forget(framelets); }
    /// Notes that the viewer is told that it holds all of the picture.
    void settle() { mirror_.settle(); }

private:
    Mirror mirror_;
    MomentPlan plan_;
    double looked_ = never; ///< when the moment began at which the mirror looks, seconds
    std::uint32_t looks_taken_ = 0;
    bool is_checked_ = false; ///< more is known of the moment than when it was planned
    std::vector<std::size_t> sent_; ///< scratch: indices of what was sent
    std::vector<std::vector<Piece>> pieces_; ///< scratch: of some framelets each, in order
};

} // namespace framelet
