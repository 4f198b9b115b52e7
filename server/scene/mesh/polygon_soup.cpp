#include "server/scene/mesh/polygon_soup.h"

#include <algorithm>
#include <bit>
#include <map>
#include <numeric>
#include <tuple>

#include <glm/geometric.hpp>
#include <tbb/parallel_sort.h>

#include "common/counted.h"
#include "common/error.h"
#include "server/scene/assimp/polygon.h"
#include "server/scene/finish/finish_parts.h"
#include "server/scene/finish/scene_origin.h"
#include "server/scene/vector_math.h"

namespace framelet {
namespace {

/// Bytes that a corner takes at most while it becomes part of a triangle and of a vertex.
constexpr std::uint64_t bytes_of_corner = 120;
/// Cosine of the angle up to which edges are smooth where the file does not say: 66 degrees.
constexpr float crease_cosine = 0.4067366f;
/// Cosine of the angle from which on a face of the same group is taken for one that is wound the other way.
constexpr float backwards_cosine = -0.5f;
/// Corners that meet in one point beyond this number are flat: smoothing by angle takes the square of it.
constexpr std::size_t most_smoothed = 1024;

struct Vertices {
    PolygonSoup const& soup;
    glm::dvec3 centre;
    std::vector<Vec3> points; ///< positions about the centre
    std::vector<std::uint32_t> place; ///< for each position the first one at the same point
    std::vector<Vec3> normals; ///< one a corner

