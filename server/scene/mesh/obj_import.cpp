// Reads .obj files (Wavefront, Advanced Visualizer 3.0, appendix B1): polygons with their materials.
#include <algorithm>
#include <array>
#include <set>

#include "common/color.h"
#include "common/error.h"
#include "server/scene/mesh/mesh_import.h"
#include "server/scene/mesh/mtl_text.h"
#include "server/scene/reading/file_bytes.h"
#include "server/scene/reading/named_file.h"
#include "server/scene/reading/text_lines.h"

namespace framelet {
namespace {

using Corner = PolygonSoup::Corner;

/// Statements of which nothing is made.
std::set<std::string_view> const unused_statements = {
    "g",    "o",        "mg",        "vp",    "deg",   "bmat",    "step",   "cstype", "parm",
    "trim", "hole",     "scrv",      "sp",    "end",   "con",     "bevel",  "lod",    "c_interp",
    "res",  "d_interp", "trace_obj", "ctech", "stech", "maplib",  "usemap", "call",   "shadow_obj",
    "csh",  "bsp",      "bzp",       "cdc",   "cdp",   "surf_in", "ct"};

struct ObjReader {
    MeshReading& reading;
    PolygonSoup& soup = reading.soup;
    LineRemarks remarks{reading.name, reading.warnings};
    std::vector<std::size_t> line_of_face = {};
    std::vector<std::string> libraries = {}; ///< named by `mtllib`
    std::map<std::string, Index, std::less<>> index_of_material = {}; ///< those that are used
    Index material = none;
    std::uint32_t smoothing = PolygonSoup::by_angle;
    float brightest = 1; ///< of the colours of vertices
    std::vector<Corner> corners = {}; ///< scratch

    bool read_vertex(std::string_view rest) {
        std::array<double, 7> n{};
        std::size_t const count = take_numbers(rest, n);
        soup.positions.emplace_back(count < 3 ? glm::dvec3(NAN) : glm::dvec3(n[0], n[1], n[2]));
        if (count >= 6) { // as many programs write them
            soup.colors.resize(soup.positions.size(), Vec4(INFINITY)); // white
            soup.colors.back() = Vec4(n[3], n[4], n[5], 1);
            brightest = std::max({brightest, soup.colors.back().x, soup.colors.back().y, soup.colors.back().z});
        }
        return count >= 3 && soup.is_usable(static_cast<std::uint32_t>(soup.positions.size() - 1));
    }

    bool read_uv(std::string_view rest) {
        std::array<double, 3> n{};
        std::size_t const count = take_numbers(rest, n);
        soup.uvs.emplace_back(n[0], n[1]);
        return count > 0;
    }

    bool read_normal(std::string_view rest) {
        std::array<double, 3> n{};
        std::size_t const count = take_numbers(rest, n);
        soup.normals.emplace_back(count < 3 ? Vec3(0) : Vec3(n[0], n[1], n[2]));
        return count == 3;
    }

