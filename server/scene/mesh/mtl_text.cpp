#include "server/scene/mesh/mtl_text.h"

#include <array>
#include <optional>

#include "server/scene/reading/text_lines.h"

namespace framelet {
namespace {

std::optional<float> one_number(std::string_view text) {
    std::optional<double> const number = number_of(take_word(text));
    return number ? std::optional(static_cast<float>(*number)) : std::nullopt;
}

/// The colour "r g b"; a single number is grey.
std::optional<aiColor3D> color_of(std::string_view text) {
    std::string_view after = text;
    bool const is_xyz = take_word(after) == "xyz";
    std::array<double, 3> c{};
    std::size_t const count = take_numbers(is_xyz ? after : text, c);
    if (count == 0) {
        return std::nullopt;
    }
    for (std::size_t i = count; i < 3; ++i) {
        c[i] = c[0];
    }
    if (is_xyz) { // CIE XYZ to linear Rec.709 (IEC 61966-2-1)
        c = {3.2406 * c[0] - 1.5372 * c[1] - 0.4986 * c[2], -0.9689 * c[0] + 1.8758 * c[1] + 0.0415 * c[2],
             0.0557 * c[0] - 0.2040 * c[1] + 1.0570 * c[2]};
    }
    return aiColor3D(static_cast<float>(c[0]), static_cast<float>(c[1]), static_cast<float>(c[2]));
}

struct TextureLine {
    std::string_view name;
    bool clamps = false;
    aiUVTransform transform;
};

/// Empty where no name is left after the options.
std::optional<TextureLine> texture_of(std::string_view rest) {
    static std::map<std::string_view, int> const words_of = {
        {"-mm", 2}, {"-bm", 1},   {"-boost", 1},   {"-texres", 1}, {"-blendu", 1},    {"-blendv", 1},
        {"-cc", 1}, {"-type", 1}, {"-imfchan", 1}, {"-clamp", 1},  {"-colorspace", 1}};
    TextureLine line;
    for (;;) {
        std::string_view after = rest;
        std::string_view const option = take_word(after);
        auto const found = words_of.find(option);
        if (option == "-s" || option == "-o" || option == "-t") {
            std::array<double, 3> numbers{};
            std::size_t const count = take_numbers(after, numbers);
            aiVector2D unused;
            aiVector2D& to = option == "-s"   ? line.transform.mScaling
                             : option == "-o" ? line.transform.mTranslation
                                              : unused;
            to.x = count < 1 ? to.x : static_cast<float>(numbers[0]);
            to.y = count < 2 ? to.y : static_cast<float>(numbers[1]);
        } else if (found != words_of.end()) {
            for (int i = 0; i < found->second; ++i) {
                std::string_view const value = take_word(after);
                line.clamps = option == "-clamp" ? value == "on" : line.clamps;
            }
        } else {
            line.name = rest;
            return line.name.empty() ? std::nullopt : std::optional(line);
        }
        rest = after;
    }
}

std::optional<aiTextureType> texture_type(std::string_view keyword) {
    static std::map<std::string_view, aiTextureType> const types = {
        {"map_Kd", aiTextureType_DIFFUSE},        {"map_kd", aiTextureType_DIFFUSE},
        {"map_Ke", aiTextureType_EMISSIVE},       {"map_ke", aiTextureType_EMISSIVE},
        {"map_emissive", aiTextureType_EMISSIVE}, {"map_d", aiTextureType_OPACITY},
        {"map_D", aiTextureType_OPACITY},         {"map_opacity", aiTextureType_OPACITY},
        {"map_Bump", aiTextureType_HEIGHT},       {"map_bump", aiTextureType_HEIGHT},
        {"bump", aiTextureType_HEIGHT},           {"Bump", aiTextureType_HEIGHT},
        {"norm", aiTextureType_NORMALS},          {"map_Kn", aiTextureType_NORMALS}};
    auto const found = types.find(keyword);
    return found == types.end() ? std::nullopt : std::optional(found->second);
}

/// Sets the property where there is a value; returns whether there is.
template <class Value>
bool set(aiMaterial& material, std::optional<Value> const& value, char const* key, unsigned type, unsigned index) {
    if (value) {
        material.AddProperty(&*value, 1, key, type, index);
    }
    return value.has_value();
}

bool set_texture_of(TextureLine const& line, aiMaterial& material, aiTextureType type) {
    set_texture(material, type, line.name);
    material.AddProperty(&line.transform, 1, AI_MATKEY_UVTRANSFORM(type, 0));
    int const mode = line.clamps ? aiTextureMapMode_Clamp : aiTextureMapMode_Wrap;
    material.AddProperty(&mode, 1, AI_MATKEY_MAPPINGMODE_U(type, 0));
    material.AddProperty(&mode, 1, AI_MATKEY_MAPPINGMODE_V(type, 0));
    return true;
}

/// True where the statement has been read, or nothing is made of it.
bool read_statement(std::string_view keyword, std::string_view rest, aiMaterial& material) {
    std::string_view after = rest;
    std::string_view const first = take_word(after);
    if (keyword == "Kd") {
        return set(material, color_of(rest), AI_MATKEY_COLOR_DIFFUSE);
    }
    if (keyword == "Ke") {
        return set(material, color_of(rest), AI_MATKEY_COLOR_EMISSIVE);
    }
    if (keyword == "Ks") {
        return first == "spectral" || set(material, color_of(rest), AI_MATKEY_COLOR_SPECULAR);
    }
    if (keyword == "d") {
        return set(material, one_number(first == "-halo" ? after : rest), AI_MATKEY_OPACITY);
    }
    if (keyword == "Tr") {
        std::optional<float> const through = one_number(rest);
        return set(material, through ? std::optional(1 - *through) : std::nullopt, AI_MATKEY_OPACITY);
    }
    if (keyword == "Ns") {
        return set(material, one_number(rest), AI_MATKEY_SHININESS);
    }
    if (keyword == "Pr") {
        return set(material, one_number(rest), AI_MATKEY_ROUGHNESS_FACTOR);
    }
    if (keyword == "Pm") {
        return set(material, one_number(rest), AI_MATKEY_METALLIC_FACTOR);
    }
    if (std::optional<aiTextureType> const type = texture_type(keyword)) {
        std::optional<TextureLine> const line = texture_of(rest);
        return line && set_texture_of(*line, material, *type);
    }
    return true;
}

} // namespace

aiMaterial& MaterialList::get(std::string_view name) {
    auto found = index_of.find(name);
    if (found == index_of.end()) {
        found = index_of.emplace(name, static_cast<Index>(all.size())).first;
        all.push_back(std::make_unique<aiMaterial>());
        aiString const text{std::string(name)};
        all.back()->AddProperty(&text, AI_MATKEY_NAME);
    }
    return *all[static_cast<std::size_t>(found->second)];
}

void set_texture(aiMaterial& material, aiTextureType type, std::string_view file) {
    aiString const name{std::string(file)};
    material.AddProperty(&name, AI_MATKEY_TEXTURE(type, 0));
}

void read_mtl(std::string_view text, LineRemarks& remarks, MaterialList& materials) {
    TextLines lines(text);
    aiMaterial* material = nullptr;
    for (std::string_view line; lines.next(line);) {
        std::string_view rest = line;
        std::string_view const keyword = take_word(rest);
        bool is_read = true;
        if (keyword == "newmtl") {
            is_read = !rest.empty();
            material = is_read ? &materials.get(rest) : material;
        } else if (material != nullptr) {
            is_read = read_statement(keyword, rest, *material);
        }
        if (!is_read) {
            remarks.cannot_read(lines.number(), line);
        }
    }
}

} // namespace framelet
