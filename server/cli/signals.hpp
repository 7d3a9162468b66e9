// server/cli/signals.hpp: how a command that goes on for long is ended.
#pragma once

namespace server {

/// From now on SIGINT, SIGTERM and SIGHUP set end_requested() instead of ending the program, so
/// that robots stop and records are closed in order; a SIGHUP that was ignored, as nohup does,
/// stays so. SIGPIPE and SIGXFSZ are ignored: a write that has nobody to read it, or makes a file
/// larger than it may be, then fails like any other.
void heed_signals();

/// True once one of them came. Any thread.
bool end_requested();

}  // namespace server
