// drivers/lms200_protocol.hpp: requests to an LMS2xx, and its answers except for measured values
// (drivers/lms200_scan.hpp).
//
// Sources: SICK, Telegrams for Configuring and Operating the LMS2xx (2006), checked against public
// drivers and a recording. No I/O and no clock: see drivers/lms200_telegram.hpp for the line.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "drivers/bytes.hpp"
#include "drivers/lms200_telegram.hpp"

namespace drivers::lms200 {

/// The longest, writing the configuration, has 41 bytes.
using Command = FixedBytes<48>;

/// A field of view and its step in the device's units: degrees and hundredths of a degree.
struct Variant {
  std::uint16_t angle_degrees = 180;      // 100 or 180
  std::uint16_t step_centidegrees = 100;  // 100, 50 or 25

  /// Beams of a whole scan, both ends included.
  std::size_t beams() const { return angle_degrees * 100U / step_centidegrees + 1U; }
  /// Mirror turns per whole scan: each turn measures once per degree.
  std::uint32_t turns() const { return 100U / step_centidegrees; }
  bool operator==(const Variant&) const = default;
};

/// 180 degrees in steps of 0.25 exist only as interlaced partial scans. The device has no such
/// variant, so variant_command() has no telegram for it.
bool exists(const Variant& variant);

enum class Rate : std::uint8_t { Baud38400 = 0x40, Baud19200, Baud9600, Baud500000 = 0x48 };
/// [bit/s]
unsigned baud_of(Rate rate);
constexpr unsigned kStartRate = 9600;  // [bit/s] of the greeting of a starting device

enum class Mode : std::uint8_t {
  Installation = 0x00,  // needs the password
  Diagnosis = 0x10,
  Continuous = 0x24,
  OnRequest = 0x25,        // after power-on
  ContinuousMeans = 0x26,  // needs a number of scans
  ContinuousRange = 0x27,  // takes first and last value
  ContinuousMeanRange = 0x28,
  PartialScans = 0x2A,  // one after each mirror turn
};

enum class StartUpRate : std::uint8_t { Baud9600 = 0, KeepPresent = 1, KeepType = 2 };

/// First and last value, counted from 1 as in the device, both included.
struct ValueRange {
  std::uint16_t first = 1;
  std::uint16_t last = 361;
  bool operator==(const ValueRange&) const = default;
};

constexpr std::string_view kFactoryPassword = "SICK_LMS";

/// The part of the configuration that a driver reads and changes. Old devices have a shorter block,
/// so it keeps the size that the device sent.
class Configuration {
 public:
  static constexpr std::size_t kBytes = 34;

  Configuration() = default;
  explicit Configuration(ByteView block) : size_(std::min(block.size(), kBytes)) {
    std::copy_n(block.begin(), size_, block_.begin());
  }

  ByteView block() const { return ByteView(block_).first(size_); }
  bool sends_indices() const { return (block_[kAvailability] & 2U) != 0; }
  std::uint8_t measuring_mode() const { return block_[kMeasuringMode]; }
  bool in_millimetres() const { return block_[kUnit] == 1; }

  void set_measuring_mode(std::uint8_t mode) { block_[kMeasuringMode] = mode; }
  void set_millimetres(bool on) { block_[kUnit] = on ? 1 : 0; }
  bool operator==(const Configuration&) const = default;

 private:
  static constexpr std::size_t kAvailability = 4;
  static constexpr std::size_t kMeasuringMode = 5;
  static constexpr std::size_t kUnit = 6;

  std::array<std::uint8_t, kBytes> block_{};
  std::size_t size_ = 0;
};

// ---- requests, framed; `address` 0 is broadcast ----------------------------------------------

Command status_command(std::uint8_t address = kEverybody);
Command type_command(std::uint8_t address = kEverybody);
Command rate_command(Rate rate, std::uint8_t address = kEverybody);
/// Modes without parameters.
Command mode_command(Mode mode, std::uint8_t address = kEverybody);
/// `password` must have 8 characters; otherwise the result is empty.
Command installation_command(std::string_view password = kFactoryPassword,
                             std::uint8_t address = kEverybody);
/// Empty for a variant that does not exist.
Command variant_command(const Variant& variant, std::uint8_t address = kEverybody);
Command read_configuration_command(std::uint8_t address = kEverybody);
/// Wears out the device's memory: send it only for a block that differs from the one read. Needs
/// installation mode.
Command write_configuration_command(const Configuration& configuration,
                                    std::uint8_t address = kEverybody);

// ---- answers ---------------------------------------------------------------------------------

enum class Answer : std::uint8_t {
  PowerOn = 0x90,  // after a restart: 9600 bit/s, on request, stored variant
  ResetConfirmed = 0x91,
  Refused = 0x92,
  Mode = 0xA0,
  Values = 0xB0,
  Status = 0xB1,
  Errors = 0xB2,
  Means = 0xB6,
  RangeValues = 0xB7,
  Type = 0xBA,
  Variant = 0xBB,
  MeanRange = 0xBF,
  StartUpRate = 0xE6,
  Configuration = 0xF4,
  ConfigurationWritten = 0xF7,
  SecondConfiguration = 0xFB,
  SecondConfigurationWritten = 0xFC,
};

/// The last byte of every answer.
class Health {
 public:
  explicit Health(std::uint8_t byte = 0x10) : byte_(byte) {}

  /// 0 good, 1 info, 2 warning, 3 error, 4 fatal.
  unsigned level() const { return byte_ & 7U; }
  bool implausible() const { return (byte_ & 0x40U) != 0; }
  bool polluted() const { return (byte_ & 0x80U) != 0; }
  /// Whether a robot may drive by values sent with this status.
  bool usable() const { return level() < 3 && !implausible(); }
  bool operator==(const Health&) const = default;

 private:
  std::uint8_t byte_;
};

/// The fault as a sentence; empty without one.
std::string health_text(Health health);

/// Why a request was refused; empty when it was done, or when `telegram` is no such answer.
std::string refusal_text(const Telegram& telegram);

/// Answer to type_command(), or the greeting after power-on: "LMS200;301063;V02.30 ".
std::optional<std::string_view> type_text(const Telegram& telegram);

struct VariantAnswer {
  bool done = false;
  Variant now{};
  bool operator==(const VariantAnswer&) const = default;
};
std::optional<VariantAnswer> variant_answer(const Telegram& telegram);

/// Reading sets `done`. After writing, `now` is the block in force: compare it with the one sent.
struct ConfigurationAnswer {
  bool done = false;
  Configuration now{};
};
std::optional<ConfigurationAnswer> configuration_answer(const Telegram& telegram);

struct DeviceStatus {
  std::string_view software{};  // 7 characters; valid as long as the telegram
  bool faulty = false;
  std::uint8_t measuring_mode = 0;
  Variant variant{};
  bool in_millimetres = false;
};
std::optional<DeviceStatus> device_status(const Telegram& telegram);

}  // namespace drivers::lms200
