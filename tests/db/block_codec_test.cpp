// tests/db/block_codec_test.cpp: blocks decode bit for bit or give a sentence; they never crash.
#include "db/block_codec.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "tests/db/frames.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace {

using db::BlockDecoder;
using db::BlockEncoder;
using db::CodecError;
using db::Window;
using test::Frame;
using testing::HasSubstr;

std::vector<std::byte> pack(const std::vector<Frame>& frames) {
  BlockEncoder encoder;
  for (const Frame& frame : frames) encoder.add(frame.bytes, frame.windows);
  const auto packed = encoder.encode();
  return {packed.begin(), packed.end()};
}

void expect_same(const BlockDecoder& decoder, const std::vector<Frame>& frames) {
  ASSERT_EQ(decoder.frames(), frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto bytes = decoder.frame(i);
    EXPECT_TRUE(std::ranges::equal(bytes, frames[i].bytes)) << "frame " << i;
    EXPECT_TRUE(std::ranges::equal(decoder.windows(i), frames[i].windows)) << "frame " << i;
  }
}

std::vector<Frame> made(std::size_t count, std::uint64_t seed = 1, std::size_t nodes = 50) {
  test::FrameMaker maker(seed, nodes);
  std::vector<Frame> frames;
  for (std::size_t i = 0; i < count; ++i) frames.push_back(maker.next());
  return frames;
}

std::string refusal(std::span<const std::byte> block) {
  BlockDecoder decoder;
  try {
    decoder.decode(block);
  } catch (const CodecError& error) {
    EXPECT_EQ(decoder.frames(), 0U);
    return error.what();
  }
  return "";
}

TEST(BlockCodec, GivesBackEveryBitOfRecordedFrames) {
  BlockDecoder decoder;
  for (const std::size_t count : {1U, 2U, 38U, 64U, 128U}) {
    const auto frames = made(count);
    decoder.decode(pack(frames));
    expect_same(decoder, frames);
  }
}

TEST(BlockCodec, GivesBackEveryBitOfArbitraryFrames) {
  std::mt19937_64 random(7);
  BlockDecoder decoder;
  for (int round = 0; round < 200; ++round) {
    std::vector<Frame> frames(1 + random() % 12);
    for (Frame& frame : frames) {
      frame.bytes.resize(random() % 400);
      for (auto& byte : frame.bytes) byte = static_cast<std::byte>(random());
      std::uint32_t at = 0;
      while (frame.bytes.size() >= at + 24 && random() % 4 != 0) {
        at += static_cast<std::uint32_t>(random() % 4);  // windows need not be aligned
        frame.windows.push_back({.offset = at, .count = static_cast<std::uint32_t>(random() % 11)});
        at += 20;
      }
      if (db::BlockEncoder probe; true) {
        // The last window may have been placed too far to the right: leave it out.
        try {
          probe.add(frame.bytes, frame.windows);
        } catch (const CodecError&) {
          frame.windows.pop_back();
        }
      }
    }
    decoder.decode(pack(frames));
    expect_same(decoder, frames);
  }
}

TEST(BlockCodec, TheGreatestAndTheLeastSamplesSurvive) {
  Frame frame{};
  for (const int number : {0x0000, 0xFFFF, 0x7FFF, 0x8000, 0x8001, 0x0001, 0xFFFE, 0x0018}) {
    const auto value = static_cast<std::uint16_t>(number);
    std::array<std::byte, 2> raw{};
    std::memcpy(raw.data(), &value, 2);
    frame.bytes.insert(frame.bytes.end(), raw.begin(), raw.end());
  }
  frame.windows = {{.offset = 0, .count = 8}};
  Frame other = frame;
  std::ranges::reverse(other.bytes);
  const std::vector<Frame> frames{frame, frame, other, frame};
  BlockDecoder decoder;
  decoder.decode(pack(frames));
  expect_same(decoder, frames);
}

