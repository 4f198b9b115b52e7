// Decides which viewers may set the scene's clock, which is one for all. In: viewers that come and go, in their order.
// Out: whether one may. A value.
#pragma once

#include <algorithm>
#include <compare>
#include <cstdint>
#include <set>

namespace framelet {

/// Who may set the clock: the viewer that has been there longest; those that know a token of its own; all.
enum class ControlRule : std::uint8_t { first, token, everybody };

class SceneControl {
public:
    explicit SceneControl(ControlRule rule) : rule_(rule) {}

    /// Adds a viewer. `seat` counts up from viewer to viewer; one that comes back has the seat that it had.
    void enter(std::uint64_t id, std::uint64_t seat, bool knows_token) {
        if (rule_ == ControlRule::first || knows_token) {
            candidates_.insert({seat, id});
        }
    }
    void leave(std::uint64_t id) {
        std::erase_if(candidates_, [id](Candidate const& candidate) { return candidate.id == id; });
    }

    bool controls(std::uint64_t id) const {
        switch (rule_) {
        case ControlRule::first:
            return !candidates_.empty() && candidates_.begin()->id == id;
        case ControlRule::token:
            return std::ranges::find(candidates_, id, &Candidate::id) != candidates_.end();
        case ControlRule::everybody:
            break;
        }
        return true;
    }

private:
    ControlRule rule_;
    struct Candidate {
        std::uint64_t seat = 0, id = 0;
        auto operator<=>(Candidate const&) const = default;
    };
    std::set<Candidate> candidates_;
};

} // namespace framelet
