// drivers/emulators/card_memory.hpp: the registers of an emulated acquisition card, in a file that
// the emulator and the emulated libcomedi of another program both map.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <filesystem>

namespace drivers::emulators {

/// The number of channels of each kind.
struct CardChannels {
  std::uint32_t outputs = 2;
  std::uint32_t counters = 2;
  std::uint32_t lines = 8;
};

/// Read and written by two programs at once. In native byte order: no other computer reads it.
struct CardMemory {
  static constexpr std::uint32_t kMagic = 0x4C54'4131;
  static constexpr std::uint32_t kFullSample = 0xFFFF;    // of an output
  static constexpr std::uint32_t kFullCount = 0xFF'FFFF;  // of a counter
  static constexpr std::uint32_t kZeroSample = 0x8000;    // 0 V within +-10 V
  static constexpr std::uint32_t kSymmetric = 1;  // the range from -10 to 10 V; 0: 0 to 10 V
  static constexpr std::uint32_t kRelayLine = 0;
  static constexpr double kLongestStep = 0.5;  // [s] the encoders turn on without the emulator

  std::uint32_t magic = kMagic;
  CardChannels channels{};

  std::atomic<std::uint32_t> gone{0};  // unplugged
  std::atomic<std::uint32_t> busy{0};  // every call fails
  std::atomic<std::uint32_t> opened{0};
  std::array<std::atomic<std::uint32_t>, 2> samples{kZeroSample, kZeroSample};
  std::array<std::atomic<std::uint32_t>, 2> ranges{kSymmetric, kSymmetric};
  // Count of each encoder, not wrapped, at `turned_at`, and its rate from then on. The emulator
  // updates them at uneven times on a busy computer, so counters extrapolate.
  std::array<std::atomic<double>, 2> turned{};
  std::array<std::atomic<double>, 2> rates{};   // [1/s]
  std::atomic<double> turned_at{0};             // [s] steady clock
  std::atomic<std::uint32_t> directions{0};     // bit set: an output
  std::atomic<std::uint32_t> levels{0};         // of outputs
  std::atomic<std::uint32_t> inputs{0};         // levels at the inputs
  std::atomic<std::uint32_t> relay_changes{0};  // changes of its line since power-on
  std::atomic<double> relay_changed_at{0};      // [s] steady clock

  /// [V] The voltage of an output.
  double volts(std::size_t output) const;
  /// The value of counter `counter` at `now` [s].
  std::uint32_t count(std::size_t counter, double now) const;
  /// Sets line `line` for the host at `now` [s].
  void set_line(std::uint32_t line, bool high, double now);
  /// Sets the power-on state of the card.
  void reset();
};
static_assert(std::atomic<double>::is_always_lock_free);

/// A CardMemory in a file.
class CardFile {
 public:
  /// Makes the file; the destructor removes it. Replaces a card left over by a killed emulator.
  /// Throws std::runtime_error with a sentence, also if the card's emulator runs.
  CardFile(std::filesystem::path path, const CardChannels& channels);
  /// Opens a file that an emulator has made. Throws std::runtime_error likewise.
  explicit CardFile(std::filesystem::path path);
  ~CardFile();
  CardFile(const CardFile&) = delete;
  CardFile& operator=(const CardFile&) = delete;

  CardMemory& memory() const { return *memory_; }

 private:
  void map(int descriptor);

  std::filesystem::path path_;
  bool made_ = false;
  int kept_ = -1;            // of the file made, and locked
  std::uint64_t inode_ = 0;  // of the file made; 0: opened
  CardMemory* memory_ = nullptr;
};

}  // namespace drivers::emulators
