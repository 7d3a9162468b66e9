// server/cli/signals.hpp: ending a long-running command by a signal.
#pragma once

namespace server {

/// From now on SIGINT, SIGTERM, SIGUSR1 and SIGHUP set end_requested() instead of ending the
/// program, so that robots stop and records are closed in order. A SIGHUP that is ignored, as under
/// nohup, stays ignored. SIGPIPE and SIGXFSZ are ignored: a write to a closed pipe or beyond the
/// file size limit then fails like any other write.
void heed_signals();

/// True once one of these signals has come. From any thread.
bool end_requested();

}  // namespace server