TEST(BlockCodec, AFurtherFrameMakesALongerBlock) {
  const auto frames = made(40);
  BlockEncoder encoder;
  BlockDecoder decoder;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    encoder.add(frames[i].bytes, frames[i].windows);
    if (i != 10 && i != 39) continue;
    decoder.decode(encoder.encode());
    expect_same(decoder, {frames.begin(), frames.begin() + static_cast<std::ptrdiff_t>(i) + 1});
  }
  encoder.clear();
  EXPECT_EQ(encoder.frames(), 0U);
  EXPECT_EQ(encoder.bytes(), 0U);
  EXPECT_THROW(encoder.encode(), CodecError);
}

// Uniform noise of +-15 mm has log2(31) = 4.95 bits a beam; the difference of two such readings
// (the better of neighbour and last scan) has 5.7. 361 beams: 223 and 257 bytes. The rest of the
// frame is six doubles, a third of them constant, and a strip on a straight line.
TEST(BlockCodec, ScansPackNearTheirNoise) {
  const auto frames = made(64);
  const std::size_t packed = pack(frames).size();
  EXPECT_LT(packed / 64, 257U * 6 / 5 + 110);
  EXPECT_GT(packed / 64, 223U);
}

/// A room with corners seen while turning by `per_scan` beams a scan, odd beams half a scan later.
std::vector<Frame> turning(std::size_t count, double per_scan) {
  std::vector<Frame> frames(count);
  for (std::size_t k = 0; k < count; ++k) {
    frames[k].bytes.resize(2 * 361);
    frames[k].windows = {{.offset = 0, .count = 361}};
    for (std::size_t i = 0; i < 361; ++i) {
      const double scans = static_cast<double>(k) + (i % 2 == 0 ? 0.0 : 0.5);
      const double beam = static_cast<double>(i) + per_scan * scans;
      const double mm = 4000 + 1500 * std::sin(0.05 * beam) + 700 * std::sin(0.31 * beam);
      const auto sample = static_cast<std::uint16_t>(mm);
      std::memcpy(frames[k].bytes.data() + 2 * i, &sample, 2);
    }
  }
  return frames;
}

/// Flips each bit of `block`, which holds `frames`, by itself. @return how many flips are refused;
/// zstd ignores some bits (reserved ones of its headers), and the frames must then be right
std::size_t refused_flips(std::vector<std::byte> block, const std::vector<Frame>& frames) {
  BlockDecoder decoder;
  std::size_t refused = 0;
  for (std::size_t bit = 0; bit < 8 * block.size(); ++bit) {
    const std::byte flip = std::byte{1} << (bit % 8);
    block[bit / 8] ^= flip;
    try {
      decoder.decode(block);
      expect_same(decoder, frames);
    } catch (const CodecError&) {
      EXPECT_EQ(decoder.frames(), 0U);
      ++refused;
    }
    block[bit / 8] ^= flip;
  }
  return refused;
}

/// A wall 2 m to the left, seen by a scanner that drives along it with +-15 mm noise.
std::vector<Frame> along_a_wall(std::size_t count, double per_scan) {
  std::mt19937_64 random(9);
  std::vector<Frame> frames(count);
  for (std::size_t k = 0; k < count; ++k) {
    frames[k].bytes.resize(2 * 361);
    frames[k].windows = {{.offset = 0, .count = 361}};
    for (std::size_t i = 0; i < 361; ++i) {
      // A wall across at 6 m, one on either side at 2 m.
      const double angle = (static_cast<double>(i) - 180) * 3.14159265358979 / 360;
      const double ahead = 6000 - per_scan * static_cast<double>(k);
      const double aside = 2000 / std::max(1e-9, std::abs(std::sin(angle)));
      const double noise = static_cast<double>(random() % 31) - 15;
      const auto sample = static_cast<std::uint16_t>(
          std::min(ahead / std::max(1e-9, std::cos(angle)), aside) + noise);
      std::memcpy(frames[k].bytes.data() + 2 * i, &sample, 2);
    }
  }
  return frames;
}

/// The same frames with one sample outside the window in each second one: no scan is as long as the
/// last.
std::vector<Frame> each_of_another_size(std::vector<Frame> frames) {
  for (std::size_t k = 1; k < frames.size(); k += 2) frames[k].windows[0].count -= 1;
  return frames;
}

