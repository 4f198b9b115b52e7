// Reads tinygltf's loosely typed values (extension objects, arrays of doubles) with defaults.
// In: a value and a key. Out: a number or vector; the default where it is absent or of another type.
#pragma once

#include <string>
#include <vector>

#include <tiny_gltf.h>

#include "common/math.h"

namespace framelet {

inline tinygltf::Value const* find_extension(tinygltf::ExtensionMap const& extensions, std::string const& name) {
    auto const found = extensions.find(name);
    return found != extensions.end() && found->second.IsObject() ? &found->second : nullptr;
}

inline float number(tinygltf::Value const& object, std::string const& key, float otherwise) {
    tinygltf::Value const& value = object.Get(key); // a null value where absent
    return value.IsNumber() ? static_cast<float>(value.GetNumberAsDouble()) : otherwise;
}

inline int integer(tinygltf::Value const& object, std::string const& key, int otherwise) {
    return object.Get(key).IsInt() ? object.Get(key).GetNumberAsInt() : otherwise;
}

inline Vec2 vec2(tinygltf::Value const& object, std::string const& key, Vec2 otherwise) {
    tinygltf::Value const& value = object.Get(key);
    if (value.ArrayLen() != 2 || !value.Get(0).IsNumber() || !value.Get(1).IsNumber()) {
        return otherwise;
    }
    return {static_cast<float>(value.Get(0).GetNumberAsDouble()), static_cast<float>(value.Get(1).GetNumberAsDouble())};
}

inline Vec3 vec3(std::vector<double> const& values, Vec3 otherwise) {
    return values.size() == 3 ? Vec3(glm::dvec3(values[0], values[1], values[2])) : otherwise;
}

inline Vec4 vec4(std::vector<double> const& values, Vec4 otherwise) {
    return values.size() == 4 ? Vec4(glm::dvec4(values[0], values[1], values[2], values[3])) : otherwise;
}

} // namespace framelet
