// Reads .ply files (Turk, "The PLY Polygon File Format"): any properties, in text or binary, of either byte order;
// polygons, strips of triangles, colours, and texture coordinates of vertices or of corners.
#include <algorithm>
#include <array>
#include <bit>
#include <optional>

#include "common/color.h"
#include "common/error.h"
#include "server/scene/mesh/mesh_import.h"
#include "server/scene/mesh/mtl_text.h"
#include "server/scene/reading/text_lines.h"

namespace framelet {
namespace {

using Corner = PolygonSoup::Corner;

enum class Type : std::uint8_t { i8, u8, i16, u16, i32, u32, f32, f64 };

std::optional<Type> type_of(std::string_view word) {
    static std::map<std::string_view, Type> const types = {
        {"char", Type::i8},   {"int8", Type::i8},     {"uchar", Type::u8},   {"uint8", Type::u8},
        {"short", Type::i16}, {"int16", Type::i16},   {"ushort", Type::u16}, {"uint16", Type::u16},
        {"int", Type::i32},   {"int32", Type::i32},   {"uint", Type::u32},   {"uint32", Type::u32},
        {"float", Type::f32}, {"float32", Type::f32}, {"double", Type::f64}, {"float64", Type::f64}};
    auto const found = types.find(word);
    return found == types.end() ? std::nullopt : std::optional(found->second);
}

std::size_t size_of(Type type) {
    return std::array<std::size_t, 8>{1, 1, 2, 2, 4, 4, 4, 8}[static_cast<std::size_t>(type)];
}

struct Property {
    std::string name;
    Type type = Type::f32;
    std::optional<Type> count = {}; ///< of a list
};

struct Element {
    std::string name;
    std::size_t count = 0;
    std::vector<Property> properties = {};

    std::size_t index_of(std::initializer_list<std::string_view> names) const {
        for (std::size_t i = 0; i < properties.size(); ++i) {
            if (std::ranges::find(names, properties[i].name) != names.end()) {
                return i;
            }
        }
        return properties.size(); // `Values` have an empty one there
    }
};

struct Header {
    enum class Format { text, little, big } format = Format::text;
    std::vector<Element> elements = {};
    std::vector<std::string> textures = {}; ///< named in comments, as many programs do
};

/// The values of each property of one element, and an empty list behind them.
using Values = std::vector<std::vector<double>>;

/// Reads the header's lines, up to and with its end.
Header read_header(TextLines& lines, std::size_t file_bytes, LineRemarks& remarks) {
    constexpr std::size_t least_element_bytes = 3; // three numbers take a byte each at least
    Header header;
    std::string_view line;
    if (!lines.next(line) || line != "ply") {
        throw InputError("it is not a PLY file: it does not begin with 'ply'");
    }
    while (lines.next(line)) {
        std::string_view rest = line;
        std::string_view const keyword = take_word(rest);
        if (keyword == "end_header") {
            return header;
        }
        if (keyword == "format") {
            std::string_view const format = take_word(rest);
            header.format = format == "binary_little_endian" ? Header::Format::little
                            : format == "binary_big_endian"  ? Header::Format::big
                                                             : Header::Format::text;
        } else if (keyword == "comment" || keyword == "obj_info") {
            if (take_word(rest) == "TextureFile" && !rest.empty()) {
                header.textures.emplace_back(rest);
            }
        } else if (keyword == "element") {
            std::string_view const name = take_word(rest);
            std::string_view const word = take_word(rest);
            std::optional<double> const count = number_of(word);
            if (!count || !(*count >= 0)) {
                throw InputError("its header has no number of '" + std::string(name) + "'");
            }
            auto const most = file_bytes / least_element_bytes;
            if (*count > static_cast<double>(most)) {
                throw InputError("its header promises " + std::string(word) + " elements, more than its " +
                                 std::to_string(file_bytes) + " bytes can hold");
            }
            header.elements.push_back({std::string(name), static_cast<std::size_t>(*count)});
        } else if (keyword == "property" && !header.elements.empty()) {
            std::string_view const first = take_word(rest);
            bool const is_list = first == "list";
            std::optional<Type> const count = is_list ? type_of(take_word(rest)) : std::nullopt;
            std::optional<Type> const type = type_of(is_list ? take_word(rest) : first);
            if (!type || (is_list && !count)) {
                throw InputError("its header has a property of unknown type: '" + std::string(line) + "'");
            }
            header.elements.back().properties.push_back({std::string(rest), *type, count});
        } else if (!line.empty()) {
            remarks.cannot_read(lines.number(), line);
        }
    }
    throw InputError("its header has no end");
}

/// Reads elements that are written as text, one a line.
struct TextElements {
    TextLines lines;
    std::size_t element_line = 0;

