// server/emulate/connection.hpp: the connection of an emulated device to the program that drives
// it.
#pragma once

#include <mutex>
#include <string>
#include <utility>

namespace server::emulate {

/// Only the thread that holds lock() may use the device: the connection's own thread, the world's,
/// or one that injects faults.
class Connection {
 public:
  explicit Connection(std::string name) : name_(std::move(name)) {}
  virtual ~Connection() = default;
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  virtual void start() = 0;
  /// Call after changing the device: it may have something to send.
  virtual void wake() = 0;
  /// Unplugs the device for `seconds`.
  virtual void unplug(double seconds) = 0;
  /// Whether a program has it open.
  virtual bool listened_to() const = 0;

  const std::string& name() const { return name_; }
  std::unique_lock<std::mutex> lock() { return std::unique_lock(mutex_); }

 private:
  std::string name_;
  std::mutex mutex_{};
};

/// A device and its connection.
template <class Device>
struct Served {
  Device* device = nullptr;
  Connection* connection = nullptr;
};

}  // namespace server::emulate
