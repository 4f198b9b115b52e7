// Lets a fault in a scene file cost no more than what it concerns. In: the reading of one thing, and where lines about
// faults go. Out: whether the thing could be read; a line that names it where it could not.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "server/scene/reading/import_budget.h"

namespace framelet {

/// The name of a thing for messages: "mesh 3 'door'".
inline std::string named(char const* kind, std::size_t index, std::string const& name) {
    return std::string(kind) + " " + std::to_string(index) + (name.empty() ? "" : " '" + name + "'");
}

/// Lines about one thing, each of which begins with its name.
class Faults {
public:
    Faults(std::string what, std::vector<std::string>& lines) : what_(std::move(what)), lines_(lines) {}

    void note(std::string const& why) const { lines_.push_back(what_ + ": " + why); }

    /// Does the work. False where the file is wrong, which is noted with `outcome` behind it; a scene that is too large
    /// is one as a whole.
    template <typename Work>
    bool tried(Work const& work, char const* outcome) const {
        try {
            work();
            return true;
        } catch (SceneTooLarge const&) {
            throw;
        } catch (InputError const& error) {
            note(std::string(error.what()) + outcome);
            return false;
        }
    }

private:
    std::string what_;
    std::vector<std::string>& lines_;
};

} // namespace framelet