    std::size_t bytes_left() const { return lines.rest().size(); }
    std::string where() const { return "line " + std::to_string(element_line); }

    /// False at the end. `is_whole`: the element could be read.
    bool next(Element const& element, Values& values, bool& is_whole) {
        std::string_view line;
        do {
            if (!lines.next(line)) {
                return false;
            }
        } while (line.empty());
        element_line = lines.number();
        is_whole = true;
        for (std::size_t i = 0; i < element.properties.size(); ++i) {
            values[i].clear();
            std::optional<double> const count = element.properties[i].count ? number_of(take_word(line)) : 1;
            is_whole = is_whole && count && *count >= 0;
            for (double k = 0; is_whole && k < *count; ++k) {
                std::optional<double> const value = any_number_of(take_word(line));
                is_whole = value.has_value();
                values[i].push_back(value.value_or(0));
            }
        }
        return true;
    }
};

/// Reads elements that are written as bytes.
struct BinaryElements {
    std::string_view rest;
    bool is_swapped = false;
    std::size_t number = 0; ///< of the element in its list, from 1

    std::size_t bytes_left() const { return rest.size(); }
    std::string where() const { return "element " + std::to_string(number); }

    template <class T>
    double read_as() {
        std::array<char, sizeof(T)> bytes{};
        std::copy_n(rest.begin(), sizeof(T), bytes.begin());
        rest.remove_prefix(sizeof(T));
        if (is_swapped) {
            std::reverse(bytes.begin(), bytes.end());
        }
        return static_cast<double>(std::bit_cast<T>(bytes));
    }

    double read(Type type) {
        switch (type) {
        case Type::i8:
            return read_as<std::int8_t>();
        case Type::u8:
            return read_as<std::uint8_t>();
        case Type::i16:
            return read_as<std::int16_t>();
        case Type::u16:
            return read_as<std::uint16_t>();
        case Type::i32:
            return read_as<std::int32_t>();
        case Type::u32:
            return read_as<std::uint32_t>();
        case Type::f32:
            return read_as<float>();
        default:
            return read_as<double>();
        }
    }

    bool next(Element const& element, Values& values, bool& is_whole) {
        ++number;
        is_whole = true;
        for (std::size_t i = 0; i < element.properties.size(); ++i) {
            Property const& property = element.properties[i];
            values[i].clear();
            double count = 1;
            if (property.count) {
                if (rest.size() < size_of(*property.count)) {
                    return false;
                }
                count = read(*property.count);
            }
            if (!(count >= 0) ||
                count * static_cast<double>(size_of(property.type)) > static_cast<double>(rest.size())) {
                rest = {}; // nobody knows where the next one begins
                return false;
            }
            for (double k = 0; k < count; ++k) {
                values[i].push_back(read(property.type));
            }
        }
        return true;
    }
};

struct PlyReader {
    MeshReading& reading;
    Header header;
    LineRemarks& remarks;
    PolygonSoup& soup = reading.soup;
    bool has_normals = false, has_uvs = false, has_colors = false; ///< of vertices
    std::vector<Corner> corners = {}; ///< scratch