    std::span<PolygonSoup::Corner const> corners_of(std::size_t face) const {
        std::size_t const first = soup.faces[face].first;
        std::size_t const end = face + 1 < soup.faces.size() ? soup.faces[face + 1].first : soup.corners.size();
        return std::span(soup.corners).subspan(first, end - first);
    }
};

glm::dvec3 centre_of(PolygonSoup const& soup) {
    glm::dvec3 lower(INFINITY), upper(-INFINITY);
    for (PolygonSoup::Corner const& corner : soup.corners) {
        lower = glm::min(lower, soup.positions[corner.position]);
        upper = glm::max(upper, soup.positions[corner.position]);
    }
    return round_centre(lower, upper);
}

/// Finds which positions are at one point: files for printers name each corner of each triangle anew.
std::vector<std::uint32_t> find_places(std::vector<glm::dvec3> const& positions) {
    auto const key = [&](std::uint32_t i) {
        glm::dvec3 const& p = positions[i];
        return std::tuple(std::bit_cast<std::uint64_t>(p.x + 0.0), std::bit_cast<std::uint64_t>(p.y + 0.0),
                          std::bit_cast<std::uint64_t>(p.z + 0.0));
    };
    std::vector<std::uint32_t> order(positions.size());
    std::iota(order.begin(), order.end(), 0u);
    tbb::parallel_sort(order.begin(), order.end(),
                       [&](std::uint32_t a, std::uint32_t b) { return std::tuple(key(a), a) < std::tuple(key(b), b); });
    std::vector<std::uint32_t> places(positions.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        bool const is_same = i > 0 && key(order[i]) == key(order[i - 1]);
        places[order[i]] = is_same ? places[order[i - 1]] : order[i];
    }
    return places;
}

/// Unit normal of a polygon, flat or not: the mean over its area. 0 where it has none.
Vec3 face_normal(Vertices const& v, std::span<PolygonSoup::Corner const> corners) {
    Vec3 sum(0);
    Vec3 const origin = v.points[corners[0].position];
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
        sum += glm::cross(v.points[corners[i].position] - origin, v.points[corners[i + 1].position] - origin);
    }
    return unit_or(sum, Vec3(0));
}

/// What makes a corner smooth: the faces that meet in it.
struct Meeting {
    std::vector<std::uint32_t> first_of; ///< by place, of `corners`; one more for the end
    std::vector<std::uint32_t> corners;
    std::vector<std::uint32_t> face; ///< of each corner
    std::vector<Vec3> weighted; ///< of each corner: the face's normal times its angle there
};

Meeting find_meetings(Vertices const& v, std::vector<Vec3> const& face_normals) {
    Meeting out;
    std::vector<PolygonSoup::Corner> const& corners = v.soup.corners;
    out.first_of.resize(v.soup.positions.size() + 1);
    for (PolygonSoup::Corner const& corner : corners) {
        ++out.first_of[v.place[corner.position] + std::size_t(1)];
    }
    std::partial_sum(out.first_of.begin(), out.first_of.end(), out.first_of.begin());
    std::vector<std::uint32_t> next = out.first_of;
    out.corners.resize(corners.size());
    for (std::size_t c = 0; c < corners.size(); ++c) {
        out.corners[next[v.place[corners[c].position]]++] = static_cast<std::uint32_t>(c);
    }
    for (std::size_t f = 0; f < v.soup.faces.size(); ++f) {
        auto const of = v.corners_of(f);
        for (std::size_t i = 0; i < of.size(); ++i) {
            auto const at = [&](std::size_t k) { return v.points[of[k % of.size()].position]; };
            out.face.push_back(static_cast<std::uint32_t>(f));
            out.weighted.push_back(face_normals[f] * corner_angle(at(i), at(i + 1), at(i + of.size() - 1)));
        }
    }
    return out;
}

/// The file's normal of each corner where it can be used, else one of its own.
void make_normals(Vertices& v, Progress const& progress) {
    std::vector<PolygonSoup::Corner> const& corners = v.soup.corners;
    std::vector<PolygonSoup::Face> const& faces = v.soup.faces;
    auto const own = [&](PolygonSoup::Corner const& corner) {
        Vec3 const normal = corner.normal == PolygonSoup::nothing ? Vec3(0) : v.soup.normals[corner.normal];
        return is_finite(normal) ? unit_or(normal, Vec3(0)) : Vec3(0);
    };
    v.normals.reserve(corners.size());
    std::transform(corners.begin(), corners.end(), std::back_inserter(v.normals), own);
    if (std::ranges::find(v.normals, Vec3(0)) == v.normals.end()) {
        return;
    }
    std::vector<Vec3> face_normals;
    for (std::size_t f = 0; f < faces.size(); ++f) {
        face_normals.push_back(face_normal(v, v.corners_of(f)));
    }
    Meeting const meeting = find_meetings(v, face_normals);
    for (std::size_t c = 0; c < corners.size(); ++c) {
        if (v.normals[c] != Vec3(0)) {
            continue;
        }
        if (c % 65536 == 0) {
            progress("smoothing normals", static_cast<double>(c) / static_cast<double>(corners.size()));
        }
        std::uint32_t const face = meeting.face[c];
        std::uint32_t const smoothing = faces[face].smoothing;
        std::size_t const place = v.place[corners[c].position];
        std::span const around =
            std::span(meeting.corners)
                .subspan(meeting.first_of[place], meeting.first_of[place + 1] - meeting.first_of[place]);
        Vec3 sum(0);
        if (smoothing != 0 && around.size() <= most_smoothed) {
            for (std::uint32_t const other : around) {
                float const cosine = glm::dot(face_normals[meeting.face[other]], face_normals[face]);
                bool const is_smooth =
                    smoothing == PolygonSoup::by_angle
                        ? cosine >= crease_cosine
                        : cosine >= backwards_cosine && faces[meeting.face[other]].smoothing == smoothing;
                sum += is_smooth ? meeting.weighted[other] : Vec3(0);
            }
        }
        v.normals[c] = unit_or(sum, face_normals[face] == Vec3(0) ? Vec3(0, 1, 0) : face_normals[face]);
    }
    progress("smoothing normals", 1);
}

/// Makes one vertex of corners that are alike, and puts these into the primitive.
void join(Vertices const& v, std::vector<std::uint32_t> const& corners, Primitive& primitive) {
    auto const key = [&](std::uint32_t c) {
        PolygonSoup::Corner const& corner = v.soup.corners[c];
        Vec3 const& n = v.normals[c];
        return std::tuple(v.place[corner.position], corner.uv, corner.color, n.x, n.y, n.z);
    };
    std::vector<std::uint32_t> order(corners.size()); // of `corners`
    std::iota(order.begin(), order.end(), 0u);
    tbb::parallel_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return std::tuple(key(corners[a]), a) < std::tuple(key(corners[b]), b);
    });
    auto const any = [&](auto member) {
        return std::ranges::any_of(corners,
                                   [&](std::uint32_t c) { return v.soup.corners[c].*member != PolygonSoup::nothing; });
    };
    bool const has_uv = any(&PolygonSoup::Corner::uv), has_color = any(&PolygonSoup::Corner::color);
    primitive.triangles.resize(corners.size() / 3);
    for (std::size_t i = 0; i < order.size(); ++i) {
        std::uint32_t const c = corners[order[i]];
        if (i == 0 || key(c) != key(corners[order[i - 1]])) {
            PolygonSoup::Corner const& corner = v.soup.corners[c];
            primitive.positions.push_back(v.points[corner.position]);
            primitive.normals.push_back(v.normals[c]);
            if (has_uv) {
                Vec2 const uv = corner.uv == PolygonSoup::nothing ? Vec2(0, 1) : v.soup.uvs[corner.uv];
                primitive.uv[0].emplace_back(uv.x, 1 - uv.y);
            }
            if (has_color) {
                primitive.colors.push_back(corner.color == PolygonSoup::nothing ? Vec4(1)
                                                                                : v.soup.colors[corner.color]);
            }
        }
        primitive.triangles[order[i] / 3][order[i] % 3] = static_cast<std::uint32_t>(primitive.positions.size() - 1);
    }
}

