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