TEST(BlockCodec, TheLastScanHelpsToPredictTheNext) {
  for (const double per_scan : {0.0, 12.0}) {  // [mm]
    const auto frames = along_a_wall(77, per_scan);
    const auto block = pack(frames);
    BlockDecoder decoder;
    decoder.decode(block);
    expect_same(decoder, frames);
    // At rest 6 bits a sample with all headers; the noise alone has 4.95.
    EXPECT_LT(block.size() / 77, 361U * 6 / 8);
    EXPECT_LT(block.size(), pack(each_of_another_size(frames)).size() * 9 / 10);
  }
}

TEST(BlockCodec, AScanOfAnotherPlaceIsSeenAnew) {
  auto frames = along_a_wall(20, 0);
  const auto elsewhere = turning(20, 0);
  const std::size_t apart = pack(frames).size() + pack(elsewhere).size();
  frames.insert(frames.end(), elsewhere.begin(), elsewhere.end());
  const auto block = pack(frames);
  BlockDecoder decoder;
  decoder.decode(block);
  expect_same(decoder, frames);
  EXPECT_LT(block.size(), apart + 400);
}

TEST(BlockCodec, RandomScansTakeNoMoreThanTheirBytes) {
  std::mt19937_64 random(4);
  std::vector<Frame> frames(32);
  for (Frame& frame : frames) {
    frame.bytes.resize(2 * 361);
    for (auto& byte : frame.bytes) byte = static_cast<std::byte>(random());
    frame.windows = {{.offset = 0, .count = 361}};
  }
  const auto block = pack(frames);
  BlockDecoder decoder;
  decoder.decode(block);
  expect_same(decoder, frames);
  // Header 20, eight stream headers of 8, layouts of at most 28 bytes a frame.
  EXPECT_LE(block.size(), 32U * (2 * 361 + 28) + 20 + 64);
}

TEST(BlockCodec, ScansOfChangingShapeComeBack) {
  std::mt19937_64 random(6);
  std::vector<Frame> frames(60);
  for (Frame& frame : frames) {
    const std::array<std::uint32_t, 6> counts{0, 1, 2, 181, 361, 5000};
    std::uint32_t at = 0;
    for (std::size_t k = random() % 3; k > 0; --k) {
      const std::uint32_t count = counts[random() % counts.size()];
      frame.windows.push_back({.offset = at, .count = count});
      at += 2 * count;
    }
    frame.bytes.resize(at);
    for (auto& byte : frame.bytes) byte = static_cast<std::byte>(random() % 16);
  }
  BlockDecoder decoder;
  decoder.decode(pack(frames));
  expect_same(decoder, frames);
}

TEST(BlockCodec, WindowsPay) {
  // A robot that turns in front of an uneven wall, three beams per tick: every range changes.
  std::mt19937_64 random(1);
  std::vector<Frame> frames(64);
  for (std::size_t tick = 0; tick < frames.size(); ++tick) {
    Frame& frame = frames[tick];
    frame.windows = {{.offset = 0, .count = 361}};
    for (std::size_t i = 0; i < 361; ++i) {
      const double along = 0.02 * static_cast<double>(i + 3 * tick);
      const double mm = 3000 + 400 * std::sin(1.7 * along) + static_cast<double>(random() % 7);
      const auto value = static_cast<std::uint16_t>(mm);
      frame.bytes.push_back(static_cast<std::byte>(value & 0xFFU));
      frame.bytes.push_back(static_cast<std::byte>(value >> 8U));
    }
  }
  const std::size_t with = pack(frames).size();
  for (Frame& frame : frames) frame.windows.clear();
  const std::size_t without = pack(frames).size();
  EXPECT_LT(static_cast<double>(with), 0.8 * static_cast<double>(without));
  BlockDecoder decoder;
  decoder.decode(pack(frames));
  expect_same(decoder, frames);
}

TEST(BlockCodec, NoiseIsStoredAsItIs) {
  std::mt19937_64 random(3);
  Frame frame{};
  frame.bytes.resize(5000);
  for (auto& byte : frame.bytes) byte = static_cast<std::byte>(random());
  // Header 20, four stream headers of 8, layout of a few bytes.
  EXPECT_LE(pack({frame}).size(), 5000U + 20 + 32 + 8);
}

