// db/sweeps.cpp: what is left of a sample once it was foretold, and in which stream it goes.
#include "db/sweeps.hpp"

#include <algorithm>
#include <optional>

#include "db/residuals.hpp"

namespace db::detail {
namespace {

/// Tells the class of a residual from the two before it, which are folded: twice their size.
class Surroundings {
 public:
  std::size_t of(bool settled) const {
    const std::size_t sum = before_[0] + before_[1];
    const std::size_t rough = sum < kCalm ? 0U : sum < kRough ? 1U : 2U;
    return settled ? rough : std::max<std::size_t>(rough, 1);
  }
  void add(std::uint16_t folded) { before_ = {before_[1], std::min<std::size_t>(folded, kRough)}; }

 private:
  static constexpr std::size_t kCalm = 56;    // within a noise of +-15 mm
  static constexpr std::size_t kRough = 200;  // beside an edge
  std::array<std::size_t, 2> before_{};
};

struct Transferred {
  std::uint16_t sample = 0;
  std::uint16_t folded = 0;
};

/// Walks over a window's samples: `transfer(i, expected, class)` hands one over and tells it with
/// its folded residual. A scan without a place in the map is expected to be as its left neighbours.
template <typename Transfer>
void walk(std::optional<MappedScan> scan, std::size_t count, const Transfer& transfer) {
  Surroundings surroundings{};
  std::uint16_t left = 0;
  const auto hand_over = [&](std::size_t i, std::uint16_t expected, bool settled) {
    const Transferred done = transfer(i, expected, surroundings.of(settled));
    surroundings.add(done.folded);
    left = done.sample;
  };
  if (!scan) {
    for (std::size_t i = 0; i < count; ++i) hand_over(i, left, true);
    return;
  }
  const MappedScan mapped = *scan;
  // Even samples before odd ones, as they are fired; neighbours of one parity share no cell, so
  // that the processor need not wait for one to be learnt before it looks up the next.
  for (std::size_t parity = 0; parity < 2; ++parity) {
    for (std::size_t i = parity; i < count; i += 2) {
      const Place place = mapped.look_up(i);
      hand_over(i, place.known ? place.expected() : left, place.settled);
      mapped.learn(place, left);
    }
  }
}

/// The residuals of one class, read one after the other.
class Residuals {
 public:
  Residuals() = default;
  Residuals(const Streams& streams, std::size_t kind, std::size_t at)
      : low_(streams[kLow[kind]].data() + at),
        end_(streams[kLow[kind]].data() + streams[kLow[kind]].size()),
        high_(streams[kHigh[kind]].data() + at) {}
  std::uint16_t take() {
    if (low_ == end_) throw CodecError("the block's streams do not match its layout");
    return static_cast<std::uint16_t>(*low_++ | (*high_++ * 256U));
  }
  std::size_t at(const Streams& streams, std::size_t kind) const {
    return static_cast<std::size_t>(low_ - streams[kLow[kind]].data());
  }

