#include "server/session/limits/token_guesses.h"

#include <algorithm>

namespace framelet {

void TokenGuesses::note_wrong(std::string const& source, WallTime now) {
    Wrong& wrong = sources_[source];
    wrong.count = now - wrong.last > memory ? 1 : wrong.count + 1;
    wrong.last = now;
    if (sources_.size() > most_sources) {
        sources_.erase(std::min_element(sources_.begin(), sources_.end(), [](auto const& one, auto const& two) {
            return one.second.last < two.second.last;
        }));
    }
}

WallTime::duration TokenGuesses::delay(std::string const& source, WallTime now) const {
    auto const found = sources_.find(source);
    if (found == sources_.end() || now - found->second.last > memory) {
        return {};
    }
    WallTime::duration delay = first_delay;
    for (int i = 1; i < found->second.count && delay < longest_delay; ++i) {
        delay *= 2;
    }
    return std::min<WallTime::duration>(delay, longest_delay);
}

} // namespace framelet
