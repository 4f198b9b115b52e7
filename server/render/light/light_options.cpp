#include "server/render/light/light_options.h"

#include "common/error.h"

namespace framelet {

LightMethod parse_light_method(std::string const& word) {
    if (word == "direct") {
        return LightMethod::direct;
    }
    if (word == "full") {
        return LightMethod::full;
    }
    if (word == "reference") {
        return LightMethod::reference;
    }
    throw InputError("light is direct, full or reference, not '" + word + "'");
}

} // namespace framelet
