// drivers/line_thread.hpp: the one thread between a port and a machine.
#pragma once

#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include "drivers/clock.hpp"
#include "drivers/machine.hpp"
#include "drivers/serial_port.hpp"

namespace drivers {

/// Opens the port, again and again until it is there, and carries bytes and orders between it and a
/// machine. The machine is touched under the lock alone: with() gives others a look, and what they
/// order is sent at once. The line itself is never waited for under the lock, so that a control
/// tick is not held up by a port.
class LineThread {
 public:
  /// `machine` outlives the thread.
  LineThread(std::string path, Machine& machine);
  /// Lets the machine leave its device in order, for `kLeaving` at most.
  ~LineThread();
  LineThread(const LineThread&) = delete;
  LineThread& operator=(const LineThread&) = delete;

  static constexpr double kLeaving =
      12.0;  // [s] an LMS200: 3 for a switch, 2 or 3 deaf, 3 for its rate

  /// Calls `action`, which may give orders, with the machine locked. From any thread.
  template <class Action>
  void with(Action&& action) {
    look(std::forward<Action>(action));
    wake();
  }
  /// The same for those who order nothing.
  template <class Action>
  void look(Action&& action) {
    const std::lock_guard lock(mutex_);
    std::forward<Action>(action)();
  }
  const std::string& path() const { return path_; }

 private:
  void wake() const;
  void run(const std::stop_token& stop);
  void serve(const std::stop_token& stop);
  double carry_out_orders(SerialPort& port);
  void send(SerialPort& port, const LineOrder& order) const;
  bool wait(const SerialPort* port, double seconds) const;
  bool leaving(const std::stop_token& stop);

  std::string path_;
  Machine& machine_;
  std::mutex mutex_{};
  int wake_ = -1;           // an eventfd: orders have been given
  double leave_until_ = 0;  // [s]
  bool left_ = false;       // the machine has been told to leave
  std::jthread thread_;     // last: starts when all above is there
};

}  // namespace drivers
