#include "server/sampling/plan/moment/decorrelation.h"

#include <algorithm>

#include "server/sampling/plan/moment/moment_plan.h"

namespace framelet {
namespace {

/// Change of all that is expected to change, mean squared luma a second: it is hardly seen to, since detail hides it.
constexpr float expected_change = 0.005f;
/// Bounds of the rate of what is carried, pixels a second: framelets of one surface that show different detail must not
/// wear at rates so different that old samples last longer than new ones. Of the rest there is an upper bound alone.
constexpr float least_carried = 1, most_carried = 3, most_standing = 4;

} // namespace

DecorrelationCode expect_decorrelation(std::span<Piece> pieces, bool camera_stands, bool has_outline) {
    float changing = 0, detail = 0, all = 0;
    bool carried = false;
    for (Piece const& piece : pieces) {
        float const area = 4 * piece.half_side.x * piece.half_side.y;
        carried |= piece.body != static_body;
        changing += !camera_stands && (piece.reflects || has_outline) ? area : 0;
        detail += area * piece.detail;
        all += area;
    }
    // Per pixel of spacing, error grows by about so much of the detail.
    auto const rate_of = [&](float area) { return expected_change * area / (detail * error_growth); };
    float rate = 0;
    if (detail > 0) {
        rate = carried ? std::clamp(rate_of(all), least_carried, most_carried)
                       : std::min(rate_of(changing), most_standing);
    }
    DecorrelationCode const code = decorrelation_code(rate);
    for (Piece& piece : pieces) {
        piece.decorrelation = decorrelation_rate(code);
    }
    return code;
}

} // namespace framelet
