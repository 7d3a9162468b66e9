// tests/server/cli/options_test.cpp: numbers that an option's type cannot hold are refused.
#include "server/cli/options.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace server {
namespace {

using ::testing::HasSubstr;

/// The sentence that refuses `text` as the value of an option of this type; else empty.
template <typename T>
std::string refused(const std::string& text) {
  CLI::App app;
  T value{};
  Command(app).add_option("--number", value, "");
  try {
    app.parse("--number=" + text);
  } catch (const CLI::ParseError& e) {
    return e.what();
  }
  return "";
}

TEST(Options, ANegativeNumberIsNoUnsignedOne) {
  EXPECT_THAT(refused<std::uint64_t>("-1"), HasSubstr("-1 must not be negative"));
  EXPECT_THAT(refused<unsigned>("-1"), HasSubstr("must not be negative"));
  EXPECT_THAT(refused<std::optional<std::uint64_t>>("-1"), HasSubstr("must not be negative"));
  EXPECT_THAT(refused<std::vector<std::uint64_t>>("-1"), HasSubstr("must not be negative"));
  EXPECT_EQ(refused<std::uint64_t>("18446744073709551615"), "");
  EXPECT_EQ(refused<int>("-1"), "");
}

TEST(Options, ANumberBeyondItsTypeIsRefused) {
  EXPECT_THAT(refused<std::uint64_t>("99999999999999999999"),
              HasSubstr("99999999999999999999 must be from 0 to 18446744073709551615"));
  EXPECT_THAT(refused<std::int64_t>("99999999999999999999"),
              HasSubstr("must be from -9223372036854775808 to 9223372036854775807"));
  EXPECT_THAT(refused<std::optional<std::uint64_t>>("18446744073709551616"), HasSubstr("must be"));
  EXPECT_THAT(refused<std::uint16_t>("65536"), HasSubstr("must be from 0 to 65535"));
  EXPECT_THAT(refused<int>("-2147483649"), HasSubstr("must be from -2147483648"));
  EXPECT_EQ(refused<std::int64_t>("9223372036854775807"), "");
  EXPECT_EQ(refused<int>("-2147483648"), "");
  EXPECT_NE(refused<unsigned>("many"), "");
}

TEST(Options, ANumberIsFinite) {
  for (const char* bad : {"nan", "-nan", "inf", "-inf", "1e999"}) {
    EXPECT_THAT(refused<double>(bad), HasSubstr("must be a finite number")) << bad;
    EXPECT_NE(refused<std::optional<double>>(bad), "") << bad;
  }
  EXPECT_EQ(refused<double>("-1e-3"), "");
  EXPECT_EQ(refused<std::string>("nan"), "");
}

}  // namespace
}  // namespace server
