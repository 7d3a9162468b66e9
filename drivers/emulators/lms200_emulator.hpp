// drivers/emulators/lms200_emulator.hpp: a SICK LMS200 as its line shows it.
//
// Written from SICK, Telegrams for Configuring and Operating the LMS2xx (2006). What the world
// looks like comes from outside, one sweep of the mirror after another; see Emulator::offer().
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "algo/laser_scan.hpp"
#include "drivers/emulators/device.hpp"
#include "drivers/lms200_protocol.hpp"

namespace drivers::lms200 {

/// What the device needs for its work [s]; the manual gives limits.
struct EmulatedTimes {
  double acknowledge = 0.003;         // at most 0.06
  double answer = 0.010;              // after the acknowledgement; ordinary answers at most 0.06
  double mode = 0.060;                // at most 3
  double variant = 0.200;             // the mirror is set anew
  double write_configuration = 0.48;  // measured; at most 15
  double deaf = 0;                    // hears and says nothing after a mode switch and power-on
};

struct EmulatorOptions {
  std::uint8_t address = 0;
  std::string type = "LMS200;301063;V02.30 ";
  std::string password{kFactoryPassword};
  bool rs422 = true;       // RS-232 carries no 500000
  bool powered = true;     // false: power comes with the first moment, and the device starts up
  double boot_time = 1.0;  // [s] until the greeting; a real one takes 10 to 60
  unsigned start_rate = 9600;
  StartUpRate start_up = StartUpRate::Baud9600;
  Variant variant{.angle_degrees = 180, .step_centidegrees = 100};  // as stored
  /// Partial scans of 180 degrees come in quarters of a degree, whatever the variant's step.
  bool interlaced = false;
  unsigned refusals = 0;  // the first so many sound telegrams are taken for damaged
  double field_a = 0;     // [m] what is nearer lies in field A, which raises a flag; 0: no field
  EmulatedTimes times{};
  std::uint64_t seed = 1;
};

/// What the mirror is to sweep: whole scans of a variant, or one turn after another, whose parts
/// begin at `parts` quarters of a degree in turn.
struct Sweep {
  Variant variant{};
  std::vector<std::uint8_t> parts{};  // empty: whole scans
  bool operator==(const Sweep&) const = default;
};

/// What became of values that were to be sent without being asked for one by one, or once asked.
struct SentScan {
  enum class Fate : std::uint8_t {
    Sent,
    Damaged,  // by the line's faults
    Cut,      // by a request of the host
    Lost,     // the line was still busy with an earlier one
    Muted,
  };
  std::uint64_t number = 0;  // of the sweep or turn, from 1
  Fate fate = Fate::Sent;
  double end = 0;  // [s] when its last byte left
  std::optional<std::uint8_t> part{};
  /// What a sound receiver makes of it: packed beams (algo/laser_scan.hpp), first value first.
  std::vector<std::uint16_t> beams{};
};

class Emulator final : public emulators::Device {
 public:
  explicit Emulator(const EmulatorOptions& options = {});

  // ---- the world ----
  const Sweep& sweep() const { return sweep_; }
  /// The mirror ended a sweep at `now`: a whole scan, or part `part` of sweep().parts. Beams are
  /// found by their bearing; a bearing that `scan` does not have gives no echo.
  void offer(const algo::LaserScan& scan, double now, std::optional<std::uint8_t> part = {});
  /// Called for all values that were to be sent, when they are or will not be.
  std::function<void(const SentScan&)> on_scan{};

  // ---- what may befall it ----
  /// Power goes and comes back: starts up as stored, and greets after `boot_time` [s].
  void restart(double now, double boot_time);
  /// The next `telegrams` that are sound are taken for damaged.
  void refuse_next(unsigned telegrams) { refusals_ = telegrams; }
  /// Light from elsewhere blinds it, all of it or the beams within `cone` [rad] about its middle.
  void dazzle(bool on, double cone = emulators::kNever);
  /// Bits 0-7 of the last byte of all answers but bits 3-4.
  void set_health(std::uint8_t byte) { health_ = static_cast<std::uint8_t>(byte | 0x10U); }

  // ---- for tests to look at ----
  Mode mode() const { return mode_; }
  bool started(double now) const { return now >= boot_end_; }
  const Configuration& configuration() const { return configuration_; }
  /// How often its memory has been written, which wears it out.
  unsigned memory_writes() const { return memory_writes_; }
  std::uint64_t bad_telegrams() const { return bad_telegrams_; }

 private:
  using Words = std::vector<std::uint16_t>;
  struct Job {
    double due = 0;
    std::function<void(double)> run{};
  };
  /// How values are taken: continuously or once.
  struct Taking {
    std::uint8_t code = 0;  // of the telegram; 0: none are
    unsigned means = 1;
    std::optional<ValueRange> range{};
    bool parts = false;
    bool operator==(const Taking&) const = default;
  };

  void on_byte(std::uint8_t byte, double at) override;
  void on_quiet(double silence) override;
  void work(double now) override;
  double next_duty() const override;

  void take(ByteView frame, double at);
  void carry_out(ByteView payload, double at);
  void change_mode(ByteView data, double at);
  void take_values(ByteView payload, double at);
  void change_variant(ByteView data, double at);
  void change_start_up(ByteView data, double at);
  void write_configuration(ByteView data, double at);
  void write_second(ByteView data, double at);

  void answer(std::uint8_t code, const std::vector<std::uint8_t>& data, double delay, double at);
  void refuse(double at);
  emulators::Sending say(std::uint8_t code, ByteView data, double at);
  void later(double due, std::function<void(double)> run);
  void go_deaf(double now) { deaf_until_ = now + options_.times.deaf; }
  std::vector<std::uint8_t> status() const;
  std::vector<std::uint8_t> errors() const;

  void enter(Mode mode, const Taking& stream);
  void note_sweep();
  bool range_fits(const ValueRange& range) const;
  void convert(const algo::LaserScan& scan, std::optional<std::uint8_t> part);
  std::uint16_t word_of(const algo::LaserScan& scan, std::size_t beam) const;
  void average();
  void send_values(const Taking& taking, double now, std::optional<std::uint8_t> part);
  void close_scan(SentScan::Fate fate);

  EmulatorOptions options_;
  FixedBytes<128> request_{};               // as far as it has come
  double boot_end_ = 0;                     // [s] up to here it starts up
  double deaf_until_ = -emulators::kNever;  // [s]
  bool greeted_ = true;
  bool begun_ = false;  // its clock is known
  std::vector<Job> jobs_{};

  Mode mode_ = Mode::OnRequest;
  Variant variant_{};
  Configuration configuration_{};
  std::array<std::uint8_t, 84> second_{};
  unsigned stored_rate_ = 9600;
  StartUpRate start_up_{};
  unsigned memory_writes_ = 0;
  std::uint8_t health_ = 0x10;
  bool dazzled_ = false;
  double cone_ = emulators::kNever;  // [rad] dazzled
  bool was_dazzled_ = false;
  unsigned refusals_ = 0;
  std::uint64_t bad_telegrams_ = 0;

  Sweep sweep_{};
  Taking stream_{};
  Taking once_{};
  std::uint64_t sweeps_ = 0;
  std::uint8_t turn_index_ = 0;
  std::uint8_t telegram_index_ = 0;
  Words words_{};               // of the newest sweep
  std::vector<double> sums_{};  // of distances, for means
  std::vector<unsigned> summands_{};
  unsigned summed_ = 0;                // scans in the sums
  std::optional<SentScan> leaving_{};  // on the line
};

}  // namespace drivers::lms200
