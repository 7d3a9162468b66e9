// server/cli/signals.cpp: the only place that handles signals.
#include "server/cli/signals.hpp"

#include <csignal>

namespace server {

namespace {
volatile std::sig_atomic_t g_end = 0;  // NOLINT: the only type a signal handler may write
}

void heed_signals() {
  const auto note = [](int) { g_end = 1; };
  std::signal(SIGINT, note);
  std::signal(SIGTERM, note);
  std::signal(SIGUSR1, note);
  if (std::signal(SIGHUP, note) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

bool end_requested() {
  return g_end != 0;
}

}  // namespace server
