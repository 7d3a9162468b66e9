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

/// Opens the port, retrying until it succeeds, and carries bytes and orders between it and a
/// machine. The machine is accessed only under the lock: with() gives access to other threads and
/// sends their orders at once. The thread never waits for the line under the lock, so a port cannot
/// delay a control tick.
class LineThread {
 public:
  /// `machine` must outlive this object.
  LineThread(std::string path, Machine& machine);
  /// Gives the machine up to `kLeaving` to leave its device in order.
  ~LineThread();
  LineThread(const LineThread&) = delete;
  LineThread& operator=(const LineThread&) = delete;

  static constexpr double kLeaving =
      12.0;  // [s] an LMS200 takes 3 for a mode switch, 2 or 3 while deaf, 3 for its rate

  /// Calls `action`, which may give orders, on the locked machine. From any thread.
  template <class Action>
  void with(Action&& action) {
    look(std::forward<Action>(action));
    wake();
  }
  /// As with(), for an action that gives no orders.
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
  std::jthread thread_;     // declared last: starts when all members above exist
};

}  // namespace drivers
