#include "server/render/light/light_options.h"

#include <algorithm>

#include "common/error.h"

namespace framelet {
namespace {

struct Word {
    LightMethod method;
    char const* word;
};
constexpr Word words[] = {
    {LightMethod::direct, "direct"}, {LightMethod::full, "full"}, {LightMethod::reference, "reference"}};

} // namespace

LightMethod parse_light_method(std::string const& word) {
    for (Word const& each : words) {
        if (word == each.word) {
            return each.method;
        }
    }
    throw InputError("light is direct, full or reference, not '" + word + "'");
}

char const* name_of(LightMethod method) {
    return std::ranges::find(words, method, &Word::method)->word;
}

} // namespace framelet
