#include "server/session/admission.h"

#include <utility>

#include <spdlog/spdlog.h>

#include "protocol/messages/wrong_token.h"
#include "protocol/stream/token.h"

namespace framelet {
namespace {

ControlRule control_rule(Admission::Rules const& rules) {
    return rules.shared_control          ? ControlRule::everybody
           : rules.control_token.empty() ? ControlRule::first
                                         : ControlRule::token;
}

} // namespace

Admission::Admission(Rules rules, std::function<void()> given_up)
    : rules_(std::move(rules)), given_up_(std::move(given_up)), control_(control_rule(rules_)),
      memory_(rules_.memory_bytes, rules_.light_bytes) {}

bool Admission::knows_control_token(Hello const& hello) const {
    return !rules_.control_token.empty() && same_token(hello.token, rules_.control_token);
}

std::optional<Failure> Admission::refusal(Hello const& hello, std::string const& source, Time now) {
    if (hello.version != protocol_version) {
        return Failure{"this server speaks protocol version " + std::to_string(protocol_version) +
                       ", the viewer version " + std::to_string(hello.version) + ": install the same release on both"};
    }
    if (rules_.token.empty() || knows_control_token(hello) || same_token(hello.token, rules_.token)) {
        return std::nullopt;
    }
    if (!hello.token.empty()) { // which would be no guess
        guesses_.note_wrong(source, now);
        if (auto const more = wrong_tokens_.next(now)) {
            spdlog::warn("wrong token from {}{}", source, *more);
        }
    }
    return Failure{wrong_token_text};
}

std::shared_ptr<Session> Admission::session_left_behind(Hello const& hello) {
    Tickets::Holder const* const holder = hello.ticket ? tickets_.find(hello.ticket) : nullptr;
    return holder != nullptr && !holder->parked ? holder->session : nullptr;
}

void Admission::seat(std::shared_ptr<Session> const& session, Hello const& hello, Welcome& answer) {
    bool const knows_token = knows_control_token(hello);
    if (hello.codings == coding::none) {
        if (knows_token) {
            control_.enter(session->id(), 0, knows_token);
        }
        answer.controls = controls(session->id());
        return;
    }
    Tickets::Holder* holder = hello.ticket ? tickets_.find(hello.ticket) : nullptr;
    if (holder != nullptr && !resume(*holder, session, hello)) {
        give_up(*holder);
        holder = nullptr;
    }
    if (holder != nullptr) {
        answer.resumed = true;
        answer.evicted = session->status().evicted;
    } else {
        tickets_.issue({make_ticket(), session, session->id(), hello.codings, knows_token, std::nullopt});
        holder = tickets_.of(*session);
    }
    answer.ticket = holder->ticket;
    control_.enter(session->id(), holder->seat, knows_token);
    answer.controls = controls(session->id());
}

/// Lets a session go on with what its viewer had. False where the viewer is another one by what it knows and reads, or
/// lacks what is not kept any more.
bool Admission::resume(Tickets::Holder& holder, std::shared_ptr<Session> const& session, Hello const& hello) {
    auto const earlier = holder.session;
    if (holder.codings != hello.codings || holder.knows_control_token != knows_control_token(hello) ||
        !earlier->can_be_resumed(hello.last_batch)) {
        return false;
    }
    if (auto const more = returns_.next(std::chrono::steady_clock::now())) {
        spdlog::info("viewer {} is viewer {}, who has come back{}", session->number(), earlier->number(), *more);
    }
    memory_.pass(earlier->id(), session->id());
    session->resume(earlier, hello.last_batch);
    holder.session = session;
    holder.parked.reset();
    return true;
}

std::optional<std::string> Admission::reserve(std::uint64_t id, Viewport viewport, bool predicts) {
    auto refusal = memory_.reserve(id, viewport, predicts);
    while (refusal && give_up_longest_parked()) {
        refusal = memory_.reserve(id, viewport, predicts);
    }
    return refusal;
}

void Admission::leave(std::uint64_t id, Session const* session) {
    control_.leave(id);
    Tickets::Holder* const holder = session == nullptr ? nullptr : tickets_.of(*session);
    if (holder != nullptr && holder->session->is_parked()) {
        holder->parked = std::chrono::steady_clock::now();
    } else if (holder != nullptr) {
        give_up(*holder);
    } else {
        memory_.release(id);
    }
}

void Admission::keep_parked(std::size_t most) {
    while (tickets_.parked_count() > most) {
        give_up_longest_parked();
    }
}

void Admission::forget_viewers(std::size_t light_bytes) {
    memory_.set_more_per_pixel(light_bytes);
    while (auto const* const holder = tickets_.any()) {
        give_up(*holder);
    }
}

void Admission::give_up_who_stay_away(Time now) {
    while (auto const* const holder = tickets_.overdue(now)) {
        give_up(*holder);
    }
}

/// Gives up the viewer that has been away longest; false where nobody is away.
bool Admission::give_up_longest_parked() {
    Tickets::Holder const* const holder = tickets_.longest_parked();
    if (holder == nullptr) {
        return false;
    }
    give_up(*holder);
    return true;
}

/// Gives up a viewer that is away: it does not come back, or has to begin anew.
void Admission::give_up(Tickets::Holder const& holder) {
    std::shared_ptr<Session> const session = holder.session;
    tickets_.erase(&holder);
    session->abandon();
    memory_.release(session->id());
    given_up_();
}

} // namespace framelet
