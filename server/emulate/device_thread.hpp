// server/emulate/device_thread.hpp: an emulated device on a pseudo-terminal.
#pragma once

#include <atomic>
#include <filesystem>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "drivers/emulators/device.hpp"
#include "server/emulate/connection.hpp"
#include "server/emulate/pty_port.hpp"

namespace server::emulate {

/// Moves bytes between a device and its port at the device's rate. At a wrong rate, host and device
/// each receive garbage.
class DeviceThread final : public Connection {
 public:
  /// `device` must outlive this object.
  DeviceThread(std::string name, drivers::emulators::Device& device, std::filesystem::path link);
  ~DeviceThread() override;

  void start() override;
  void wake() override;
  void unplug(double seconds) override;
  bool listened_to() const override { return listened_to_; }
  /// Bytes lost because the host does not read.
  std::uint64_t overrun() const { return overrun_; }

 private:
  void run(const std::stop_token& stop);
  double exchange(double now);
  void carry_out(unsigned rate, const std::vector<std::uint8_t>& bytes);
  void plug(double now);
  void rest(double seconds);

  drivers::emulators::Device& device_;
  PtyPort port_;
  int wake_ = -1;
  double plug_at_ = 0;  // [s] while unplugged
  int polled_ = -1;     // used only by the thread
  std::vector<std::uint8_t> bytes_{};
  std::atomic<bool> listened_to_{false};
  std::atomic<std::uint64_t> overrun_{0};
  std::jthread thread_{};
};

}  // namespace server::emulate
