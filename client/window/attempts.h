// Attempts to connect to one server, again and again, while the window goes on. In: where it is. Out: a session; until
// then, what is said of it.
#pragma once

#include <chrono>
#include <future>
#include <memory>
#include <optional>
#include <random>
#include <string>

#include "client/core/client_core.h"
#include "client/window/overlay/overlay_content.h"
#include "protocol/connection/back_off.h"
#include "protocol/connection/unknown_certificate.h"

namespace framelet {

/// Connects so that news wake the window. Throws as ServerConnection does.
std::unique_ptr<ClientCore> connect_for_window(ConnectionOptions const& options);

/// Tries for as long as it takes, less often the longer. A server that refuses the viewer, for which trying again would
/// not help, is tried once. An attempt that is given up is not waited for: its thread ends by itself.
class Attempts {
public:
    /// `is_typed`: the user has just named the server.
    explicit Attempts(ConnectionOptions options, bool is_typed = false)
        : options_(std::move(options)), is_typed_(is_typed) {}

    ConnectionOptions const& options() const { return options_; }
    bool has_failed() const { return !failure_.empty(); } ///< at least once
    /// Text for the user, with the keys that `hurry` is for, or the question below.
    std::string message() const;
    /// The field to be typed into after a failure: it takes the keys.
    ServerField field_at_fault() const;
    /// True where the user is to say whether the server's certificate is to be trusted: then `trust`, or no more
    /// attempts.
    bool asks_trust() const { return unknown_.has_value(); }
    /// Trusts it from now on, and tries again.
    void trust();

    /// Tries at once, also a server that has refused.
    void hurry();
    /// The session once there is one, else null; begins attempts when they are due. `is_refusal_fatal`: a refusal is
    /// thrown, but for a certificate that the user may trust.
    std::unique_ptr<ClientCore> poll(bool is_refusal_fatal = false);

private:
    using Clock = std::chrono::steady_clock;
    /// `line`: what the terminal is told of it.
    void note(std::string const& failure, std::string const& line);

    ConnectionOptions options_;
    bool is_typed_;
    std::future<std::unique_ptr<ClientCore>> attempt_;
    std::string failure_; ///< of the last attempt; empty: none has ended
    std::optional<UnknownCertificate> unknown_; ///< what the last attempt has met
    bool is_token_wrong_ = false; ///< the last attempt was refused for it
    bool is_refused_ = false; ///< no other attempt follows by itself
    BackOff back_off_;
    std::minstd_rand random_{std::random_device{}()};
    Clock::time_point next_ = Clock::now();
};

} // namespace framelet
