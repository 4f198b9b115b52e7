#include "server/sampling/plan/moment/decorrelation.h"

#include "server/sampling/plan/moment/moment_plan.h"

namespace framelet {
namespace {

/// Change of all that is expected to change, mean squared luma a second: it is hardly seen to, since detail hides it.
constexpr float expected_change = 0.005f;

} // namespace

DecorrelationCode expect_decorrelation(std::span<Piece> pieces, bool camera_stands, bool has_outline) {
    float changing = 0, detail = 0;
    for (Piece const& piece : pieces) {
        bool const turns = piece.body != static_body && !piece.rests;
        bool const depends_on_camera = !camera_stands && (piece.reflects || has_outline);
        float const area = 4 * piece.half_side.x * piece.half_side.y;
        changing += turns || depends_on_camera ? area : 0;
        detail += area * piece.detail;
    }
    // Per pixel of spacing, error grows by about so much of the detail.
    DecorrelationCode const code =
        decorrelation_code(detail > 0 ? expected_change * changing / (detail * error_growth) : 0);
    for (Piece& piece : pieces) {
        piece.decorrelation = decorrelation_rate(code);
    }
    return code;
}

} // namespace framelet
