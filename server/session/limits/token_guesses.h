// Remembers who said a wrong token lately, and how long the next connection of the same source has to wait for that.
// In: sources, and the time. Out: a delay.
#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <string>

#include "server/session/limits/wall_time.h"

namespace framelet {

class TokenGuesses {
public:
    /// Delay after the first wrong token; each further one doubles it.
    static constexpr std::chrono::milliseconds first_delay{250};
    static constexpr std::chrono::milliseconds longest_delay{2000};
    /// A source that has said none for so long begins anew.
    static constexpr std::chrono::seconds memory{60};
    /// Most sources that are remembered: of more the one that was wrong longest ago is forgotten.
    static constexpr std::size_t most_sources = 4096;

    /// Notes that somebody at `source` has said a wrong token.
    void note_wrong(std::string const& source, WallTime now);
    /// Time that the next connection from `source` has to wait; 0 where no wrong token is remembered of it.
    WallTime::duration delay(std::string const& source, WallTime now) const;

private:
    struct Wrong {
        int count = 0;
        WallTime last{};
    };
    std::map<std::string, Wrong> sources_;
};

} // namespace framelet
