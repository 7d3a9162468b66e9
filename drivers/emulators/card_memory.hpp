// drivers/emulators/card_memory.hpp: the registers of an emulated acquisition card, in a file that
// the emulator and the emulated libcomedi of another program both map.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <filesystem>

namespace drivers::emulators {

/// How many channels of each kind a card has.
struct CardChannels {
  std::uint32_t outputs = 2;
  std::uint32_t counters = 2;
  std::uint32_t lines = 8;
};

/// Read and written by two programs at once. The file is as the machine has it: no other reads it.
struct CardMemory {
  static constexpr std::uint32_t kMagic = 0x4C54'4131;
  static constexpr std::uint32_t kFullSample = 0xFFFF;    // of an output
  static constexpr std::uint32_t kFullCount = 0xFF'FFFF;  // of a counter
  static constexpr std::uint32_t kZeroSample = 0x8000;    // 0 V within +-10 V
  static constexpr std::uint32_t kSymmetric = 1;  // the range from -10 to 10 V; 0: 0 to 10 V
  static constexpr std::uint32_t kRelayLine = 0;
  static constexpr double kLongestStep = 0.5;  // [s] without the emulator, the encoders turn on

  std::uint32_t magic = kMagic;
  CardChannels channels{};

  std::atomic<std::uint32_t> gone{0};  // taken out of the computer
  std::atomic<std::uint32_t> busy{0};  // every call fails
  std::atomic<std::uint32_t> opened{0};
  std::array<std::atomic<std::uint32_t>, 2> samples{kZeroSample, kZeroSample};
  std::array<std::atomic<std::uint32_t>, 2> ranges{kSymmetric, kSymmetric};
  // Of each encoder, not wrapped, as of a moment; and how fast it turns on from there. The emulator
  // tells them at its own pace, which a busy computer makes uneven.
  std::array<std::atomic<double>, 2> turned{};
  std::array<std::atomic<double>, 2> rates{};   // [1/s]
  std::atomic<double> turned_at{0};             // [s] steady clock
  std::atomic<std::uint32_t> directions{0};     // bit set: an output
  std::atomic<std::uint32_t> levels{0};         // of outputs
  std::atomic<std::uint32_t> inputs{0};         // levels at the inputs
  std::atomic<std::uint32_t> relay_changes{0};  // of its line, since the card began
  std::atomic<double> relay_changed_at{0};      // [s] steady clock

  /// [V] of an output.
  double volts(std::size_t output) const;
  /// What counter `counter` shows at `now` [s].
  std::uint32_t count(std::size_t counter, double now) const;
  /// The host sets line `line` at `now` [s].
  void set_line(std::uint32_t line, bool high, double now);
  /// As the card is when it gets its power.
  void reset();
};
static_assert(std::atomic<double>::is_always_lock_free);

/// A CardMemory in a file.
class CardFile {
 public:
  /// Makes the file, which goes with this object. Throws std::runtime_error with a sentence.
  CardFile(std::filesystem::path path, const CardChannels& channels);
  /// Opens one that an emulator has made. Throws std::runtime_error likewise.
  explicit CardFile(std::filesystem::path path);
  ~CardFile();
  CardFile(const CardFile&) = delete;
  CardFile& operator=(const CardFile&) = delete;

  CardMemory& memory() const { return *memory_; }

 private:
  void map(int descriptor);

  std::filesystem::path path_;
  bool made_ = false;
  std::uint64_t inode_ = 0;  // of the file that was made
  CardMemory* memory_ = nullptr;
};

}  // namespace drivers::emulators
