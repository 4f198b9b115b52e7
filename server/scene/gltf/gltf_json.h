// Reads members of a glTF file's JSON, which may be anything: a file may have text where a number belongs.
// In: an object and a key. Out: a value; a default where there is none, an InputError where it is of another kind.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/error.h"
#include "server/scene/scene.h"

namespace framelet {

using Json = nlohmann::json;

inline Json const& no_value() {
    static Json const nothing;
    return nothing;
}

/// The member; null where there is none.
inline Json const& member(Json const& object, char const* key) {
    auto const found = object.find(key); // the end where it is no object
    return found == object.end() ? no_value() : *found;
}

/// The list of that name; an empty one where there is none.
inline Json::array_t const& list(Json const& object, char const* key) {
    static Json::array_t const nothing;
    auto const* const found = member(object, key).get_ptr<Json::array_t const*>();
    return found ? *found : nothing;
}

/// The text of that name; an empty one where there is none.
inline std::string text(Json const& object, char const* key) {
    auto const* const found = member(object, key).get_ptr<std::string const*>();
    return found ? *found : std::string();
}

inline bool flag(Json const& object, char const* key, bool otherwise) {
    auto const* const found = member(object, key).get_ptr<bool const*>();
    return found ? *found : otherwise;
}

inline double number(Json const& object, char const* key, double otherwise) {
    Json const& found = member(object, key);
    return found.is_number() ? found.get<double>() : otherwise;
}

/// A count or an offset. What is below 0 becomes huge, and is refused like any other that is too large.
inline std::uint64_t size(Json const& object, char const* key, std::uint64_t otherwise) {
    Json const& found = member(object, key);
    if (found.is_number_integer()) {
        return found.get<std::uint64_t>();
    }
    double const value = number(object, key, -1);
    if (!found.is_null() && !(value >= 0 && value < 1e18 && value == std::floor(value))) {
        throw InputError(std::string("its ") + key + " is not a whole number");
    }
    return found.is_null() ? otherwise : static_cast<std::uint64_t>(value);
}

/// An index as the file writes it; `none` where there is none, one that no list is long enough for where it is no
/// index.
inline Index index_of(Json const& value) {
    constexpr double beyond_all = std::numeric_limits<Index>::max();
    double const number = value.is_number() ? value.get<double>() : beyond_all;
    return value.is_null()                      ? none
           : number >= 0 && number < beyond_all ? static_cast<Index>(number)
                                                : std::numeric_limits<Index>::max();
}

inline Index index(Json const& object, char const* key) {
    return index_of(member(object, key));
}

/// `value` as the place of one of the things in a list. Throws InputError where there is none.
inline std::size_t checked(Json const& value, std::size_t count, char const* kind) {
    Index const place = index_of(value);
    if (place < 0 || static_cast<std::size_t>(place) >= count) {
        throw InputError(kind + (" " + value.dump(-1, ' ', true, Json::error_handler_t::replace)) + " does not exist");
    }
    return static_cast<std::size_t>(place);
}

/// The extension of that name; null where there is none.
inline Json const& extension(Json const& object, char const* name) {
    Json const& found = member(member(object, "extensions"), name);
    return found.is_object() ? found : no_value();
}

/// Takes the numbers of that name into `out`, a vector or matrix; leaves it as it is where there are none. Throws
/// InputError where there are others.
template <typename T>
void read_numbers(Json const& object, char const* key, T& out) {
    constexpr auto count = sizeof(T) / sizeof(typename T::value_type);
    Json const& found = member(object, key);
    if (found.is_null()) {
        return;
    }
    Json::array_t const& values = list(object, key);
    bool fits = values.size() == count;
    for (Json const& value : values) {
        fits = fits && value.is_number();
    }
    if (!fits) {
        throw InputError(std::string("its ") + key + " is not " + std::to_string(count) + " numbers");
    }
    auto* const to = reinterpret_cast<typename T::value_type*>(&out);
    for (std::size_t i = 0; i < count; ++i) {
        to[i] = values[i].get<typename T::value_type>();
    }
}

/// All numbers of that name; 0 for what is none.
inline std::vector<float> floats(Json const& object, char const* key) {
    std::vector<float> out;
    for (Json const& value : list(object, key)) {
        out.push_back(value.is_number() ? value.get<float>() : 0.0f);
    }
    return out;
}

} // namespace framelet
