// Text of --help and the manual page of a program beside its options.
#pragma once

#include <string>
#include <vector>

namespace framelet {

struct ExitCode {
    int code;
    std::string means;
};

struct ProgramNotes {
    std::string text; ///< paragraphs, with an empty line between them
    std::vector<ExitCode> exit_codes;
    std::vector<std::string> see_also; ///< other programs
};

} // namespace framelet
