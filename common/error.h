// The two kinds of failure. Our own mistake: CHECK, which aborts. The user's or the other side's: an exception with a
// type, whose message says what was wrong with which input and what to do, on one line.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <stdexcept>

namespace framelet {

/// Anything the user gave us that cannot be used: a file, an option's value.
struct InputError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The peer sent bytes that break the protocol; ends that session only.
struct ProtocolError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A message of this program would break the protocol, whatever in a scene or from a viewer has led to that; ends the
/// session that the message is for.
struct UnsendableMessage : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The connection could not be made, or ended.
struct ConnectionError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The connection could not be made, and would not be another time: the server is there and refuses this viewer.
struct ConnectionRefusal : ConnectionError {
    using ConnectionError::ConnectionError;
};

} // namespace framelet

/// Aborts with the place and the condition where an invariant of ours does not hold. Stays on in release builds.
#define FRAMELET_CHECK(condition)                                                                                      \
    do {                                                                                                               \
        if (!(condition)) [[unlikely]] {                                                                               \
            std::fprintf(stderr, "%s:%d: check failed: %s\n", __FILE__, __LINE__, #condition);                         \
            std::abort();                                                                                              \
        }                                                                                                              \
    } while (false)
