// drivers/emulators/lms200_emulator.hpp: a SICK LMS200 on its serial line.
//
// Written from SICK, Telegrams for Configuring and Operating the LMS2xx (2006). The caller supplies
// each sweep of the mirror; see Emulator::offer().
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

/// Durations of the device's work [s]; the limits are from the manual.
struct EmulatedTimes {
  double acknowledge = 0.003;         // at most 0.06
  double answer = 0.010;              // after the acknowledgement; ordinary answers at most 0.06
  double mode = 0.060;                // at most 3
  double variant = 0.200;             // the mirror is reconfigured
  double write_configuration = 0.48;  // measured; at most 15
  double deaf = 0;  // ignores all bytes and sends none after a mode switch and power-on
};

struct EmulatorOptions {
  std::uint8_t address = 0;
  std::string type = "LMS200;301063;V02.30 ";
  std::string password{kFactoryPassword};
  bool rs422 = true;       // RS-232 cannot carry 500000
  bool powered = true;     // false: power comes at the first call, and the device starts up
  double boot_time = 1.0;  // [s] until the greeting; a real one takes 10 to 60
  unsigned start_rate = 9600;
  StartUpRate start_up = StartUpRate::Baud9600;
  Variant variant{.angle_degrees = 180, .step_centidegrees = 100};  // as stored
  /// Partial scans of 180 degrees come in quarters of a degree for any step of the variant.
  bool interlaced = false;
  unsigned refusals = 0;  // NAK to this many intact telegrams first
  double field_a = 0;     // [m] nearer values get the flag of field A; 0: no field
  EmulatedTimes times{};
  std::uint64_t seed = 1;
};

/// The sweeps that the device needs: whole scans of a variant, or single turns that begin at
/// `parts` quarters of a degree in turn.
struct Sweep {
  Variant variant{};
  std::vector<std::uint8_t> parts{};  // empty: whole scans
  bool operator==(const Sweep&) const = default;
};

/// The fate of one scan or range of values that the device had to send.
struct SentScan {
  enum class Fate : std::uint8_t {
    Sent,
    Damaged,  // by the line's faults
    Cut,      // by a request of the host
    Lost,     // the line was still busy with an earlier scan
    Muted,
  };
  std::uint64_t number = 0;  // of the sweep or turn, from 1
  Fate fate = Fate::Sent;
  double end = 0;  // [s] when its last byte was sent
  std::optional<std::uint8_t> part{};
  /// The packed beams that a correct receiver reads (algo/laser_scan.hpp), first value first.
  std::vector<std::uint16_t> beams{};
};

class Emulator final : public emulators::Device {
 public:
  explicit Emulator(const EmulatorOptions& options = {});

  // ---- the world ----
  const Sweep& sweep() const { return sweep_; }
  /// Supplies a sweep that ended at `now`: a whole scan, or part `part` of sweep().parts. Beams are
  /// matched by bearing; a bearing missing in `scan` gives no echo.
  void offer(const algo::LaserScan& scan, double now, std::optional<std::uint8_t> part = {});
  /// Called with the fate of each scan once it is decided.
  std::function<void(const SentScan&)> on_scan{};

  // ---- injected faults ----
  /// Power cycle: starts with the stored settings and greets after `boot_time` [s].
  void restart(double now, double boot_time);
  /// Answers NAK to the next `telegrams` intact telegrams.
  void refuse_next(unsigned telegrams) { refusals_ = telegrams; }
  /// External light blinds all beams, or those within `cone` [rad] about the middle.
  void dazzle(bool on, double cone = emulators::kNever);
  /// Sets the status byte of all answers, except bits 3-4.
  void set_health(std::uint8_t byte) { health_ = static_cast<std::uint8_t>(byte | 0x10U); }

  // ---- for tests ----
  Mode mode() const { return mode_; }
  bool started(double now) const { return now >= boot_end_; }
  const Configuration& configuration() const { return configuration_; }
  /// Number of writes of its memory, which wear it out.
  unsigned memory_writes() const { return memory_writes_; }
  std::uint64_t bad_telegrams() const { return bad_telegrams_; }

 private:
  using Words = std::vector<std::uint16_t>;
  struct Job {
    double due = 0;
    std::function<void(double)> run{};
  };
  /// How values are measured: continuously or once.
  struct Taking {
    std::uint8_t code = 0;  // of the telegram; 0: nothing is sent
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
  FixedBytes<128> request_{};               // the bytes so far
  double boot_end_ = 0;                     // [s] end of the start-up
  double deaf_until_ = -emulators::kNever;  // [s]
  bool greeted_ = true;
  bool begun_ = false;  // the first time has been given
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
  std::optional<SentScan> leaving_{};  // being sent
};

}  // namespace drivers::lms200