    /// Display colours, as bytes or as fractions.
    static Vec4 color_of(Element const& element, Values const& values, std::array<std::size_t, 4> const& at) {
        Vec4 color(1);
        for (int c = 0; c < 4; ++c) {
            std::size_t const i = at[static_cast<std::size_t>(c)];
            if (values[i].size() != 1) {
                continue;
            }
            Type const type = element.properties[i].type;
            double const most = type == Type::u8 ? 255 : type == Type::u16 ? 65535 : 1;
            auto const value = static_cast<float>(std::clamp(values[i][0] / most, 0.0, 1.0));
            color[c] = c < 3 ? linear_from_srgb(value) : value;
        }
        return color;
    }

    static std::array<std::size_t, 4> colors_at(Element const& element) {
        return {element.index_of({"red", "r", "diffuse_red"}), element.index_of({"green", "g", "diffuse_green"}),
                element.index_of({"blue", "b", "diffuse_blue"}), element.index_of({"alpha", "a", "diffuse_alpha"})};
    }

    template <class Elements>
    void read_vertices(Element const& element, Elements& elements) {
        std::array const at{element.index_of({"x"}), element.index_of({"y"}), element.index_of({"z"})};
        std::array const normal{element.index_of({"nx"}), element.index_of({"ny"}), element.index_of({"nz"})};
        std::array const uv{element.index_of({"s", "u", "texture_u"}), element.index_of({"t", "v", "texture_v"})};
        std::array const color = colors_at(element);
        std::size_t const absent = element.properties.size();
        has_normals = std::ranges::find(normal, absent) == normal.end();
        has_uvs = std::ranges::find(uv, absent) == uv.end();
        has_colors = std::find(color.begin(), color.begin() + 3, absent) == color.begin() + 3;
        for_each(element, elements, [&](Values const& values, bool is_whole) {
            auto const value = [&](std::size_t i) { return is_whole && values[i].size() == 1 ? values[i][0] : NAN; };
            soup.positions.emplace_back(value(at[0]), value(at[1]), value(at[2]));
            if (has_normals) {
                soup.normals.emplace_back(value(normal[0]), value(normal[1]), value(normal[2]));
            }
            if (has_uvs) {
                soup.uvs.emplace_back(value(uv[0]), value(uv[1]));
            }
            if (has_colors) {
                soup.colors.push_back(is_whole ? color_of(element, values, color) : Vec4(1));
            }
            return is_whole;
        });
    }

    Corner corner_at(double index) const {
        auto const i =
            index >= 0 && index < PolygonSoup::nothing ? static_cast<std::uint32_t>(index) : PolygonSoup::nothing;
        return {i, has_uvs ? i : PolygonSoup::nothing, has_normals ? i : PolygonSoup::nothing,
                has_colors ? i : PolygonSoup::nothing};
    }

    /// True where all of the corners have a position.
    bool add_face(Index material) {
        bool const is_usable =
            std::ranges::all_of(corners, [&](Corner const& corner) { return soup.is_usable(corner.position); });
        if (is_usable && corners.size() >= 3) {
            soup.add_face(corners, material, PolygonSoup::by_angle);
        }
        soup.lines += corners.size() == 2;
        soup.points += corners.size() == 1;
        return is_usable && !corners.empty();
    }

