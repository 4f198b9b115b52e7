// Signals that ask this program to end: it ends by itself, with what it writes complete, instead of being cut off.
#pragma once

namespace framelet {

/// From now on the first SIGINT, SIGTERM or SIGHUP is only noted. A second SIGINT or SIGTERM ends the program at once,
/// whatever it waits for; a SIGHUP never does, since a terminal that is closed may send two. Where SIGHUP is ignored,
/// as under nohup, it stays so.
void note_end_signals();

/// True once one of these has come.
bool is_told_to_end();

} // namespace framelet
