// tests/drivers/robot_file_limits_test.cpp: every number of a robot's file, at its limits and
// beyond: every refusal names its key and its line.
#include <string>
#include <vector>

#include "tests/drivers/robot_error.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/robot_file.hpp"

namespace drivers {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

enum class BaseType : unsigned char { Roboteq, Pioneer };

/// A key, its place and its range.
struct Row {
  const char* header = "";   // the line of its table; empty: before all tables
  const char* section = "";  // as messages call the table
  const char* key = "";
  double min = 0;
  double max = 0;
  BaseType base = BaseType::Roboteq;
};

const std::vector<Row> kRows{
    {"", "", "period", 0.01, 0.2},
    {"[hull]", "[hull]", "radius", 0.05, 3},
    {"[limits]", "[limits]", "speed", 0.01, 2},
    {"[limits]", "[limits]", "turn", 0.01, 5},
    {"[limits]", "[limits]", "acceleration", 0.01, 5},
    {"[limits]", "[limits]", "turn_acceleration", 0.01, 20},
    {"[limits]", "[limits]", "jerk", 0, 1e4},
    {"[limits]", "[limits]", "turn_jerk", 0, 1e4},
    {"[[laser]]", "[[laser]]", "x", -5, 5},
    {"[[laser]]", "[[laser]]", "y", -5, 5},
    {"[[laser]]", "[[laser]]", "heading_deg", -360, 360},
    {"[[laser]]", "[[laser]]", "rate", 9600, 500'000},
    {"[[laser]]", "[[laser]]", "angle_deg", 100, 180},
    {"[[laser]]", "[[laser]]", "step_deg", 0.25, 1},
    {"[[laser]]", "[[laser]]", "range", 8, 80},
    {"[base]", "[base]", "track", 0.05, 1.5},
    {"[base]", "[base]", "watchdog", 0.05, 5},
    {"[base]", "[base]", "battery_low", 0, 60},
    {"[base]", "[base]", "rate", 9600, 115'200},
    {"[base]", "[base]", "wheel_radius", 0.01, 1},
    {"[base]", "[base]", "gear", 0.01, 1000},
    {"[base]", "[base]", "encoder_lines", 1, 5000},
    {"[base]", "[base]", "full_speed_rpm", 10, 65'000},
    {"[base]", "[base]", "max_current", 0, 500},
    {"[base]", "[base]", "watchdog", 0.2, 10, BaseType::Pioneer},
    {"[base]", "[base]", "metres_per_count", 1e-5, 1e-2, BaseType::Pioneer},
    {"[base]", "[base]", "speed_unit", 1e-5, 1e-2, BaseType::Pioneer},
    {"[base]", "[base]", "position_bits", 12, 15, BaseType::Pioneer},
};

std::vector<std::string> good_lines(BaseType base) {
  std::vector<std::string> lines{"name = \"a\"",
                                 "[hull]",
                                 "radius = 0.35",
                                 "[limits]",
                                 "speed = 0.1",
                                 "[[laser]]",
                                 "port = \"/dev/laser\"",
                                 "[base]",
                                 "port = \"/dev/base\"",
                                 "track = 0.5"};
  if (base == BaseType::Pioneer) {
    lines.emplace_back("type = \"pioneer\"");
  } else {
    for (const char* line :
         {"type = \"roboteq\"", "wheel_radius = 0.1", "gear = 20", "encoder_lines = 500"}) {
      lines.emplace_back(line);
    }
  }
  return lines;
}

/// The file with `row` set to `value`, and the line of that key.
struct Written {
  std::string text{};
  std::size_t line = 0;
};
Written write(const Row& row, const std::string& value) {
  std::vector<std::string> lines = good_lines(row.base);
  const std::string key = std::string(row.key) + " = ";
  std::size_t at = 0;
  while (row.header[0] != '\0' && lines[at] != row.header) ++at;
  std::size_t place = row.header[0] == '\0' ? 0 : at + 1;
  bool there = false;
  for (std::size_t i = place; i < lines.size() && lines[i][0] != '['; ++i) {
    if (!lines[i].starts_with(key)) continue;
    place = i;
    there = true;
  }
  if (there) lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(place));
  lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(place), key + value);
  Written out;
  out.line = place + 1;
  for (const std::string& line : lines) out.text += line + "\n";
  return out;
}

std::string number(double value) {
  std::string text = std::to_string(value);
  return text;
}

TEST(RobotFileLimits, NonNumbersAndValuesBeyondLimitsNameTheirLine) {
  for (const Row& row : kRows) {
    std::vector<std::string> bad{"nan",
                                 "inf",
                                 "-inf",
                                 "1e300",
                                 "-1e300",
                                 "1e19",
                                 "9223372036854775807",
                                 "-9223372036854775808",
                                 "true",
                                 "\"wide\"",
                                 "[1]",
                                 "{ a = 1 }",
                                 "1979-05-27",
                                 "07:32:00"};
    bad.push_back(number(row.max + 1));
    bad.push_back(number(row.min - 1));
    for (const std::string& value : bad) {
      const Written file = write(row, value);
      const std::string where = "my.toml:" + std::to_string(file.line) + ": " + row.section +
                                (row.section[0] == '\0' ? "" : " ") + row.key + " ";
      EXPECT_THAT(error_of(file.text), StartsWith(where)) << row.key << " = " << value;
    }
  }
}

TEST(RobotFileLimits, ValuesAtTheirLimitsAreAcceptedOrNameALine) {
  for (const Row& row : kRows) {
    for (const double value : {row.min, row.max}) {
      const std::string error = error_of(write(row, number(value)).text);
      EXPECT_TRUE(error.empty() || error.starts_with("my.toml:")) << error;
      EXPECT_THAT(error, ::testing::Not(HasSubstr("must be"))) << row.key << " = " << value;
    }
  }
}

TEST(RobotFileLimits, TomlSyntaxErrorsNameTheirLine) {
  for (const Row& row : kRows) {
    for (const char* value :
         {"", "1.", ".5", "1e", "0x", "--1", "1 2", "\"open", "1e99999999999"}) {
      const Written file = write(row, value);
      const std::string error = error_of(file.text);
      EXPECT_THAT(error, StartsWith("my.toml:" + std::to_string(file.line))) << row.key << value;
    }
  }
}

TEST(RobotFileLimits, WrongSectionTypesAreSentences) {
  for (const char* text : {"hull = 3",
                           "hull = []",
                           "name = \"a\"\nhull = 3\n",
                           "name = \"a\"\n[hull]\nradius = 1\n[base]\n",
                           "name = \"a\"\nhull = { radius = 1 }\nlimits = 4\n",
                           "name = \"a\"\nhull = { radius = 1 }\nlaser = 4\n",
                           "name = \"a\"\nhull = { radius = 1 }\nlaser = []\n",
                           "name = \"a\"\nhull = { radius = 1 }\nlaser = [1]\n",
                           "name = \"a\"\nhull = { radius = 1 }\nbase = [1]\n",
                           "\xff\xfe",
                           "",
                           "\n\n\n"}) {
    EXPECT_THAT(error_of(text), ::testing::MatchesRegex("my\\.toml:[1-9][0-9]*: (.|\n)+")) << text;
  }
}

}  // namespace
}  // namespace drivers
