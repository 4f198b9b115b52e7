// Reads .stl files (3D Systems, StereoLithography Interface Specification), in text or binary, with the two ways in
// which programs keep colours of triangles.
#include <algorithm>
#include <array>
#include <bit>

#include "common/color.h"
#include "server/scene/mesh/mesh_import.h"
#include "server/scene/reading/text_lines.h"

namespace framelet {
namespace {

using Corner = PolygonSoup::Corner;

constexpr std::size_t header_bytes = 84, triangle_bytes = 50;

template <class T>
T read_at(std::string_view bytes, std::size_t at) {
    std::array<char, sizeof(T)> value{};
    bytes.copy(value.data(), sizeof(T), at);
    if constexpr (std::endian::native == std::endian::big) {
        std::reverse(value.begin(), value.end());
    }
    return std::bit_cast<T>(value);
}

struct StlReader {
    MeshReading& reading;
    PolygonSoup& soup = reading.soup;
    LineRemarks remarks{reading.name, reading.warnings};
    std::vector<glm::dvec3> points = {}; ///< of the facet

    /// False where the facet cannot be shown.
    bool add_facet(Vec3 const& normal, std::uint32_t color) {
        std::vector<Corner> corners;
        auto const first = static_cast<std::uint32_t>(soup.positions.size());
        auto const with_normal = static_cast<std::uint32_t>(soup.normals.size());
        soup.positions.insert(soup.positions.end(), points.begin(), points.end());
        bool is_usable = points.size() >= 3;
        for (std::uint32_t k = 0; k < points.size(); ++k) {
            corners.push_back({first + k, PolygonSoup::nothing, with_normal, color});
            is_usable = is_usable && soup.is_usable(first + k);
        }
        if (is_usable) {
            soup.normals.push_back(normal);
            soup.add_face(corners, none, PolygonSoup::by_angle);
        } else {
            soup.positions.resize(first);
        }
        return is_usable;
    }

    void read_text(std::string_view text) {
        TextLines lines(text);
        std::array<double, 3> normal{};
        std::size_t facet_line = 0; // 0: in none
        bool is_whole = true;
        auto const end_facet = [&] {
            if (facet_line != 0 && !(is_whole && add_facet({normal[0], normal[1], normal[2]}, PolygonSoup::nothing))) {
                remarks.add(facet_line, "a facet that cannot be read");
            }
            facet_line = 0;
        };
        for (std::string_view line; lines.next(line);) {
            std::string_view rest = line;
            std::string keyword(take_word(rest));
            std::ranges::transform(keyword, keyword.begin(),
                                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c | 32) : c; });
            if (keyword == "facet") {
                end_facet();
                facet_line = lines.number();
                is_whole = true;
                points.clear();
                take_word(rest); // "normal"
                normal = {};
                take_numbers(rest, normal);
            } else if (keyword == "vertex" && facet_line != 0) {
                std::array<double, 3> at{};
                is_whole = take_numbers(rest, at) == 3 && is_whole;
                points.emplace_back(at[0], at[1], at[2]);
            } else if (keyword == "endfacet") {
                end_facet();
            } else if (!keyword.empty() && keyword != "solid" && keyword != "endsolid" && keyword != "outer" &&
                       keyword != "endloop" && keyword != "color") {
                remarks.cannot_read(lines.number(), line);
            }
            if (lines.number() % 65536 == 0) {
                reading.tell(text.size() - lines.rest().size(), text.size());
            }
        }
        end_facet();
    }

    /// The colour of a triangle's two spare bytes, five bits each; `is_magics`: red is the lowest, and the highest bit
    /// says that the triangle has none.
    static Vec4 color_of(std::uint16_t bits, bool is_magics) {
        auto const part = [bits](int shift) { return linear_from_srgb(static_cast<float>(bits >> shift & 31) / 31); };
        return is_magics ? Vec4(part(0), part(5), part(10), 1) : Vec4(part(10), part(5), part(0), 1);
    }

    void read_binary(std::string_view bytes) {
        std::size_t const promised = read_at<std::uint32_t>(bytes, 80);
        std::size_t const there = std::min(promised, (bytes.size() - header_bytes) / triangle_bytes);
        if (there < promised) {
            reading.is_truncated = true;
            reading.warnings.push_back("the file ends after " + std::to_string(there) + " of " +
                                       std::to_string(promised) + " triangles");
        }
        std::size_t const magics = bytes.substr(0, 80).find("COLOR=");
        bool const is_magics = magics != bytes.npos && magics + 10 <= 80;
        Vec4 whole(1);
        for (std::size_t c = 0; is_magics && c < 3; ++c) {
            whole[static_cast<int>(c)] = linear_from_srgb_byte(read_at<std::uint8_t>(bytes, magics + 6 + c));
        }
        for (std::size_t i = 0; i < there; ++i) {
            std::size_t const at = header_bytes + i * triangle_bytes;
            std::array<float, 12> n{};
            for (std::size_t k = 0; k < n.size(); ++k) {
                n[k] = read_at<float>(bytes, at + 4 * k);
            }
            auto const bits = read_at<std::uint16_t>(bytes, at + 48);
            bool const is_colored = is_magics || (bits & 0x8000) != 0;
            bool const has_own = is_colored && ((bits & 0x8000) == 0) == is_magics;
            std::uint32_t color = PolygonSoup::nothing;
            if (is_colored) {
                color = static_cast<std::uint32_t>(soup.colors.size());
                soup.colors.push_back(has_own ? color_of(bits, is_magics) : whole);
            }
            points = {glm::dvec3(n[3], n[4], n[5]), glm::dvec3(n[6], n[7], n[8]), glm::dvec3(n[9], n[10], n[11])};
            if (!add_facet({n[0], n[1], n[2]}, color)) {
                remarks.add("triangle " + std::to_string(i + 1), "it has vertices that are no numbers");
            }
            if (i % 65536 == 65535) {
                reading.tell(at, bytes.size());
            }
        }
    }
};

/// Files of both kinds may begin with "solid"; the size that the count of a binary one asks for is no accident.
bool is_binary(std::string_view bytes) {
    if (bytes.size() < header_bytes) {
        return false;
    }
    bool const fits = bytes.size() == header_bytes + triangle_bytes * std::uint64_t(read_at<std::uint32_t>(bytes, 80));
    std::string_view begin = bytes.substr(0, header_bytes);
    std::string_view const word = take_word(begin);
    bool const is_text =
        (word == "solid" || word == "SOLID" || word == "facet") && bytes.substr(0, 4096).find('\0') == bytes.npos;
    return fits || !is_text;
}

} // namespace

void read_stl(std::string_view bytes, MeshReading& reading) {
    StlReader reader{reading};
    if (is_binary(bytes)) {
        reader.read_binary(bytes);
    } else {
        reader.read_text(bytes);
    }
}

} // namespace framelet
