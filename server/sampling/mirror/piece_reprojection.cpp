#include "server/sampling/mirror/piece_reprojection.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <glm/matrix.hpp>

#include "common/framelet/reprojection.h"
#include "common/framelet/sample_worth.h"

namespace framelet {
namespace {

/// The least depth in the picture over the depth where a piece was rendered; what is nearer is not drawn.
constexpr float nearest = 1e-3f;
constexpr float most_pixels = 1e6f, most_scale = 1e6f;
/// Pixels that a moved piece covers beyond each of its sides, or the gaps that turning and tilting leave between
/// neighbours would count as holes.
constexpr float margin = 0.5f;
/// Seconds of scene time until what is rendered next shows: until then a shadow must go on leading.
constexpr float renewal_seconds = 0.1f;
/// A plane whose area shrinks by more than this is seen edge-on.
constexpr float thinnest = 1e-4f;
/// Pixels of spacing by which samples seem to lie farther apart for each pixel that they are out of place.
constexpr float wear_of_way = 1;
constexpr float most_way = 1e4f; ///< pixels

BodyTransform make_body_transform(PieceReprojection const& reprojection, Motion const& motion, std::uint64_t stamp) {
    ViewRays const& source = reprojection.source;
    ViewRays const& display = reprojection.display.rays;
    ViewTransform const view = make_view_transform(source, display, motion);
    BodyTransform transform;
    transform.stamp = stamp;
    transform.far = Mat3(view.far);
    transform.parallax = Vec3(view.parallax);
    for (std::size_t axis = 0; axis < transform.carried.size(); ++axis) {
        glm::dvec3 metre(0);
        metre[static_cast<int>(axis)] = 1;
        ViewTransform const carried = make_view_transform(source, display, motion, metre);
        transform.carried[axis] = Vec3(carried.parallax - view.parallax);
    }
    transform.is_still = same_camera(source, display) && motion == Motion{};
    transform.lens = static_cast<float>(std::sqrt(std::abs(glm::determinant(view.far))));
    return transform;
}

/// Transform of the body of a piece, from the scene time of the piece.
BodyTransform const& transform_of(PieceReprojection const& reprojection, Piece const& piece,
                                  BodyTransforms& transforms) {
    if (transforms.of_body.size() <= piece.body) {
        transforms.of_body.resize(std::size_t{piece.body} + 1);
    }
    BodyTransform& transform = transforms.of_body[piece.body];
    if (transform.stamp != transforms.stamp) {
        SceneTime const to = reprojection.display.scene_time;
        Motion const motion =
            piece.body == static_body ? Motion{} : reprojection.motions->between(piece.body, piece.scene_time, to);
        transform = make_body_transform(reprojection, motion, transforms.stamp);
    }
    return transform;
}

/// The picture that a piece is taken to.
struct Display {
    Vec2 size{0}; ///< pixels
    float source_focal = 1, focal = 1; ///< focal lengths, pixels, of the piece's camera and of the picture's
};

/// Takes one piece to the picture. `age`: of the piece in it, seconds of scene time.
ReprojectedPiece reproject(Piece const& piece, BodyTransform const& body, Display const& display, float age) {
    Vec2 const size = display.size;
    Vec3 parallax = body.parallax;
    bool is_lost = false;
    if (piece.drift.any()) {
        float const followed = followed_seconds(piece.drift.jerk, piece.inverse_depth * display.source_focal);
        is_lost = std::abs(age) > followed;
        Vec3 const drift = is_lost ? Vec3(0) : piece.drift.after(age);
        parallax += drift.x * body.carried[0] + drift.y * body.carried[1] + drift.z * body.carried[2];
    }
    Vec3 const at = body.far * Vec3(piece.centre, 1) + piece.inverse_depth * parallax;
    if (!(at.z > nearest)) {
        return {};
    }
    ReprojectedPiece reprojected;
    float const share = 1 / at.z;
    reprojected.at = share * Vec2(at);
    // `right` and `down` say how far it moves for each pixel to the right and down in the picture of its moment.
    Vec3 const dx = body.far[0] + piece.depth_slope.x * parallax;
    Vec3 const dy = body.far[1] + piece.depth_slope.y * parallax;
    Vec2 const right = share * (Vec2(dx) - dx.z * reprojected.at);
    Vec2 const down = share * (Vec2(dy) - dy.z * reprojected.at);
    float const area = right.x * down.y - right.y * down.x;
    reprojected.scale = std::clamp(body.lens * share, 1 / most_scale, most_scale);
    reprojected.half_side =
        glm::min(piece.half_side.x * glm::abs(right) + piece.half_side.y * glm::abs(down) + margin, Vec2(most_pixels));
    Vec2 const low = reprojected.at - reprojected.half_side;
    Vec2 const high = reprojected.at + reprojected.half_side;
    if (!(area > thinnest * reprojected.scale * reprojected.scale && low.x < size.x && low.y < size.y && high.x > 0 &&
          high.y > 0 && low.x > -most_pixels && low.y > -most_pixels && high.x < most_pixels && high.y < most_pixels)) {
        return {};
    }
    float const tolerance = share * piece.error;
    float spacing = piece.spacing;
    float misplaced = 0;
    reprojected.is_lost = is_lost;
    reprojected.is_still = body.is_still && !piece.drift.any();
    if (!piece.is_outlier) { // as the viewer rates them
        float const squares = glm::dot(right, right) + glm::dot(down, down);
        spacing *= std::sqrt(0.5f * (squares + std::sqrt(std::max(squares * squares - 4 * area * area, 0.0f))));
        misplaced = reprojected.is_still ? 0 : tolerance * glm::length(Vec2(parallax) - parallax.z * reprojected.at);
        if (!hides(spacing, misplaced) ||
            is_adrift(piece.body, piece.drift, std::abs(age) + renewal_seconds)) { // it shows where nothing does
            return {};
        }
    } else {
        spacing *= std::max(reprojected.scale, 1.0f);
    }
    reprojected.inverse_depth = share * piece.inverse_depth;
    Vec2 const slope = share * (piece.depth_slope - reprojected.inverse_depth * Vec2(dx.z, dy.z)); // along its own axes
    reprojected.depth_slope = Vec2(down.y * slope.x - right.y * slope.y, right.x * slope.y - down.x * slope.x) / area;
    reprojected.tolerance = tolerance;
    reprojected.leads = leads(piece.body, piece.drift, std::abs(age) + renewal_seconds) && !piece.is_outlier;
    float const rate = reprojected.is_still ? 0 : piece.decorrelation;
    misplaced += straying(piece.drift.jerk, reprojected.inverse_depth * display.focal, age);
    reprojected.worn = worn_step(worn_spacing(spacing, age, rate) + misplaced);
    return reprojected;
}

/// The pixel at which a camera sees a point; nothing where that is behind it.
std::optional<Vec2> pixel_of(ViewRays const& rays, Vec3 point) {
    bool const perspective = rays.direction_dx != Vec3(0);
    Vec3 const dx = perspective ? rays.direction_dx : rays.origin_dx;
    Vec3 const dy = perspective ? rays.direction_dy : rays.origin_dy;
    Vec3 from = point - rays.origin;
    if (perspective) {
        Vec3 const normal = glm::cross(dx, dy);
        float const depth = glm::dot(from, normal) / glm::dot(rays.direction, normal);
        if (!(depth > 0)) {
            return std::nullopt;
        }
        from = from / depth - rays.direction;
    }
    Vec2 const pixel(glm::dot(from, dx) / glm::dot(dx, dx), glm::dot(from, dy) / glm::dot(dy, dy));
    return std::isfinite(pixel.x) && std::isfinite(pixel.y) ? std::optional(pixel) : std::nullopt;
}

/// Leaves one piece where it was rendered, as a viewer does that moves nothing, and finds how far what it shows has
/// gone. `stands`: the camera of both pictures is the same.
ReprojectedPiece leave(Piece const& piece, PieceReprojection const& reprojection, bool stands) {
    constexpr float least_inverse_depth = 1e-6f; // 1 / metres; what is farther is taken to be there
    SceneTime const to = reprojection.display.scene_time;
    auto const age = static_cast<float>(to - piece.scene_time);
    Motion const motion =
        piece.body == static_body ? Motion{} : reprojection.motions->between(piece.body, piece.scene_time, to);
    ReprojectedPiece left;
    left.at = piece.centre;
    left.half_side = piece.half_side;
    left.inverse_depth = piece.inverse_depth;
    left.is_still = stands && motion == Motion{} && !piece.drift.any();
    if (!left.is_still) {
        ViewRays const& rays = reprojection.source;
        float const depth = 1 / std::max(piece.inverse_depth, least_inverse_depth);
        Vec2 const at = piece.centre;
        Vec3 const seen = rays.origin + at.x * rays.origin_dx + at.y * rays.origin_dy +
                          depth * (rays.direction + at.x * rays.direction_dx + at.y * rays.direction_dy);
        Vec3 const now = Vec3(motion.linear * glm::dvec3(seen) + motion.offset) + piece.drift.after(age);
        auto const gone = pixel_of(reprojection.display.rays, now);
        left.way = gone ? glm::clamp(*gone - at, Vec2(-most_way), Vec2(most_way)) : Vec2(most_way);
    }
    float const rate = left.is_still ? 0 : piece.decorrelation;
    left.worn = worn_step(worn_spacing(piece.spacing, age, rate) + wear_of_way * glm::length(left.way));
    return left;
}

} // namespace

bool same_camera(ViewRays const& a, ViewRays const& b) {
    return a.origin == b.origin && a.origin_dx == b.origin_dx && a.origin_dy == b.origin_dy &&
           a.direction == b.direction && a.direction_dx == b.direction_dx && a.direction_dy == b.direction_dy;
}

void reproject(PieceReprojection const& reprojection, std::span<Piece const> pieces, bool with_outliers,
               BodyTransforms& transforms, std::span<ReprojectedPiece> reprojected) {
    ++transforms.stamp;
    TimeSpan const valid = reprojection.motions->between_jumps(reprojection.display.scene_time);
    bool const stands = same_camera(reprojection.source, reprojection.display.rays);
    auto const focal = [](ViewRays const& rays) { return 1 / glm::length(rays.direction_dx); };
    Display const display{reprojection.display_size, focal(reprojection.source), focal(reprojection.display.rays)};
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        Piece const& piece = pieces[i];
        if (i > 0 && piece.scene_time != pieces[i - 1].scene_time) {
            ++transforms.stamp; // bodies were elsewhere
        }
        auto const age = static_cast<float>(reprojection.display.scene_time - piece.scene_time);
        if (!reprojection.moves_samples) {
            reprojected[i] = leave(piece, reprojection, stands);
        } else if (with_outliers || !piece.is_outlier) {
            reprojected[i] = reproject(piece, transform_of(reprojection, piece, transforms), display, age);
        } else {
            reprojected[i] = {};
        }
        reprojected[i].is_outdated = !valid.contains(piece.scene_time);
    }
}

} // namespace framelet