    /// The index that a word like "-3" means among `count` things so far; false where it is no number.
    static bool read_index(std::string_view word, std::size_t count, std::uint32_t& out) {
        long long value = 0;
        auto const [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (error != std::errc() || end != word.data() + word.size() || value == 0 || value >= PolygonSoup::nothing ||
            value < -static_cast<long long>(count)) {
            return false;
        }
        out = static_cast<std::uint32_t>(value > 0 ? value - 1 : static_cast<long long>(count) + value);
        return true;
    }

    /// Reads "v", "v/vt", "v//vn" or "v/vt/vn".
    bool read_corner(std::string_view word, Corner& out) const {
        std::array<std::string_view, 3> parts{};
        for (std::string_view& part : parts) {
            std::size_t const slash = std::min(word.find('/'), word.size());
            part = word.substr(0, slash);
            word.remove_prefix(std::min(slash + 1, word.size()));
        }
        return word.empty() && read_index(parts[0], soup.positions.size(), out.position) &&
               (parts[1].empty() || read_index(parts[1], soup.uvs.size(), out.uv)) &&
               (parts[2].empty() || read_index(parts[2], soup.normals.size(), out.normal));
    }

    bool read_face(std::string_view rest, std::size_t line) {
        corners.clear();
        while (!rest.empty()) {
            corners.emplace_back();
            if (!read_corner(take_word(rest), corners.back())) {
                return false;
            }
        }
        if (corners.size() < 3) {
            (corners.size() == 2 ? soup.lines : soup.points) += 1;
            return !corners.empty();
        }
        soup.add_face(corners, material, smoothing);
        line_of_face.push_back(line);
        return true;
    }

    bool read_smoothing(std::string_view rest) {
        std::string_view const word = take_word(rest);
        std::optional<double> const group = word == "off" || word == "null" ? std::optional(0.0) : number_of(word);
        if (word == "on") {
            smoothing = PolygonSoup::by_angle;
            return true;
        }
        if (!group || *group < 0 || *group >= PolygonSoup::by_angle) {
            return false;
        }
        smoothing = static_cast<std::uint32_t>(*group);
        return true;
    }

    void use_material(std::string_view name) {
        material = name.empty()
                       ? none
                       : index_of_material.emplace(name, static_cast<Index>(index_of_material.size())).first->second;
    }

    bool read_statement(std::string_view keyword, std::string_view rest, std::size_t line) {
        std::string_view const uncommented = trimmed(rest.substr(0, rest.find('#')));
        if (keyword == "v") {
            return read_vertex(uncommented);
        }
        if (keyword == "vt") {
            return read_uv(uncommented);
        }
        if (keyword == "vn") {
            return read_normal(uncommented);
        }
        if (keyword == "f" || keyword == "fo") {
            return read_face(uncommented, line);
        }
        if (keyword == "s") {
            return read_smoothing(uncommented);
        }
        if (keyword == "usemtl") {
            use_material(rest);
        } else if (keyword == "mtllib") {
            libraries.emplace_back(rest);
        } else if (keyword == "l") {
            ++soup.lines;
        } else if (keyword == "p") {
            while (!take_word(rest).empty()) {
                ++soup.points;
            }
        } else if (keyword == "surf" || keyword == "curv" || keyword == "curv2") {
            ++soup.curves;
        } else {
            return unused_statements.contains(keyword);
        }
        return true;
    }

    void read(std::string_view text) {
        TextLines lines(text);
        std::string joined; // of lines that go on in the next one
        for (std::string_view line; lines.next(line);) {
            std::size_t const number = lines.number();
            if (line.ends_with('\\') && !line.starts_with('#')) {
                joined.clear();
                do {
                    joined.append(line.substr(0, line.size() - 1)).append(" ");
                } while (lines.next(line) && line.ends_with('\\'));
                line = joined.append(line);
            }
            if (number % 65536 == 0) {
                reading.tell(text.size() - lines.rest().size(), text.size());
            }
            std::string_view rest = line;
            std::string_view const keyword = take_word(rest);
            if (!keyword.empty() && !keyword.starts_with('#') && !read_statement(keyword, rest, number)) {
                remarks.cannot_read(number, line);
            }
        }
    }

    /// Takes out polygons whose vertices the file does not have, or whose vertices could not be read.
    void check_faces() {
        std::vector<Corner> const all = std::move(soup.corners);
        std::vector<PolygonSoup::Face> const faces = std::move(soup.faces);
        soup.corners.clear();
        soup.faces.clear();
        bool const has_colors = !soup.colors.empty();
        for (std::size_t f = 0; f < faces.size(); ++f) {
            std::size_t const end = f + 1 < faces.size() ? faces[f + 1].first : all.size();
            corners.assign(all.begin() + faces[f].first, all.begin() + static_cast<std::ptrdiff_t>(end));
            bool fits = true;
            std::string problem;
            for (Corner& corner : corners) {
                if (!soup.is_usable(corner.position)) {
                    bool const is_there = corner.position < soup.positions.size();
                    problem = "vertex " + std::to_string(corner.position + std::size_t(1)) +
                              (is_there ? ", which cannot be read" : " of " + std::to_string(soup.positions.size()));
                }
                fits = fits && (corner.uv == PolygonSoup::nothing || corner.uv < soup.uvs.size()) &&
                       (corner.normal == PolygonSoup::nothing || corner.normal < soup.normals.size());
                corner.uv = corner.uv < soup.uvs.size() ? corner.uv : PolygonSoup::nothing;
                corner.normal = corner.normal < soup.normals.size() ? corner.normal : PolygonSoup::nothing;
                corner.color = has_colors ? corner.position : PolygonSoup::nothing;
            }
            if (problem.empty()) {
                soup.add_face(corners, faces[f].material, faces[f].smoothing);
            } else {
                remarks.add(line_of_face[f], "a polygon names " + problem);
            }
            if (problem.empty() && !fits) {
                remarks.add(line_of_face[f], "texture coordinates or normals that the file does not have");
            }
        }
    }

    void finish_colors() {
        soup.colors.resize(soup.colors.empty() ? 0 : soup.positions.size(), Vec4(INFINITY));
        float const scale = brightest > 1 ? 1.0f / 255 : 1; // some programs write bytes
        for (Vec4& color : soup.colors) {
            for (int c = 0; c < 3; ++c) {
                color[c] = linear_from_srgb(std::clamp(color[c] * scale, 0.0f, 1.0f));
            }
            color.w = 1;
        }
    }

    void read_library(std::filesystem::path const& file, MaterialList& materials) {
        try {
            std::optional<RegularFile> const opened = reading.folder.open(file);
            if (!opened) {
                throw InputError("file '" + file.string() + "' cannot be read");
            }
            std::vector<std::byte> const bytes = read_file(*opened, file.string(), reading.budget);
            LineRemarks of_file(file.filename().string(), reading.warnings);
            read_mtl(text_of(bytes), of_file, materials);
        } catch (SceneTooLarge const&) {
            throw;
        } catch (InputError const& error) {
            reading.warnings.push_back(std::string(error.what()) + "; shown without it");
        }
    }

    /// Reads the material files: one statement names one whose name has blanks, or several.
    void read_libraries(MaterialList& materials) {
        bool has_missing = false;
        auto const open = [&](std::string_view name) {
            NamedFile const found = find_named_file(reading.folder, "file", name);
            if (!found.remark.empty()) {
                reading.warnings.push_back(found.remark);
            }
            if (!found.file.empty()) {
                read_library(found.file, materials);
            }
            return !found.file.empty();
        };
        for (std::string_view names : libraries) {
            if (open(names)) {
                continue;
            }
            std::string_view const all = names;
            for (std::string_view name = take_word(names); !name.empty(); name = take_word(names)) {
                if ((name == all || !open(name))) {
                    has_missing = true;
                    reading.warnings.push_back(no_named_file(reading.folder, "file", name) + "; shown without it");
                }
            }
        }
        if (has_missing) { // renamed along with the scene
            open(std::filesystem::path(reading.name).replace_extension(".mtl").string());
        }
    }

    /// Gives the polygons the materials that the files have for the names that they use.
    void find_materials() {
        MaterialList from_files;
        read_libraries(from_files);
        std::vector<Index> index(index_of_material.size());
        for (auto const& [name, number] : index_of_material) {
            auto const found = from_files.index_of.find(name);
            bool const is_known = found != from_files.index_of.end();
            index[static_cast<std::size_t>(number)] =
                is_known ? static_cast<Index>(reading.materials.all.size()) : none;
            if (is_known) {
                reading.materials.all.push_back(std::move(from_files.all[static_cast<std::size_t>(found->second)]));
            } else if (!from_files.all.empty()) {
                reading.warnings.push_back("material '" + name + "' is in no material file; shown in grey");
            }
        }
        for (PolygonSoup::Face& face : soup.faces) {
            face.material = face.material == none ? none : index[static_cast<std::size_t>(face.material)];
        }
    }
};

} // namespace

void read_obj(std::string_view text, MeshReading& reading) {
    ObjReader reader{reading};
    reader.read(text);
    reader.check_faces();
    reader.finish_colors();
    reader.find_materials();
}

} // namespace framelet