TEST(BlockCodec, RefusesWindowsThatLeaveTheFrame) {
  BlockEncoder encoder;
  const std::vector<std::byte> frame(100);
  const auto add = [&](std::vector<Window> windows) { encoder.add(frame, windows); };
  EXPECT_THROW(add({{.offset = 98, .count = 2}}), CodecError);
  EXPECT_THROW(add({{.offset = 4'000'000'000U, .count = 4'000'000'000U}}), CodecError);
  EXPECT_THROW(add({{.offset = 10, .count = 5}, {.offset = 19, .count = 1}}), CodecError);
  EXPECT_THROW(add({{.offset = 10, .count = 5}, {.offset = 9, .count = 1}}), CodecError);
  EXPECT_THROW(add({{.offset = 101, .count = 0}}), CodecError);
  EXPECT_THROW(add(std::vector<Window>(65)), CodecError);
  EXPECT_EQ(encoder.frames(), 0U);
  add({{.offset = 98, .count = 1}});
  EXPECT_EQ(encoder.frames(), 1U);
}

TEST(BlockCodec, ABlockIsBounded) {
  BlockEncoder encoder;
  const std::vector<std::byte> half(db::kMaxBlockBytes / 2);
  encoder.add(half, {});
  encoder.add(half, {});
  EXPECT_FALSE(encoder.fits(1));
  EXPECT_THROW(encoder.add(std::vector<std::byte>(1), {}), CodecError);
  encoder.clear();
  for (std::size_t i = 0; i < db::kMaxBlockFrames; ++i) encoder.add({}, {});
  EXPECT_FALSE(encoder.fits(0));
  BlockDecoder decoder;
  decoder.decode(encoder.encode());
  EXPECT_EQ(decoder.frames(), db::kMaxBlockFrames);
}

TEST(BlockCodec, ErrorsAreSentences) {
  auto block = pack(made(3));
  EXPECT_THAT(refusal({}), HasSubstr("cut off"));
  EXPECT_THAT(refusal(std::span(block).first(30)), HasSubstr("cut off"));
  block.push_back(std::byte{0});
  EXPECT_THAT(refusal(block), HasSubstr("followed by other bytes"));
  block.pop_back();
  block[2] = std::byte{9};
  EXPECT_THAT(refusal(block), HasSubstr("format 9"));
  block[2] = std::byte{5};
  block[0] = std::byte{'X'};
  EXPECT_THAT(refusal(block), HasSubstr("not a block"));
  block[0] = std::byte{'T'};
  block[7] = std::byte{0xFF};
  EXPECT_THAT(refusal(block), HasSubstr("beyond what a block holds"));
}

TEST(BlockCodec, EveryCutIsRefused) {
  const auto block = pack(made(3, 5, 2));
  for (std::size_t size = 0; size < block.size(); ++size) {
    EXPECT_NE(refusal(std::span(block).first(size)), "") << size;
  }
}

TEST(BlockCodec, EveryFlippedBitIsRefusedOrHarmless) {
  const auto frames = made(3, 5, 2);
  const auto block = pack(frames);
  EXPECT_GT(refused_flips(block, frames), 8 * block.size() * 95 / 100);
}

TEST(BlockCodec, GarbageIsRefused) {
  std::mt19937_64 random(11);
  const auto good = pack(made(8));
  for (int round = 0; round < 3000; ++round) {
    std::vector<std::byte> block(good);
    if (round % 2 == 0) block.resize(random() % 300);
    const std::size_t from = round % 4 < 2 ? 20 : 0;  // often with a plausible header
    const std::size_t hits = round % 2 == 0 ? block.size() : 1 + random() % 40;
    for (std::size_t i = 0; i < hits && block.size() > from; ++i) {
      const std::size_t at = round % 2 == 0 ? i : random() % block.size();
      if (at >= from) block[at] = static_cast<std::byte>(random());
    }
    if (block == good) continue;
    EXPECT_NE(refusal(block), "");
  }
}

}  // namespace
