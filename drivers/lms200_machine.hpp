// drivers/lms200_machine.hpp: finds an LMS2xx, sets it up, receives its scans and leaves it.
//
// Bytes and times in, telegrams and scans out; drivers/lms200_device.hpp adds the thread.
//
//   NoLine > Probe (each rate) > Type > Status > Rate > Variant > Installation > configuration
//          > Start > Streaming           no answer: Listen for a greeting, then Probe again
//
// A mode switch may take 3 s, and for seconds after one or after power-on the device may neither
// hear nor answer. So the machine waits for an acknowledged request and repeats any other.
// When the device falls silent or restarts, the search starts again from the beginning.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "algo/laser_scan.hpp"
#include "drivers/lms200_protocol.hpp"
#include "drivers/lms200_scan.hpp"
#include "drivers/machine.hpp"

namespace drivers::lms200 {

constexpr unsigned kFallbackRate = 38400;  // [bit/s] every port and plug can do it

/// The wanted settings of the device.
struct LaserSetup {
  unsigned baud = 500'000;   // [bit/s] wanted; the search covers all rates
  Variant variant{180, 50};  // 180 degrees at 0.25 come as interlaced partial scans
  unsigned range = 8;        // [m] 8, 16 or 32 in millimetres, 80 in centimetres
  bool upside_down = false;
  bool as_it_is = false;  // keep the device's rate, variant and configuration
  std::string password{kFactoryPassword};
};

/// Whether `password` is one the device accepts: eight printable ASCII characters.
bool good_password(std::string_view password);
/// Why no device can satisfy `setup`; empty when one can.
std::string refusal(const LaserSetup& setup);

enum class Stage : std::uint8_t { NoLine, Searching, SettingUp, Running };

/// The dazzled bearings of the newest scan [rad, scanner frame, left positive].
struct Dazzled {
  double from = 0;
  double to = 0;
};

/// The state of the scanner for users.
struct LaserReport {
  Stage stage = Stage::NoLine;
  std::string trouble{};               // why there are no scans; empty while Running
  std::vector<std::string> remarks{};  // settings that differ from the wanted ones
  std::string type{};                  // "LMS200;301063;V02.30"
  std::string software{};
  unsigned baud = 0;  // [bit/s] found or agreed upon
  std::uint8_t address = 0;
  Variant variant{};
  std::uint8_t measuring_mode = 0;
  bool in_millimetres = true;
  Health health{};
  LineCounters line{};
  std::uint64_t scans = 0;
  std::uint64_t replaced = 0;  // scans replaced by a newer one before they were read
  std::uint64_t set_ups = 0;   // times the device was found and set up
  std::uint64_t written = 0;   // times the configuration was written
  double damaged = 0;          // recent share of damaged telegrams, 0..1
  bool storm = false;          // too many damaged, until far fewer are
  bool blinded = false;        // most beams of the newest scan measured nothing
  std::optional<Dazzled> dazzled{};
  double scan_period = 0;     // [s] measured, or the least at its rate
  double nominal_period = 0;  // [s] the least at its rate
  double last_scan = 0;       // [s] steady clock, arrival of the newest scan; 0: none yet
};

class LaserMachine final : public Machine {
 public:
  explicit LaserMachine(LaserSetup setup);

  unsigned opening_baud() const override { return wanted_; }
  void opened(double now, unsigned baud) override;
  void closed(double now, const std::string& why) override;
  void rate_set(double now, unsigned baud) override;
  void receive(double now, ByteView bytes) override;
  void advance(double now) override;
  double wake_time() const override;
  std::optional<LineOrder> next_order() override { return orders_.next(); }
  void leave(double now) override;
  bool left() const override { return step_ == Step::Left; }

  /// Swaps `scan` with the newest scan; false when it was taken already. The stamp is the end of
  /// its last mirror turn on the steady clock, before transmission. The caller sets its mount.
  bool take(algo::LaserScan& scan);
  Stage stage() const;
  LaserReport report() const;
  /// [s] As in Report.
  double scan_period() const { return period_; }
  double last_scan() const { return last_scan_; }
  double damaged() const { return damaged_; }
  /// More than half of the telegrams were damaged, and the line has not recovered since.
  bool storm() const { return storm_; }
  Health health() const { return health_; }
  /// Most beams of the newest scan, within 45 degrees of its middle, measured nothing.
  bool blinded() const { return blinded_; }