/// For each material the corners of its triangles.
std::map<Index, std::vector<std::uint32_t>> triangles_of(Vertices const& v, Progress const& progress) {
    std::map<Index, std::vector<std::uint32_t>> out;
    std::vector<Vec3> polygon;
    std::vector<PolygonSoup::Face> const& faces = v.soup.faces;
    for (std::size_t f = 0; f < faces.size(); ++f) {
        if (f % 65536 == 0) {
            progress("triangulating", static_cast<double>(f) / static_cast<double>(faces.size()));
        }
        std::vector<std::uint32_t>& corners = out[faces[f].material];
        auto const of = v.corners_of(f);
        polygon.clear();
        for (PolygonSoup::Corner const& corner : of) {
            polygon.push_back(v.points[corner.position]);
        }
        for (auto const& triangle : triangulate(polygon)) {
            for (std::uint32_t const corner : triangle) {
                corners.push_back(faces[f].first + corner);
            }
        }
    }
    progress("triangulating", 1);
    return out;
}

} // namespace

bool PolygonSoup::is_usable(std::uint32_t position) const {
    if (position >= positions.size()) {
        return false;
    }
    glm::dvec3 const& p = positions[position];
    return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) <= static_cast<double>(max_coordinate) &&
           !std::isnan(p.x + p.y + p.z);
}

void add_soup(PolygonSoup&& soup, std::string const& name, ImportBudget& budget, Scene& scene,
              Progress const& progress) {
    std::string left_out;
    for (auto const& [count, what] :
         {std::pair(soup.points, "point"), std::pair(soup.lines, "line"), std::pair(soup.curves, "curved surface")}) {
        if (count > 0) {
            left_out = counted(count, what) + (count == 1 ? " is" : " are") + " not shown: only surfaces are";
            scene.warnings.push_back(left_out);
        }
    }
    if (soup.faces.empty()) {
        throw InputError("it has no surfaces, and only these are shown" +
                         (scene.warnings.empty() ? "" : " (" + scene.warnings.front() + ")"));
    }
    budget.reserve(soup.corners.size(), bytes_of_corner);
    Vertices v{soup, centre_of(soup), {}, find_places(soup.positions), {}};
    v.points.reserve(soup.positions.size());
    for (glm::dvec3 const& position : soup.positions) {
        v.points.emplace_back(position - v.centre);
    }
    auto const triangles = triangles_of(v, progress);
    make_normals(v, progress);
    progress("joining vertices", 0);
    Mesh mesh;
    mesh.name = name;
    for (auto const& [material, corners] : triangles) {
        Primitive primitive;
        primitive.material = material;
        join(v, corners, primitive);
        mesh.primitives.push_back(std::move(primitive));
    }
    progress("joining vertices", 1);
    Node node;
    node.name = name;
    node.local.translation = v.centre;
    node.mesh = static_cast<Index>(scene.meshes.size());
    scene.meshes.push_back(std::move(mesh));
    scene.nodes.push_back(std::move(node));
}

} // namespace framelet
