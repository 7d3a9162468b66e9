// server/emulate/device_thread.hpp: an emulated device at work on a pseudo-terminal.
#pragma once

#include <atomic>
#include <filesystem>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "drivers/emulators/device.hpp"
#include "server/emulate/pty_port.hpp"

namespace server::emulate {

/// Moves bytes between a device and its port at the device's pace. A host that is set to another
/// rate hears garbage and is heard as garbage.
///
/// The device belongs to the thread that holds lock(): this thread, the world's, or one that
/// injects faults.
class DeviceThread {
 public:
  /// `device` outlives it.
  DeviceThread(std::string name, drivers::emulators::Device& device, std::filesystem::path link);
  ~DeviceThread();
  DeviceThread(const DeviceThread&) = delete;
  DeviceThread& operator=(const DeviceThread&) = delete;

  void start();
  const std::string& name() const { return name_; }
  std::unique_lock<std::mutex> lock() { return std::unique_lock(mutex_); }
  /// Its device has something to send: called after a change from outside.
  void wake();
  /// Pulls the plug and puts it back after `seconds`.
  void unplug(double seconds);
  /// Somebody has the port open.
  bool listened_to() const { return listened_to_; }
  /// Bytes that a host which does not read has lost.
  std::uint64_t overrun() const { return overrun_; }

 private:
  void run(const std::stop_token& stop);
  double exchange(double now);
  void carry_out(unsigned rate, const std::vector<std::uint8_t>& bytes);
  void plug(double now);
  void rest(double seconds);

  std::string name_;
  drivers::emulators::Device& device_;
  PtyPort port_;
  int wake_ = -1;
  std::mutex mutex_{};
  double plug_at_ = 0;  // [s] while unplugged
  int polled_ = -1;     // the thread's own
  std::vector<std::uint8_t> bytes_{};
  std::atomic<bool> listened_to_{false};
  std::atomic<std::uint64_t> overrun_{0};
  std::jthread thread_{};
};

}  // namespace server::emulate