 private:
  const std::uint8_t* low_ = nullptr;
  const std::uint8_t* end_ = nullptr;
  const std::uint8_t* high_ = nullptr;
};

constexpr std::size_t kMotionNumbers = 2 * kKnots + 2;

/// A motion as numbers that are small in a smooth one: each knot's change since the last scan, less
/// that of the knot before.
std::array<std::int32_t, kMotionNumbers> differences(const Motion& motion, const Motion& last) {
  std::array<std::int32_t, kMotionNumbers> out{};
  std::int32_t before = 0;
  for (std::size_t a = 0; a < 2 * kKnots; ++a) {
    const std::int32_t change =
        motion.turns[a / kKnots][a % kKnots] - last.turns[a / kKnots][a % kKnots];
    out[a] = change - before;
    before = change;
  }
  out[kMotionNumbers - 2] = motion.shift[0];
  out[kMotionNumbers - 1] = motion.shift[1];
  return out;
}

/// The inverse. Throws CodecError where a part is beyond what there may be.
Motion summed(const std::array<std::int64_t, kMotionNumbers>& numbers, const Motion& last) {
  Motion motion{};
  const auto checked = [](std::int64_t value) {
    if (value < -kMostTurn || value > kMostTurn) {
      throw CodecError("a window of the block is moved too far");
    }
    return static_cast<std::int32_t>(value);
  };
  std::int64_t change = 0;
  for (std::size_t a = 0; a < 2 * kKnots; ++a) {
    change += numbers[a];
    motion.turns[a / kKnots][a % kKnots] = checked(last.turns[a / kKnots][a % kKnots] + change);
  }
  motion.shift = {checked(numbers[kMotionNumbers - 2]), checked(numbers[kMotionNumbers - 1])};
  if (!is_sane(motion)) throw CodecError("a window of the block is moved too far");
  return motion;
}

void put_motion(std::vector<std::uint8_t>& out, const Motion& motion, const Motion& last) {
  for (const std::int32_t number : differences(motion, last)) {
    put_varint(out, fold32(static_cast<std::uint32_t>(number)));
  }
}

Motion take_motion(Cursor& cursor, const Motion& last) {
  std::array<std::int64_t, kMotionNumbers> numbers{};
  for (std::int64_t& number : numbers) {
    number = static_cast<std::int32_t>(unfold32(static_cast<std::uint32_t>(cursor.varint())));
  }
  return summed(numbers, last);
}

}  // namespace

void Sweeps::clear() {
  for (RangeMap& map : maps_) map.forget();
  read_.fill(0);
}

RangeMap& Sweeps::map(std::size_t which) {
  if (maps_.size() <= which) maps_.resize(which + 1);
  return maps_[which];
}

void Sweeps::write(std::size_t which,
                   std::span<const std::byte> samples,
                   std::size_t per_half_turn,
                   Streams& streams) {
  const std::size_t count = samples.size() / sizeof(std::uint16_t);
  if (count == 0) return;
  RangeMap& map = this->map(which);
  std::optional<Motion> motion{};
  if (map.is_of(count, per_half_turn)) motion = finder_.find(map, samples);
  auto& motions = streams[kMotion];
  motions.push_back(static_cast<std::uint8_t>(motion ? Choice::Reference : Choice::Within));
  std::optional<MappedScan> scan{};
  if (motion) {
    put_motion(motions, *motion, map.motion());
    scan = map.move(*motion);
  }
  // Room for all in each class, taken back below.
  std::array<std::uint8_t*, kClasses> low{};
  std::array<std::uint8_t*, kClasses> high{};
  for (std::size_t kind = 0; kind < kClasses; ++kind) {
    const std::size_t before = streams[kLow[kind]].size();
    streams[kLow[kind]].resize(before + count);
    streams[kHigh[kind]].resize(before + count);
    low[kind] = streams[kLow[kind]].data() + before;
    high[kind] = streams[kHigh[kind]].data() + before;
  }
  walk(scan, count, [&](std::size_t i, std::uint16_t expected, std::size_t kind) -> Transferred {
    const auto sample = load<std::uint16_t>(samples, i);
    const std::uint16_t folded = fold16(static_cast<std::uint16_t>(sample - expected));
    *low[kind]++ = static_cast<std::uint8_t>(folded & 0xFFU);
    *high[kind]++ = static_cast<std::uint8_t>(folded >> 8U);
    return {sample, folded};
  });
  for (std::size_t kind = 0; kind < kClasses; ++kind) {
    streams[kLow[kind]].resize(static_cast<std::size_t>(low[kind] - streams[kLow[kind]].data()));
    streams[kHigh[kind]].resize(static_cast<std::size_t>(high[kind] - streams[kHigh[kind]].data()));
  }
  if (!motion && count <= RangeMap::kMostSamples) map.restart(samples, per_half_turn);
}

void Sweeps::read(std::size_t which,
                  std::span<std::byte> samples,
                  std::size_t per_half_turn,
                  const Streams& streams,
                  Cursor& motions) {
  const std::size_t count = samples.size() / sizeof(std::uint16_t);
  if (count == 0) return;
  RangeMap& map = this->map(which);
  const std::uint8_t choice = motions.byte();
  if (choice > static_cast<std::uint8_t>(Choice::Reference)) {
    throw CodecError("a window of the block is predicted in an unknown way");
  }
  const bool mapped = choice == static_cast<std::uint8_t>(Choice::Reference);
  std::optional<MappedScan> scan{};
  if (mapped) {
    if (!map.is_of(count, per_half_turn)) {
      throw CodecError("a window of the block refers to another kind of window");
    }
    scan = map.move(take_motion(motions, map.motion()));
  }
  std::array<Residuals, kClasses> left{};
  for (std::size_t kind = 0; kind < kClasses; ++kind) left[kind] = {streams, kind, read_[kind]};
  walk(scan, count, [&](std::size_t i, std::uint16_t expected, std::size_t kind) -> Transferred {
    // Told apart by branches: their guesses go ahead of the residual that decides the class.
    const std::uint16_t folded =
        kind == 0 ? left[0].take() : (kind == 1 ? left[1].take() : left[2].take());
    const auto sample = static_cast<std::uint16_t>(unfold16(folded) + expected);
    store(samples, i, sample);
    return {sample, folded};
  });
  for (std::size_t kind = 0; kind < kClasses; ++kind) read_[kind] = left[kind].at(streams, kind);
  if (!mapped && count <= RangeMap::kMostSamples) map.restart(samples, per_half_turn);
}

bool Sweeps::at_end(const Streams& streams) const {
  for (std::size_t kind = 0; kind < kClasses; ++kind) {
    if (read_[kind] != streams[kLow[kind]].size()) return false;
  }
  return true;
}

}  // namespace db::detail
