// tests/drivers/psd_protocol_test.cpp: lines of the floor sensors' adapter, whole, damaged and cut.
#include "drivers/psd_protocol.hpp"

#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "tests/drivers/hex.hpp"
#include <gtest/gtest.h>

namespace drivers::psd {
namespace {

ByteView bytes(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}
std::string text(const Reading& reading) {
  return std::string(line_of(reading).text());
}
Reading sample(std::uint16_t count) {
  return {123'456'789, {count, 7, 4095, 0}};
}

/// The readings in `stream`, given to the reader in pieces of `piece` bytes.
std::vector<Reading> read(std::string_view stream, std::size_t piece = 1) {
  Reader reader;
  std::vector<Reading> out;
  for (std::size_t at = 0; at < stream.size(); at += piece) {
    reader.feed(
        bytes(stream.substr(at, piece)),
        [&](ByteView line) { out.push_back(*parse(line)); },
        [](std::uint8_t) {});
  }
  reader.expire([&](ByteView line) { out.push_back(*parse(line)); }, [](std::uint8_t) {});
  return out;
}

TEST(PsdProtocol, TheCheckValueIsThePublishedOne) {
  EXPECT_EQ(crc(bytes("123456789")), 0x29B1);
}

TEST(PsdProtocol, ALineLooksAsDocumented) {
  const std::string line = text({12345, {1180, 1182, 1523, 1519}});
  EXPECT_EQ(line.size(), kLineBytes);
  EXPECT_EQ(line, "$PSD,0000012345,1180,1182,1523,1519*A28E\r\n");
  EXPECT_EQ(parse(bytes(line).first(40)), (Reading{12345, {1180, 1182, 1523, 1519}}));
  EXPECT_EQ(text({4294967295U, {5000, 0, 0, 0}}).substr(0, 21), "$PSD,4294967295,4095,");
}

TEST(PsdProtocol, OnlyWholeLinesWithinTheirLimitsAreRead) {
  const std::string good = text(sample(1)).substr(0, 40);
  const auto with_check = [](std::string line) {
    const std::uint16_t check = crc(bytes(std::string_view(line).substr(1, 34)));
    constexpr std::string_view kDigits = "0123456789ABCDEF";
    for (unsigned i = 0; i < 4; ++i) line[36 + i] = kDigits[(check >> (12 - 4 * i)) & 0xFU];
    return line;
  };
  ASSERT_EQ(with_check(good), good);
  ASSERT_TRUE(parse(bytes(good)));
  EXPECT_FALSE(parse(bytes(good).first(39)));
  const auto changed = [&](std::size_t at, char to) {
    std::string line = good;
    line[at] = to;
    return with_check(line);
  };
  EXPECT_FALSE(parse(bytes(changed(4, ';'))));   // the mark
  EXPECT_FALSE(parse(bytes(changed(5, '5'))));   // a clock beyond 32 bits
  EXPECT_FALSE(parse(bytes(changed(6, ' '))));   // no digit
  EXPECT_FALSE(parse(bytes(changed(15, '.'))));  // no comma
  EXPECT_FALSE(parse(bytes(changed(26, '5'))));  // a count of 5095
  EXPECT_TRUE(parse(bytes(changed(24, '9'))));
  std::string lower = good;
  for (char& c : lower) c = static_cast<char>(c >= 'A' && c <= 'F' ? c - 'A' + 'a' : c);
  EXPECT_EQ(parse(bytes(lower)).has_value(), lower == good);
}

/// One flipped bit or lost byte anywhere costs that line only.
TEST(PsdProtocol, DamageCostsOneLine) {
  const std::string damaged = text(sample(1));
  for (std::size_t at = 0; at < damaged.size(); ++at) {
    for (unsigned bit = 0; bit < 8; ++bit) {
      std::string line = damaged;
      line[at] = static_cast<char>(line[at] ^ static_cast<char>(1U << bit));
      const auto got = read(text(sample(0)) + line + text(sample(2)) + text(sample(3)));
      ASSERT_GE(got.size(), 3U) << at;
      EXPECT_EQ(got.front(), sample(0));
      EXPECT_EQ(got[got.size() - 2], sample(2)) << at;
      EXPECT_EQ(got.back(), sample(3));
      // The line's end is no part of its content.
      EXPECT_EQ(got.size(), at < 40 ? 3U : 4U) << at << " " << bit;
    }
    std::string line = damaged;
    line.erase(at, 1);
    EXPECT_GE(read(text(sample(0)) + line + text(sample(2)) + text(sample(3))).size(), 3U) << at;
  }
}

TEST(PsdProtocol, LinesAreFoundInPiecesAndAmongGarbage) {
  std::mt19937_64 random(3);
  std::string stream;
  for (std::uint16_t i = 0; i < 50; ++i) {
    for (std::uint64_t k = random() % 60; k > 0; --k) {
      stream += "$PSD,0123456789*\r\n"[random() % 18];
    }
    stream += "\n" + text(sample(i));
  }
  for (const std::size_t piece : {1U, 7U, 41U, 1000U}) {
    const auto got = read(stream, piece);
    ASSERT_EQ(got.size(), 50U) << piece;
    for (std::uint16_t i = 0; i < 50; ++i) EXPECT_EQ(got[i], sample(i));
  }
}

TEST(PsdProtocol, AStreamCutAnywhereGivesTheLinesThatFollow) {
  const std::string stream = text(sample(0)) + text(sample(1)) + text(sample(2));
  for (std::size_t at = 1; at < kLineBytes; ++at) {
    const auto got = read(std::string_view(stream).substr(at));
    ASSERT_EQ(got.size(), 2U) << at;
    EXPECT_EQ(got[0], sample(1));
    EXPECT_EQ(read(std::string_view(stream).substr(0, stream.size() - at - 2)).size(), 2U) << at;
  }
}

}  // namespace
}  // namespace drivers::psd
