#include "tests/evaluation/method.h"

#include <algorithm>
#include <array>

#include "common/error.h"
#include "tests/evaluation/methods/methods.h"

namespace framelet::bench {
namespace {

struct KnownMethod {
    std::string_view name;
    std::unique_ptr<Method> (*make)(MethodSetup const&);
    bool batches = false;
    bool spacing = false;
    bool margin = false;
};

constexpr std::array<KnownMethod, 9> known_methods{{
    {"framed", make_framed, false, true},
    {"framed+h264", make_framed_h264, false, true},
    {"framed+warp", make_framed_warp, false, true, true},
    {"interruptible", make_interruptible},
    {"frameless", make_frameless},
    {"afr", make_afr},
    {"tsar", make_tsar, true},
    {"framelet-unwarped", make_framelet_unwarped, true},
    {"framelet", make_framelet, true},
}};

KnownMethod const& find_method(std::string_view name) {
    auto const found = std::ranges::find(known_methods, name, &KnownMethod::name);
    if (found != known_methods.end()) {
        return *found;
    }
    std::string known;
    for (std::string const& method : method_names()) {
        known += (known.empty() ? "" : ", ") + method;
    }
    throw InputError("no method is called '" + std::string(name) + "': there are " + known);
}

} // namespace

std::vector<std::string> const& method_names() {
    static std::vector<std::string> const names = [] {
        std::vector<std::string> all;
        for (KnownMethod const& method : known_methods) {
            all.emplace_back(method.name);
        }
        return all;
    }();
    return names;
}

bool has_batches(std::string_view name) {
    return find_method(name).batches;
}

bool has_spacing(std::string_view name) {
    return find_method(name).spacing;
}

bool has_margin(std::string_view name) {
    return find_method(name).margin;
}

std::unique_ptr<Method> make_method(std::string_view name, MethodSetup const& setup) {
    return find_method(name).make(setup);
}

} // namespace framelet::bench
