// server/emulate/emulation.hpp: emulated devices in one world, their links and injected faults.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/emulators/analog_emulator.hpp"
#include "drivers/emulators/base.hpp"
#include "drivers/emulators/lms200_emulator.hpp"
#include "drivers/emulators/p2os_emulator.hpp"
#include "drivers/emulators/psd_emulator.hpp"
#include "drivers/emulators/roboteq_emulator.hpp"
#include "server/emulate/card_slot.hpp"
#include "server/emulate/device_thread.hpp"
#include "server/emulate/emulated_world.hpp"
#include "server/emulate/log_player.hpp"
#include "server/emulate/truth_record.hpp"
#include "sim/scenario.hpp"

namespace server::emulate {

enum class BaseKind : std::uint8_t { None, P2os, Roboteq, Analog };

struct EmulationOptions {
  sim::Scenario scenario{};
  std::filesystem::path log{};  // replaces the scenario for one scanner
  std::uint64_t seed = 1;
  drivers::lms200::EmulatorOptions scanner{};
  bool near_wrap = false;                   // the base's counters start shortly before they wrap
  double watchdog = 0;                      // [s] of the base; 0: factory setting
  drivers::emulators::LineFaults faults{};  // of all lines
  std::filesystem::path record{};
  std::vector<std::filesystem::path> scanner_links{};  // one for each scanner
  BaseKind base = BaseKind::None;
  std::filesystem::path base_link{};
  drivers::emulators::CardChannels card{};  // of an analog base
  std::filesystem::path psd_link{};         // of the floor sensors' adapter; empty: none
};

/// The commands of command(), one line each, for --help.
std::string command_help();

class Emulation {
 public:
  /// Makes the links. Throws std::exception with a sentence.
  explicit Emulation(const EmulationOptions& options);
  ~Emulation();

  void start();
  /// Executes a line such as "scanner silence 2" and returns the answer, which may be empty. Throws
  /// std::invalid_argument with a sentence for an invalid line.
  std::string command(std::string_view line);
  /// One line of JSON: the robot's pose, and counts of scans and commands.
  std::string truth();

 private:
  struct Scanner;
  struct Base;
  struct Psd;

  void add_scanner(const EmulationOptions& options, std::size_t index);
  static std::unique_ptr<Base> make_base(const EmulationOptions& options);
  void add_base(const EmulationOptions& options);
  void add_psd(const EmulationOptions& options);

  TruthRecord record_;
  std::vector<std::unique_ptr<Scanner>> scanners_{};
  std::unique_ptr<Base> base_{};
  std::unique_ptr<Psd> psd_{};
  std::unique_ptr<EmulatedWorld> world_{};
  std::unique_ptr<LogPlayer> player_{};
};

}  // namespace server::emulate
