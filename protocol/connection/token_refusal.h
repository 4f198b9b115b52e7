// A server that refuses a viewer for its token: where the user can be asked, another may be given.
#pragma once

#include <string>

#include "common/error.h"

namespace framelet {

struct TokenRefusal : ConnectionRefusal {
    explicit TokenRefusal(std::string const& what_is_wrong)
        : ConnectionRefusal(what_is_wrong + ": start the viewer with --token-file"), complaint(what_is_wrong) {}

    std::string complaint; ///< one line, without what to do where nobody can be asked
};

} // namespace framelet
