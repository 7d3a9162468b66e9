// tests/drivers/fake_card.hpp: an acquisition card whose voltages and counts the test sets.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "drivers/analog_card.hpp"

namespace drivers {

/// The devices wired to the card.
struct Wiring {
  Volts volts{-1, -1};
  CardInputs inputs{};
  unsigned relay_changes = 0;
  bool relay_line = false;
  bool enabled = false;
  std::atomic<bool> gone{false};
  std::atomic<bool> refuses_volts{false};
  std::atomic<unsigned> opened{0};
};

class FakeCard final : public AnalogCard {
 public:
  /// Throws CardError while the card is gone.
  explicit FakeCard(Wiring& wiring) : wiring_(wiring) {
    check();
    ++wiring_.opened;
  }

  void write(const Volts& volts) override {
    check();
    if (wiring_.refuses_volts) throw CardError("The card accepts no voltage.");
    wiring_.volts = volts;
  }
  CardInputs read() override {
    check();
    return wiring_.inputs;
  }
  void set_relay_line(bool high) override {
    check();
    wiring_.relay_changes += high != wiring_.relay_line ? 1 : 0;
    wiring_.relay_line = high;
  }
  void set_enabled(bool enabled) override {
    check();
    wiring_.enabled = enabled;
  }
  std::vector<std::pair<std::string, std::string>> facts() const override {
    return {{"kind", "fake"}};
  }

 private:
  void check() const {
    if (wiring_.gone) throw CardError("The card has gone.");
  }

  Wiring& wiring_;
};

}  // namespace drivers
