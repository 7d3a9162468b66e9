// server/emulate/card_slot.cpp: plugging and unplugging an emulated card.
#include "server/emulate/card_slot.hpp"

#include <chrono>
#include <stdexcept>
#include <utility>

#include <spdlog/spdlog.h>

#include "server/emulate/clock.hpp"

namespace server::emulate {

namespace fs = std::filesystem;

fs::path emulated_comedi() {
  fs::path path = fs::read_symlink("/proc/self/exe").parent_path() / "libemulated_comedi.so";
  if (!fs::exists(path)) throw std::runtime_error(path.string() + " is missing; build it first.");
  return path;
}

CardSlot::CardSlot(std::string name,
                   drivers::emulators::AnalogEmulator& device,
                   fs::path path,
                   const drivers::emulators::CardChannels& channels)
    : Connection(std::move(name)), device_(device), path_(std::move(path)), channels_(channels) {
  plug();
}

CardSlot::~CardSlot() {
  thread_ = {};
  const auto held = lock();
  device_.attach(nullptr);
}

void CardSlot::plug() {
  card_.emplace(path_, channels_);
  device_.attach(&card_->memory());
}

void CardSlot::unplug(double seconds) {
  const auto held = lock();
  device_.attach(nullptr);
  card_.reset();
  plug_at_ = machine_time() + seconds;
}

bool CardSlot::listened_to() const {
  return card_ && card_->memory().opened > 0;
}

void CardSlot::start() {
  thread_ = std::jthread([this](const std::stop_token& stop) {
    constexpr std::chrono::milliseconds kLook{10};
    for (; !stop.stop_requested(); std::this_thread::sleep_for(kLook)) {
      const auto held = lock();
      const double now = machine_time();
      if (card_ || now < plug_at_) continue;
      try {
        plug();
      } catch (const std::runtime_error& error) {
        spdlog::error("{}: {} Trying again.", name(), error.what());
        plug_at_ = now + 1;
      }
    }
  });
}

}  // namespace server::emulate
