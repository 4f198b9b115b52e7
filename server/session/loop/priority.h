// Sets how a server shares the processors with the other programs of its machine.
#pragma once

namespace framelet {

/// Niceness of a server where none is given, which leaves it a quarter of a processor that a viewer wants too. The
/// viewer's pictures have to be in time, rendering does not.
inline constexpr int default_nice = 5;

/// Lets the calling thread, and all threads that it starts from now on, give way to programs of a smaller niceness;
/// what nobody else wants is theirs as before. `nice`: 0 to 19, see nice(2); a process that is nicer already stays so.
void give_way(int nice);

} // namespace framelet
