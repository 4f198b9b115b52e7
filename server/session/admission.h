// Decides who is let in, and keeps what each viewer has: its ticket, its memory, control of the scene's clock; also of
// those who are away. In: what viewers say of themselves, sessions as they come and go. Out: refusals, the viewer's own
// part of its Welcome.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "protocol/messages/message.h"
#include "server/session/clock/scene_control.h"
#include "server/session/limits/log_limit.h"
#include "server/session/limits/session_memory.h"
#include "server/session/limits/token_guesses.h"
#include "server/session/session.h"
#include "server/session/tickets.h"

namespace framelet {

/// May be used on the io thread only.
class Admission {
public:
    using Time = std::chrono::steady_clock::time_point;

    struct Rules {
        std::string token; ///< what a viewer has to say; empty: nothing
        std::string control_token; ///< who says it is let in as well, and may set the scene's clock; empty: nobody
        bool shared_control = false; ///< every viewer may set the clock; else, without a control token, the first may
        std::size_t memory_bytes; ///< of all viewers
        std::size_t light_bytes = 0; ///< of each pixel, for its light
    };

    /// `given_up` is called after each viewer that has been given up.
    Admission(Rules rules, std::function<void()> given_up);

    /// Time that somebody who connects from this source has to wait.
    Time::duration delay(std::string const& source, Time now) const { return guesses_.delay(source, now); }
    /// Reason why a viewer that says this is not let in; nothing: it may be. A wrong token is noted.
    std::optional<Failure> refusal(Hello const& hello, std::string const& source, Time now);
    /// False where it takes the control token to be a worker, whose light all viewers see, and this is not said.
    bool may_work(Hello const& hello) const { return rules_.control_token.empty() || knows_control_token(hello); }
    /// The session of the viewer that says it comes back, where the server has not noticed yet that it had gone.
    std::shared_ptr<Session> session_left_behind(Hello const& hello);
    /// Gives a session that is let in what its viewer had, if that is still there, or a ticket of its own. Who hears
    /// the clock only has nothing to come back to, and takes no turn to set it.
    void seat(std::shared_ptr<Session> const& session, Hello const& hello, Welcome& answer);
    /// True where this session may set the scene's clock.
    bool controls(std::uint64_t id) const { return control_.controls(id); }
    /// Sets memory aside, as `SessionMemory::reserve`. Viewers that are away leave their memory to those that are here.
    std::optional<std::string> reserve(std::uint64_t id, Viewport viewport, bool predicts);

    /// Gives back all that the session had, but what a viewer that comes back goes on with. Needs no memory to do so.
    /// `session` is null where there is none of this number.
    void leave(std::uint64_t id, Session const* session);
    /// Lets at most `most` of those who are away, the last to go, come back; gives up the others.
    void keep_parked(std::size_t most);
    /// Nobody who was let in so far comes back, whether the server has noticed that they are gone or not: what they had
    /// is of another scene. With this one each pixel takes `light_bytes` for its light.
    void forget_viewers(std::size_t light_bytes);
    /// True where somebody who is away may come back.
    bool expects_somebody() const { return tickets_.parked_count() > 0; }
    /// Gives up those who have been away for too long.
    void give_up_who_stay_away(Time now);

private:
    static constexpr std::size_t most_returns = 20; ///< lines of them in an interval of the log

    bool knows_control_token(Hello const& hello) const;
    bool resume(Tickets::Holder& holder, std::shared_ptr<Session> const& session, Hello const& hello);
    bool give_up_longest_parked();
    void give_up(Tickets::Holder const& holder);

    Rules const rules_;
    std::function<void()> const given_up_;
    SceneControl control_;
    SessionMemory memory_;
    Tickets tickets_;
    TokenGuesses guesses_;
    LogLimit wrong_tokens_, returns_{most_returns};
};

} // namespace framelet
