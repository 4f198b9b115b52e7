// How a server shares the processors with the other programs of its machine.
#pragma once

namespace framelet {

/// What a server takes where nothing is said: a quarter of a processor that a viewer wants too. The
/// viewer's pictures have to be in time, rendering does not.
inline constexpr int default_nice = 5;

/// The calling thread, and all threads that it starts from now on, give way to programs of a smaller niceness; what
/// nobody else wants is theirs as before. 0 to 19, see nice(2); a process that is nicer already stays so.
void give_way(int nice);

} // namespace framelet
