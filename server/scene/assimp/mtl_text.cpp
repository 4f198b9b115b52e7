#include "server/scene/assimp/mtl_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>

#include <assimp/scene.h>

namespace framelet {
namespace {

constexpr std::string_view blanks = " \t\r\v\f";

std::string_view trimmed(std::string_view text) {
    std::size_t const first = text.find_first_not_of(blanks);
    return first == text.npos ? std::string_view() : text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/// Takes the first word off the text.
std::string_view take_word(std::string_view& text) {
    std::size_t const end = std::min(text.find_first_of(blanks), text.size());
    std::string_view const word = text.substr(0, end);
    text = trimmed(text.substr(end));
    return word;
}

std::optional<float> number_of(std::string_view word) {
    float value = 0;
    word.remove_prefix(word.starts_with('+') ? 1 : 0);
    auto const [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    bool const is_number = error == std::errc() && end == word.data() + word.size() && std::isfinite(value);
    return is_number ? std::optional(value) : std::nullopt;
}

/// Takes up to three numbers off the text.
std::vector<float> take_numbers(std::string_view& text) {
    std::vector<float> numbers;
    while (numbers.size() < 3) {
        std::string_view rest = text;
        std::optional<float> const number = number_of(take_word(rest));
        if (!number) {
            break;
        }
        numbers.push_back(*number);
        text = rest;
    }
    return numbers;
}

/// The text's one word as a number, for Assimp; empty where it is none.
std::optional<std::string> one_number(std::string_view rest) {
    std::optional<float> const number = number_of(take_word(rest));
    return number ? std::optional(std::to_string(*number)) : std::nullopt;
}

/// "r g b" of the colour; a single number is grey.
std::optional<std::string> color_of(std::string_view rest) {
    std::string_view after = rest;
    bool const is_xyz = take_word(after) == "xyz";
    std::string_view& text = is_xyz ? after : rest;
    std::vector<float> c = take_numbers(text);
    if (c.empty()) {
        return std::nullopt;
    }
    c.resize(3, c.front());
    if (is_xyz) { // CIE XYZ to linear Rec.709 (IEC 61966-2-1)
        c = {3.2406f * c[0] - 1.5372f * c[1] - 0.4986f * c[2], -0.9689f * c[0] + 1.8758f * c[1] + 0.0415f * c[2],
             0.0557f * c[0] - 0.2040f * c[1] + 1.0570f * c[2]};
    }
    return std::to_string(c[0]) + " " + std::to_string(c[1]) + " " + std::to_string(c[2]);
}

struct TextureLine {
    std::string name;
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
            std::vector<float> const numbers = take_numbers(after);
            aiVector2D unused;
            aiVector2D& to = option == "-s"   ? line.transform.mScaling
                             : option == "-o" ? line.transform.mTranslation
                                              : unused;
            to.x = numbers.empty() ? to.x : numbers[0];
            to.y = numbers.size() < 2 ? to.y : numbers[1];
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

struct TextureStatement {
    std::string_view for_assimp;
    aiTextureType type;
};

TextureStatement const* find_texture(std::string_view keyword) {
    static std::map<std::string_view, TextureStatement> const statements = {
        {"map_Kd", {"map_Kd", aiTextureType_DIFFUSE}},
        {"map_kd", {"map_Kd", aiTextureType_DIFFUSE}},
        {"map_Ke", {"map_emissive", aiTextureType_EMISSIVE}},
        {"map_emissive", {"map_emissive", aiTextureType_EMISSIVE}},
        {"map_d", {"map_d", aiTextureType_OPACITY}},
        {"map_opacity", {"map_d", aiTextureType_OPACITY}},
        {"map_Bump", {"bump", aiTextureType_HEIGHT}},
        {"map_bump", {"bump", aiTextureType_HEIGHT}},
        {"bump", {"bump", aiTextureType_HEIGHT}},
        {"norm", {"norm", aiTextureType_NORMALS}},
        {"map_Kn", {"norm", aiTextureType_NORMALS}}};
    auto const found = statements.find(keyword);
    return found == statements.end() ? nullptr : &found->second;
}

/// The line as Assimp reads it, empty where it is of no use here; nothing where it cannot be read.
std::optional<std::string> clean_line(std::string_view line, std::string& material, MtlRemarks& remarks) {
    std::string_view rest = line;
    std::string_view const keyword = take_word(rest);
    auto const statement = [](std::string_view word, std::optional<std::string> const& value) {
        return value ? std::optional(std::string(word) + " " + *value) : std::nullopt;
    };
    if (keyword == "newmtl") {
        material = rest.empty() ? material : rest;
        return rest.empty() ? std::nullopt : std::optional("newmtl " + material);
    }
    if (keyword == "Kd" || keyword == "Ke") {
        return statement(keyword, color_of(rest));
    }
    if (keyword == "Ks") {
        std::string_view after = rest;
        return take_word(after) == "spectral" ? std::string() : statement(keyword, color_of(rest));
    }
    if (keyword == "d") {
        std::string_view after = rest;
        return statement("d", one_number(take_word(after) == "-halo" ? after : rest));
    }
    if (keyword == "Tr") {
        std::optional<float> const through = number_of(take_word(rest));
        return statement("d", through ? std::optional(std::to_string(1 - *through)) : std::nullopt);
    }
    if (keyword == "Ns" || keyword == "Pr" || keyword == "Pm") {
        return statement(keyword, one_number(rest));
    }
    if (TextureStatement const* const texture = find_texture(keyword)) {
        std::optional<TextureLine> const found = texture_of(rest);
        if (!found) {
            return std::nullopt;
        }
        remarks.transforms.push_back({material, texture->type, found->transform});
        return std::string(texture->for_assimp) + (found->clamps ? " -clamp on " : " ") + found->name;
    }
    return std::string();
}

} // namespace

std::string clean_mtl(std::string_view text, std::string const& name, MtlRemarks& remarks) {
    std::string clean;
    std::string material;
    std::size_t number = 0;
    text.remove_prefix(text.starts_with("\xef\xbb\xbf") ? 3 : 0);
    while (!text.empty()) {
        std::size_t const end = std::min(text.find('\n'), text.size());
        std::string_view const line = trimmed(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
        ++number;
        if (std::optional<std::string> const readable = clean_line(line, material, remarks)) {
            clean += readable->empty() ? "" : *readable + "\n";
        } else {
            remarks.warnings.push_back(name + ", line " + std::to_string(number) + ": '" + std::string(line) +
                                       "' cannot be read; passed over");
        }
    }
    return clean.empty() ? "\n" : clean;
}

void add_transforms(aiScene const& scene, MtlRemarks const& remarks) {
    std::multimap<std::string, MtlRemarks::Transform const*> of_material;
    for (MtlRemarks::Transform const& transform : remarks.transforms) {
        of_material.emplace(transform.material, &transform);
    }
    for (unsigned m = 0; m < scene.mNumMaterials; ++m) {
        aiString name;
        scene.mMaterials[m]->Get(AI_MATKEY_NAME, name);
        auto const [first, last] = of_material.equal_range(name.C_Str());
        for (auto found = first; found != last; ++found) {
            MtlRemarks::Transform const& of = *found->second;
            scene.mMaterials[m]->AddProperty(&of.transform, 1, AI_MATKEY_UVTRANSFORM(of.texture, 0));
        }
    }
}

} // namespace framelet
