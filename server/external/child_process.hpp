// server/external/child_process.hpp: a controller's process, its socket and what it prints.
#pragma once

#include <string>

#include <sys/types.h>

#include "server/external/message_socket.hpp"

namespace server::external {

/// The environment variable that holds the number of the child's socket.
constexpr const char* kSocketVariable = "TAUTLINE_CONTROLLER_FD";

/// A shell command in a process group of its own, so that Ctrl-C ends the run and not the child.
/// Belongs to one thread at a time.
class ChildProcess {
 public:
  /// Throws ControllerError if there is no process or no descriptor left.
  explicit ChildProcess(const std::string& command);
  ~ChildProcess();  // ask_to_end() and, where it must, SIGKILL
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// This side's end; call it once.
  Descriptor take_socket() { return std::move(socket_); }
  /// Reads what the child prints, without waiting.
  Aside aside();
  /// The last lines that it printed; empty if it printed nothing.
  std::string last_words();
  /// Waits a moment for the end of a child that has closed its socket. "ended with status 1", "was
  /// ended by signal 9", or "closed its socket" if it goes on.
  std::string how_it_ended();
  /// Sends SIGTERM, without waiting.
  void ask_to_end();

 private:
  void read_output();
  /// True if it has ended within `patience`.
  bool wait_for_end(std::chrono::milliseconds patience);

  Descriptor socket_{};
  Descriptor output_{};  // standard output and error, as one
  std::string tail_{};
  pid_t process_ = -1;  // -1: ended and reaped
  int status_ = 0;
};

}  // namespace server::external
