// Which viewers may set the scene's clock, which is one for all. In: viewers that come and go, in their order. Out:
// whether one may. A value.
#pragma once

#include <cstdint>
#include <set>

namespace framelet {

/// The viewer that has been there longest; those that know a token of its own; all.
enum class ControlRule : std::uint8_t { first, token, everybody };

class SceneControl {
public:
    explicit SceneControl(ControlRule rule) : rule_(rule) {}

    /// `id` counts up from viewer to viewer.
    void enter(std::uint64_t id, bool knows_token) {
        if (rule_ == ControlRule::first || knows_token) {
            candidates_.insert(id);
        }
    }
    void leave(std::uint64_t id) { candidates_.erase(id); }

    bool controls(std::uint64_t id) const {
        switch (rule_) {
        case ControlRule::first:
            return !candidates_.empty() && *candidates_.begin() == id;
        case ControlRule::token:
            return candidates_.contains(id);
        case ControlRule::everybody:
            break;
        }
        return true;
    }

private:
    ControlRule rule_;
    std::set<std::uint64_t> candidates_;
};

} // namespace framelet