    template <class Elements>
    void read_faces(Element const& element, Elements& elements) {
        std::size_t const indices = element.index_of({"vertex_indices", "vertex_index"});
        std::size_t const uv = element.index_of({"texcoord"});
        std::size_t const texture = element.index_of({"texnumber"});
        std::array const color = colors_at(element);
        bool const is_colored =
            std::find(color.begin(), color.begin() + 3, element.properties.size()) == color.begin() + 3;
        for_each(element, elements, [&](Values const& values, bool is_whole) {
            if (!is_whole) {
                return false;
            }
            corners.clear();
            std::ranges::transform(values[indices], std::back_inserter(corners),
                                   [&](double index) { return corner_at(index); });
            if (values[uv].size() == 2 * corners.size()) {
                for (std::size_t k = 0; k < corners.size(); ++k) {
                    corners[k].uv = static_cast<std::uint32_t>(soup.uvs.size());
                    soup.uvs.emplace_back(values[uv][2 * k], values[uv][2 * k + 1]);
                }
            }
            if (is_colored) {
                for (Corner& corner : corners) {
                    corner.color = static_cast<std::uint32_t>(soup.colors.size());
                }
                soup.colors.push_back(color_of(element, values, color));
            }
            double const number = values[texture].size() == 1 ? values[texture][0] : 0;
            bool const is_textured = number >= 0 && number < static_cast<double>(header.textures.size());
            return add_face(is_textured ? static_cast<Index>(number) : none);
        });
    }

    /// Reads strips of triangles: each further corner makes one with the two before it; -1 begins another strip.
    template <class Elements>
    void read_strips(Element const& element, Elements& elements) {
        std::size_t const indices = element.index_of({"vertex_indices", "vertex_index"});
        Index const material = header.textures.empty() ? none : 0;
        for_each(element, elements, [&](Values const& values, bool is_whole) {
            std::vector<double> const& strip = values[indices];
            std::size_t first = 0;
            for (std::size_t k = 0; is_whole && k < strip.size(); ++k) {
                if (strip[k] < 0) {
                    first = k + 1;
                } else if (k >= first + 2) {
                    std::size_t const turned = (k - first) % 2;
                    corners = {corner_at(strip[k - 2 + turned]), corner_at(strip[k - 1 - turned]), corner_at(strip[k])};
                    is_whole = add_face(material);
                }
            }
            return is_whole;
        });
    }

    /// Reads the element's list; what `use` finds unusable gets a remark.
    template <class Elements, class Use>
    void for_each(Element const& element, Elements& elements, Use const& use) {
        std::size_t const begin = elements.bytes_left();
        Values values(element.properties.size() + 1);
        for (std::size_t i = 0; i < element.count; ++i) {
            bool is_whole = false;
            if (!elements.next(element, values, is_whole)) {
                reading.is_truncated = true;
                reading.warnings.push_back("the file ends after " + std::to_string(i) + " of " +
                                           std::to_string(element.count) + " of its '" + element.name + "' elements");
                return;
            }
            if (!use(values, is_whole)) {
                remarks.add(elements.where(), "a " + element.name + " that cannot be read");
            }
            if (i % 65536 == 65535) {
                reading.tell(begin - elements.bytes_left(), begin);
            }
        }
    }

    template <class Elements>
    void read(Elements elements) {
        for (Element const& element : header.elements) {
            if (element.name == "vertex") {
                read_vertices(element, elements);
            } else if (element.name == "face") {
                read_faces(element, elements);
            } else if (element.name == "tristrips") {
                read_strips(element, elements);
            } else {
                soup.lines += element.name == "edge" ? element.count : 0;
                for_each(element, elements, [](Values const&, bool) { return true; });
            }
        }
        if (soup.faces.empty() && soup.points + soup.lines == 0) {
            soup.points = soup.positions.size(); // a cloud
        }
        for (std::string const& name : header.textures) {
            set_texture(reading.materials.get(name), aiTextureType_DIFFUSE, name);
        }
    }
};

} // namespace

void read_ply(std::string_view bytes, MeshReading& reading) {
    TextLines lines(bytes);
    LineRemarks remarks(reading.name, reading.warnings);
    Header const header = read_header(lines, bytes.size(), remarks);
    PlyReader reader{reading, header, remarks};
    if (header.format == Header::Format::text) {
        reader.read(TextElements{lines});
    } else {
        bool const is_swapped = (header.format == Header::Format::big) != (std::endian::native == std::endian::big);
        reader.read(BinaryElements{lines.rest(), is_swapped});
    }
}

} // namespace framelet
