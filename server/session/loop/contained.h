// A session's failure is its own. In: something that is done for one session. Out: whether it was done; where it threw,
// that session has ended with a line that says why, and the others go on.
#pragma once

#include <exception>
#include <new>
#include <string>

#include "server/session/session.h"
#include "server/stream/posed_scene.h"

namespace framelet {

/// True where the viewer is to come back as it was: what has failed was not its own.
inline bool may_come_again(std::exception const& error) {
    return dynamic_cast<SceneUnposed const*>(&error) != nullptr;
}

/// The line by which the viewer and the log are told why its session ends.
inline std::string failure_line(std::exception const& error) {
    if (may_come_again(error)) {
        return "the server has not enough memory left for its scene at the moment: try again";
    }
    if (dynamic_cast<std::bad_alloc const*>(&error) != nullptr) {
        return "the server has not enough memory left for this viewer's picture: ask for a smaller one";
    }
    return std::string("the server cannot go on with this viewer's picture: ") + error.what();
}

/// Ends a session where there is no memory to say why. The server finds it ended.
inline void end_in_need(Session& session, bool again) {
    try {
        session.end("no memory left", again); // short enough to need none
    } catch (std::bad_alloc const&) {
    }
}

/// Does `work`, which is for this session. False where that threw: the session has ended then.
template <typename Work>
bool contain(Session& session, Work const& work) {
    try {
        work();
        return true;
    } catch (std::exception const& error) {
        try {
            session.end(failure_line(error), may_come_again(error));
        } catch (std::bad_alloc const&) {
            end_in_need(session, may_come_again(error));
        }
        return false;
    }
}

} // namespace framelet
