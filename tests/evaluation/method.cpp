#include "tests/evaluation/method.h"

#include <array>
#include <utility>

#include "common/error.h"
#include "tests/evaluation/methods/methods.h"

namespace framelet::bench {
namespace {

using Maker = std::unique_ptr<Method> (*)(MethodSetup const&);

constexpr std::array<std::pair<std::string_view, Maker>, 7> makers{{
    {"framed", make_framed},
    {"framed+jpeg", make_framed_jpeg},
    {"framed+h264", make_framed_h264},
    {"frameless", make_frameless},
    {"afr", make_afr},
    {"tsar", make_tsar},
    {"framelet", make_framelet},
}};

} // namespace

std::vector<std::string> const& method_names() {
    static std::vector<std::string> const names = [] {
        std::vector<std::string> all;
        for (auto const& maker : makers) {
            all.emplace_back(maker.first);
        }
        return all;
    }();
    return names;
}

std::unique_ptr<Method> make_method(std::string_view name, MethodSetup const& setup) {
    for (auto const& [known, make] : makers) {
        if (known == name) {
            return make(setup);
        }
    }
    std::string known;
    for (std::string const& method : method_names()) {
        known += (known.empty() ? "" : ", ") + method;
    }
    throw InputError("no method is called '" + std::string(name) + "': there are " + known);
}

} // namespace framelet::bench
