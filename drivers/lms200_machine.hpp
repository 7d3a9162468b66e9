// drivers/lms200_machine.hpp: how an LMS2xx is found, set up, listened to and left again.
//
// Bytes and times in, telegrams and scans out; drivers/lms200_device.hpp is the thread around it.
//
//   NoLine > Probe (each rate) > Type > Status > Rate > Variant > Installation > configuration
//          > Start > Streaming           nothing answers: Listen for a greeting, then Probe again
//
// A mode switch may take 3 s, and the device may be deaf and dumb for seconds after one or after
// power-on: what it acknowledged is waited for, what it did not is asked again for as long.
// Whatever falls silent or restarts on the way is looked for again from the beginning.
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

constexpr unsigned kFallbackRate = 38400;  // [bit/s] that every port and plug can do

/// What the device is to do.
struct LaserSetup {
  unsigned baud = 500'000;   // [bit/s] wanted; the device is looked for at all of them
  Variant variant{180, 50};  // 180 degrees at 0.25 come as interlaced partial scans
  unsigned range = 8;        // [m] 8, 16 or 32 in millimetres, 80 in centimetres
  bool upside_down = false;
  bool as_it_is = false;  // only looked at: rate, variant and configuration stay
  std::string password{kFactoryPassword};
};

/// Eight characters that a keyboard has: what the device takes as one.
bool good_password(std::string_view password);
/// Why no device can do what `setup` says; empty when one can.
std::string refusal(const LaserSetup& setup);

enum class Stage : std::uint8_t { NoLine, Searching, SettingUp, Running };

/// Bearings between which the newest scan was dazzled [rad, the scanner's own, left positive].
struct Dazzled {
  double from = 0;
  double to = 0;
};

/// All that people may want to know about it.
struct LaserReport {
  Stage stage = Stage::NoLine;
  std::string trouble{};               // why there are no scans, a sentence; empty while Running
  std::vector<std::string> remarks{};  // what is not as it was asked for
  std::string type{};                  // "LMS200;301063;V02.30"
  std::string software{};
  unsigned baud = 0;  // [bit/s] found or agreed upon
  std::uint8_t address = 0;
  Variant variant{};
  std::uint8_t measuring_mode = 0;
  bool in_millimetres = true;
  std::optional<std::uint16_t> motor_microseconds{};  // 148 nominal
  Health health{};
  LineCounters line{};
  std::uint64_t scans = 0;
  std::uint64_t unusable = 0;  // came whole, and the device said not to rely on them
  std::uint64_t replaced = 0;  // scans by a newer one, before anybody took them
  std::uint64_t set_ups = 0;   // times it was found and set up
  std::uint64_t written = 0;   // times its configuration was written
  double damaged = 0;          // share of late, 0..1, of telegrams that came damaged
  bool storm = false;          // too many of them, until far fewer are
  bool blinded = false;        // most beams of the newest scan measured nothing
  std::optional<Dazzled> dazzled{};
  double scan_period = 0;     // [s] measured, or what its rate allows
  double nominal_period = 0;  // [s] what its rate allows
  double last_scan = 0;       // [s] steady clock, when it arrived; 0: none yet
  double last_heard = 0;      // [s] of the last whole telegram
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

  /// Exchanges `scan` for the newest one when there is one that nobody has taken. Its stamp is of
  /// the steady clock: the end of its last mirror turn, before it went over the line. Its mount is
  /// the caller's to set.
  bool take(algo::LaserScan& scan);
  Stage stage() const;
  LaserReport report() const;
  /// [s] As in the report.
  double scan_period() const { return period_; }
  double last_scan() const { return last_scan_; }
  double damaged() const { return damaged_; }
  /// More telegrams came damaged than whole, and the line has not been good again since.
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
  unsigned wanted_;  // [bit/s] setup_'s, or lower once that has turned out not to work
  LineOrders orders_{};
  TelegramReader reader_{};

  Step step_ = Step::NoLine;
  int tries_left_ = 0;
  double deadline_ = 0;              // [s] of the present request
  double step_since_ = 0;            // [s]
  double requested_at_ = 0;          // [s]
  bool acknowledged_ = false;        // the request, and nothing else has come since
  int naks_ = 0;                     // in this step,
  int strays_ = 0;                   // and what was neither that nor an acknowledgement
  unsigned nak_baud_ = 0;            // [bit/s] at which a device took all for damaged; 0: none did
  unsigned port_baud_ = 0;           // [bit/s] as last ordered
  bool fixed_rate_ = false;          // the line's rate is none of ours: a network box
  std::array<unsigned, 4> rates_{};  // in the order they are tried
  std::size_t rate_index_ = 0;
  double searching_since_ = 0;  // [s]
  double last_byte_ = 0;        // [s]

  std::string trouble_{"The port has not been opened yet."};
  std::vector<std::string> remarks_{};
  std::string type_{};
  std::string software_{};
  std::uint8_t address_ = 0;
  unsigned baud_ = 0;        // [bit/s] that the device is known to have; 0 when it is not
  unsigned told_baud_ = 0;   // [bit/s] that it was told to have; 0: nothing
  unsigned found_baud_ = 0;  // [bit/s] that it had by itself, and is left with
  std::optional<Variant> variant_{};
  Configuration configuration_{};
  Configuration written_block_{};
  std::uint8_t measuring_mode_ = 0;
  bool in_millimetres_ = true;
  std::optional<std::uint16_t> motor_microseconds_{};
  Health health_{};

  ScanDecoder decoder_{Variant{}, WordFormat{}};
  PartialScans parts_{Variant{}, WordFormat{}};
  algo::LaserScan filling_{};
  algo::LaserScan ready_{};
  bool fresh_ = false;
  double period_ = 0.1;      // [s]
  double last_arrival_ = 0;  // [s] of the scan before
  unsigned long_gaps_ = 0;   // in a row
  double last_scan_ = 0;     // [s]
  double last_heard_ = 0;    // [s]
  double damaged_ = 0;
  bool storm_ = false;
  bool blinded_ = false;
  std::optional<Dazzled> dazzled_{};
  std::uint64_t bad_before_ = 0;
  std::uint64_t scans_ = 0;
  std::uint64_t unusable_ = 0;
  std::uint64_t replaced_ = 0;
  std::uint64_t set_ups_ = 0;
  std::uint64_t written_ = 0;
};

}  // namespace drivers::lms200
