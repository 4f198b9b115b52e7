// Ends a program that was compiled for x86-64-v3 with one line where the processor is an older one, instead of by an
// instruction that it does not know.
#include <cerrno>
#include <cstring>

#include <unistd.h>

namespace {

void say(char const* text) {
    [[maybe_unused]] auto const ignored = ::write(STDERR_FILENO, text, std::strlen(text));
}

/// Priority 101: runs before all other initialisation of the program, which is compiled with these instructions. That
/// of its libraries has run by then.
[[gnu::constructor(101)]] void require_processor() {
    __builtin_cpu_init();
    if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma") || !__builtin_cpu_supports("bmi") ||
        !__builtin_cpu_supports("bmi2")) {
        say(program_invocation_short_name);
        say(": this processor lacks AVX2 or FMA, which this build needs (x86-64-v3): build from source on this "
            "machine\n");
        ::_exit(1);
    }
}

} // namespace