 private:
  enum class Step : std::uint8_t {
    NoLine,
    Probe,
    Listen,
    Type,
    Status,
    Rate,
    RateSettles,
    RateConfirmed,
    Variant,
    Installation,
    ReadConfiguration,
    WriteConfiguration,
    Start,
    Streaming,
    Stopping,
    Restoring,
    Left,
  };

  void search(double now);
  void probe(double now);
  void listen(double now);
  void begin(Step step, double now);
  void request(double now);
  Command command_for(Step step) const;
  double limit_for(Step step) const;
  int tries_for(Step step) const;
  void take_telegram(double now, ByteView frame);
  void take_stray(std::uint8_t byte);
  bool waits_on(double now);
  bool asks_again(double now) const;
  bool takes_all_for_damaged() const;
  std::string damaged_words() const;
  bool answers(const Telegram& telegram) const;
  void answered(double now, const Telegram& telegram);
  void unanswered(double now);
  void identified(double now);
  void rate_answered(double now, const Telegram& telegram);
  void choose_variant(double now);
  void restore_rate(double now);
  void variant_answered(double now, const Telegram& telegram);
  void configuration_read(double now, const Telegram& telegram);
  void configuration_written(double now, const Telegram& telegram);
  void adopt(const Configuration& configuration);
  Configuration wanted_configuration(const Configuration& now) const;
  double nominal_period() const;
  void start_streaming(double now);
  void take_values(double now, const Telegram& telegram, std::size_t bytes);
  void deliver(double now, std::size_t bytes, Health health);
  void measure_period(double now);
  void fall_back(const std::string& why);
  void remark(const std::string& sentence);
  bool interlaced() const { return setup_.variant == Variant{180, 25}; }
  Variant set_variant() const { return interlaced() ? Variant{180, 50} : setup_.variant; }

  LaserSetup setup_;
  unsigned wanted_;  // [bit/s] setup_'s, or lower once that rate has failed
  LineOrders orders_{};
  TelegramReader reader_{};

  Step step_ = Step::NoLine;
  int tries_left_ = 0;
  double deadline_ = 0;        // [s] of the present request
  double step_since_ = 0;      // [s]
  double requested_at_ = 0;    // [s]
  bool acknowledged_ = false;  // the request was, and nothing else has come since
  int naks_ = 0;               // in this step
  int strays_ = 0;             // bytes in this step that were neither NAK nor ACK
  unsigned nak_baud_ = 0;      // [bit/s] a device answered every request with NAK; 0: none did
  unsigned port_baud_ = 0;     // [bit/s] as last ordered
  bool fixed_rate_ = false;    // a network box sets the line's rate
  std::array<unsigned, 4> rates_{};  // in the order they are tried
  std::size_t rate_index_ = 0;
  double searching_since_ = 0;  // [s]
  double last_byte_ = 0;        // [s]

  std::string trouble_{"The port has not been opened yet."};
  std::vector<std::string> remarks_{};
  std::string type_{};
  std::string software_{};
  std::uint8_t address_ = 0;
  unsigned baud_ = 0;        // [bit/s] the device's rate; 0: unknown
  unsigned told_baud_ = 0;   // [bit/s] the rate ordered; 0: none
  unsigned found_baud_ = 0;  // [bit/s] the rate it was found at and is left at
  std::optional<Variant> variant_{};
  Configuration configuration_{};
  Configuration written_block_{};
  std::uint8_t measuring_mode_ = 0;
  bool in_millimetres_ = true;
  Health health_{};

  ScanDecoder decoder_{Variant{}, WordFormat{}};
  PartialScans parts_{Variant{}, WordFormat{}};
  algo::LaserScan filling_{};
  algo::LaserScan ready_{};
  bool fresh_ = false;
  double period_ = 0.1;      // [s]
  double last_arrival_ = 0;  // [s] of the previous scan
  unsigned long_gaps_ = 0;   // in a row
  double last_scan_ = 0;     // [s]
  double last_heard_ = 0;    // [s]
  double damaged_ = 0;
  bool storm_ = false;
  bool blinded_ = false;
  std::optional<Dazzled> dazzled_{};
  std::uint64_t bad_before_ = 0;
  std::uint64_t scans_ = 0;
  std::uint64_t replaced_ = 0;
  std::uint64_t set_ups_ = 0;
  std::uint64_t written_ = 0;
};

}  // namespace drivers::lms200
