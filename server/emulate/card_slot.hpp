// server/emulate/card_slot.hpp: an emulated acquisition card that another program opens.
#pragma once

#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

#include "drivers/emulators/analog_emulator.hpp"
#include "drivers/emulators/card_memory.hpp"
#include "server/emulate/connection.hpp"

namespace server::emulate {

/// The library that opens such a card in place of libcomedi, next to this program. Throws
/// std::runtime_error with a sentence when it is missing.
std::filesystem::path emulated_comedi();

/// The card's file exists as long as this object, while the card is plugged in.
class CardSlot final : public Connection {
 public:
  /// `device` must outlive this object. Throws std::runtime_error with a sentence.
  CardSlot(std::string name,
           drivers::emulators::AnalogEmulator& device,
           std::filesystem::path path,
           const drivers::emulators::CardChannels& channels);
  ~CardSlot() override;

  void start() override;
  void wake() override {}
  void unplug(double seconds) override;
  bool listened_to() const override;

 private:
  void plug();

  drivers::emulators::AnalogEmulator& device_;
  std::filesystem::path path_;
  drivers::emulators::CardChannels channels_;
  std::optional<drivers::emulators::CardFile> card_{};
  double plug_at_ = 0;  // [s] while unplugged
  std::jthread thread_{};
};

}  // namespace server::emulate
