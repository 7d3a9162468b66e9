// tests/include_rule_test.cpp: checks every #include by the rule of the rooms
// (docs/adr/0011-rooms.md), and the size of every room.
//
// CMake enforces the same rule for linking; this test also covers headers and names the line.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "tests/folders.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace {

struct Include {
  int line = 0;          // 1 is the first
  std::string header{};  // as written, without its brackets
  bool quoted = false;
};

/// The includes of a C++ text, in order, without those in comments.
std::vector<Include> includes_of(std::string_view text) {
  static const std::regex directive(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"])");
  std::vector<Include> found;
  std::istringstream lines{std::string(text)};
  bool in_comment = false;
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (!in_comment) {
      std::smatch match;
      if (std::regex_search(line, match, directive)) {
        found.push_back({.line = number, .header = match[2], .quoted = match[1] == "\""});
      }
    }
    // A block comment after code is rare and ends on its line; only openings at the start count.
    const std::size_t opening = line.rfind("/*");
    const std::size_t closing = line.rfind("*/");
    if (opening != std::string::npos && line.rfind("//", opening) == std::string::npos) {
      in_comment = closing == std::string::npos || closing < opening;
    } else if (closing != std::string::npos) {
      in_comment = false;
    }
  }
  return found;
}

/// The includes that one room may have: its own headers and those of `rooms`.
struct Rule {
  std::vector<std::string> rooms{};
  std::string others{};              // regex over whole header names that are not ours
  std::string forbidden_standard{};  // regex over standard headers; empty forbids none
};

const std::vector<std::string>& our_folders() {
  static const std::vector<std::string> folders{"algo", "sim", "drivers", "db", "server", "tests"};
  return folders;
}

// algo is plain data and mathematics: no clock, file, thread, socket or random number.
constexpr const char* kNoPlainData =
    "thread|mutex|shared_mutex|condition_variable|atomic|future|chrono|fstream|filesystem|iostream|"
    "random|ctime";
constexpr const char* kPosix =
    R"((fcntl|grp|netdb|poll|pthread|pty|sched|termios|unistd)\.h|sys/[a-z]+\.h|netinet/(in|tcp)\.h|arpa/inet\.h|)"
    R"(asm/termbits\.h|linux/serial\.h)";
constexpr const char* kDocuments = R"(Eigen/.*|nlohmann/json\.hpp|fmt/[a-z]+\.h|(pwd|unistd)\.h)";

std::vector<std::string> operator+(std::vector<std::string> rooms, const std::string& one) {
  rooms.push_back(one);
  return rooms;
}

std::map<std::string, Rule> make_rules() {
  using Rooms = std::vector<std::string>;
  const Rooms methods{"algo",
                      "algo/filter",
                      "algo/strip",
                      "algo/full_strip",
                      "algo/baselines",
                      "algo/mapping",
                      "algo/teleop",
                      "algo/terrain",
                      "algo/arm",
                      "algo/pipeline"};
  const Rooms below_run = methods + "sim" + "drivers";
  const Rooms below_record = below_run + "server/run" + "db";
  const Rooms below_experiment = below_record + "server/record";
  const Rooms below_lab = below_experiment + "server/experiment";
  const std::string eigen = "Eigen/.*";
  const std::string posix = kPosix;
  const std::string documents = kDocuments;
  const std::string boost_data = R"(|boost/(lockfree/.*|intrusive_ptr\.hpp))";
  const auto method = [&](Rooms rooms) { return Rule{std::move(rooms), eigen, kNoPlainData}; };
  return {
      {"algo", method({})},
      {"algo/filter", method({"algo"})},
      {"algo/strip", method({"algo"})},
      {"algo/full_strip", method({"algo", "algo/strip"})},
      {"algo/baselines", method({"algo", "algo/strip"})},
      {"algo/mapping", method({"algo"})},
      {"algo/teleop", method({"algo"})},
      {"algo/terrain", method({"algo", "algo/filter"})},
      {"algo/arm", method({"algo"})},
      {"algo/pipeline",
       method({"algo",
               "algo/filter",
               "algo/strip",
               "algo/teleop",
               "algo/terrain",
               "algo/full_strip",
               "algo/baselines",
               "algo/arm"})},
      {"sim",
       {{"algo", "algo/terrain", "algo/arm"},
        R"(Eigen/.*|fmt/[a-z]+\.h|bt[A-Za-z]+\.h|(LinearMath|BulletCollision|BulletDynamics)/.*)",
        ""}},
      {"drivers",
       {{"algo", "algo/filter", "algo/terrain", "algo/pipeline"},
        eigen + "|" + posix + R"(|fmt/[a-z]+\.h|toml\+\+/toml\.h|comedilib\.h|dlfcn\.h)",
        ""}},
      {"drivers/emulators",
       {{"algo", "drivers"}, eigen + R"(|comedilib\.h|(fcntl|unistd)\.h|sys/(mman|stat)\.h)", ""}},
      {"db", {{}, R"((sqlite3|zstd|fcntl|unistd)\.h|sys/(file|stat|vfs)\.h)", ""}},
      {"server/external",
       {{"algo", "algo/pipeline"},
        eigen + "|" + posix +
            R"(|fmt/[a-z]+\.h|flatbuffers/.*|controller_generated\.h|(dlfcn|spawn)\.h)",
        ""}},
      {"server/run", {below_run, documents + boost_data + R"(|yaml-cpp/yaml\.h)", ""}},
      {"server/record",
       {below_record,
        documents + boost_data + R"(|flatbuffers/.*|telemetry_generated\.h|spdlog/.*)",
        ""}},
      {"server/experiment", {below_experiment, documents + R"(|gnu/libc-version\.h)", ""}},
      {"server/lab", {below_lab, documents + R"(|nlopt\.hpp)", ""}},
      {"server/serve", {below_lab, documents + "|" + posix + "|boost/.*|spdlog/.*", ""}},
      {"server/emulate",
       {below_run + "server/run" + "drivers/emulators",
        documents + "|" + posix + "|spdlog/.*",
        ""}},
      {"server/cli",
       {below_lab + "drivers/emulators" + "server/external" + "server/lab" + "server/serve" +
            "server/emulate",
        ".*",
        ""}},
  };
}

const std::map<std::string, Rule>& rules() {
  static const std::map<std::string, Rule> table = make_rules();
  return table;
}

/// The room of `path`, a file or a header; empty without one.
std::string room_of(const std::string& path) {
  std::string found;
  for (const auto& [room, rule] : rules()) {
    if (path.starts_with(room + "/") && room.size() > found.size()) found = room;
  }
  return found;
}

/// Why `room` may not use `include`; empty if it may.
std::string objection(const std::string& room, const Include& include) {
  static const std::regex standard("[a-z][a-z0-9_]*");
  const Rule& rule = rules().at(room);
  const std::string first = include.header.substr(0, include.header.find('/'));
  const bool ours = std::ranges::count(our_folders(), first) > 0 && first != include.header;
  if (include.header.find("..") != std::string::npos) {
    return "is not written from the repository root";
  }
  if (ours) {
    const std::string other = room_of(include.header);
    if (other == room || std::ranges::count(rule.rooms, other) > 0) return "";
    return room + " may not include from " + (other.empty() ? first : other);
  }
  if (std::regex_match(include.header, standard)) {
    return std::regex_match(include.header, std::regex(rule.forbidden_standard))
               ? room + " has no use for <" + include.header + ">"
               : "";
  }
  if (!std::regex_match(include.header, std::regex(rule.others))) {
    return room + " does not know this library";
  }
  if (include.quoted && include.header.find('/') == std::string::npos) {
    // A generated header is quoted; one of ours without its folder is a mistake.
    return include.header.ends_with("_generated.h") ? ""
                                                    : "is not written from the repository root";
  }
  return "";
}

/// "FILE:LINE: HEADER: why" for each include that breaks the rule.
std::vector<std::string> violations(const std::string& room,
                                    const std::string& file,
                                    std::string_view text) {
  std::vector<std::string> found;
  for (const Include& include : includes_of(text)) {
    if (const std::string why = objection(room, include); !why.empty()) {
      std::ostringstream sentence;
      sentence << file << ':' << include.line << ": " << include.header << ": " << why;
      found.push_back(sentence.str());
    }
  }
  return found;
}

std::string text_of(const std::filesystem::path& file) {
  const std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(IncludeRule, ReadsIncludesWithTheirLinesAndSkipsComments) {
  const std::vector<Include> found = includes_of(
      "// #include \"server/a.hpp\"\n"
      "#pragma once\n"
      "  #  include <vector>\n"
      "/* three lines\n"
      "#include \"server/b.hpp\"\n"
      "*/ \n"
      "#include \"algo/types.hpp\"  // why\n");
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].line, 3);
  EXPECT_EQ(found[0].header, "vector");
  EXPECT_FALSE(found[0].quoted);
  EXPECT_EQ(found[1].line, 7);
  EXPECT_EQ(found[1].header, "algo/types.hpp");
  EXPECT_TRUE(found[1].quoted);
}

TEST(IncludeRule, FindsEachPlantedViolation) {
  const auto broken = [](const char* folder, const char* line) {
    return violations(folder, "planted.cpp", line);
  };
  EXPECT_THAT(broken("algo", "#include \"sim/world.hpp\""),
              ElementsAre("planted.cpp:1: sim/world.hpp: algo may not include from sim"));
  EXPECT_THAT(broken("algo", "#include <nlohmann/json.hpp>"),
              ElementsAre(HasSubstr("algo does not know this library")));
  EXPECT_THAT(broken("algo", "\n#include <thread>"), ElementsAre(HasSubstr("planted.cpp:2: ")));
  EXPECT_THAT(broken("sim", "#include \"db/run_store.hpp\""), ElementsAre(HasSubstr("from db")));
  EXPECT_THAT(broken("sim", "#include <boost/asio.hpp>"), ElementsAre(HasSubstr("library")));
  EXPECT_THAT(broken("sim", "#include \"../algo/types.hpp\""), ElementsAre(HasSubstr("root")));
  EXPECT_THAT(broken("drivers", "#include \"sim/world.hpp\""), ElementsAre(HasSubstr("from sim")));
  EXPECT_THAT(broken("drivers", "#include <btBulletDynamicsCommon.h>"),
              ElementsAre(HasSubstr("library")));
  EXPECT_THAT(broken("db", "#include \"algo/types.hpp\""), ElementsAre(HasSubstr("from algo")));
  EXPECT_THAT(broken("db", "#include <Eigen/Core>"), ElementsAre(HasSubstr("library")));
  EXPECT_THAT(broken("sim", "#include \"server/serve/session.hpp\""),
              ElementsAre(HasSubstr("from server/serve")));
  EXPECT_THAT(broken("algo", "#include \"algo/strip/strip.hpp\""),
              ElementsAre(HasSubstr("from algo/strip")));
  EXPECT_THAT(broken("algo/full_strip", "#include \"algo/baselines/dwa.hpp\""),
              ElementsAre(HasSubstr("from algo/baselines")));
  EXPECT_THAT(broken("server/run", "#include \"server/record/recorder.hpp\""),
              ElementsAre(HasSubstr("from server/record")));
  EXPECT_THAT(broken("server/run", "#include <boost/asio.hpp>"), ElementsAre(HasSubstr("library")));
  EXPECT_THAT(broken("server/run", "#include <zstd.h>"), ElementsAre(HasSubstr("library")));
  EXPECT_THAT(broken("server/lab", "#include \"server/serve/session.hpp\""),
              ElementsAre(HasSubstr("from server/serve")));
  EXPECT_THAT(broken("server/serve", "#include \"server/lab/barn/barn_run.hpp\""),
              ElementsAre(HasSubstr("from server/lab")));
  EXPECT_THAT(broken("server/serve", "#include \"tests/server/client.hpp\""),
              ElementsAre(HasSubstr("from tests")));
  EXPECT_THAT(broken("server/cli", "#include \"session.hpp\""), ElementsAre(HasSubstr("root")));
}

TEST(IncludeRule, LetsEachFolderHaveWhatItNeeds) {
  const auto fine = [](const char* folder, const char* text) {
    return violations(folder, "fine.cpp", text);
  };
  EXPECT_THAT(fine("algo", "#include <cmath>\n#include <Eigen/Core>\n#include \"algo/types.hpp\""),
              IsEmpty());
  EXPECT_THAT(fine("sim", "#include <btBulletDynamicsCommon.h>\n#include <LinearMath/btScalar.h>"),
              IsEmpty());
  EXPECT_THAT(fine("sim", "#include \"algo/robot.hpp\"\n#include <thread>"), IsEmpty());
  EXPECT_THAT(fine("drivers", "#include <termios.h>\n#include \"algo/robot.hpp\""), IsEmpty());
  EXPECT_THAT(fine("db", "#include <sqlite3.h>\n#include <zstd.h>\n#include \"db/a.hpp\""),
              IsEmpty());
  EXPECT_THAT(fine("server/record", "#include \"telemetry_generated.h\""), IsEmpty());
  EXPECT_THAT(fine("server/serve", "#include <boost/asio.hpp>\n#include <vector>"), IsEmpty());
}

struct House {
  std::map<std::string, int> lines{};  // of each room
  std::vector<std::string> outside{};  // files that stand in no room
  std::vector<std::string> broken{};
};

House look() {
  House house;
  const std::filesystem::path root = tests::folder().parent_path();
  for (const char* folder : {"algo", "sim", "drivers", "db", "server"}) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder)) {
      const std::string extension = entry.path().extension().string();
      if (extension != ".hpp" && extension != ".cpp") continue;
      const std::string name = std::filesystem::relative(entry.path(), root).string();
      const std::string room = room_of(name);
      if (room.empty()) {
        house.outside.push_back(name);
        continue;
      }
      const std::string text = text_of(entry.path());
      house.lines[room] += static_cast<int>(std::ranges::count(text, '\n'));
      std::ranges::copy(violations(room, name, text), std::back_inserter(house.broken));
    }
  }
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root / "web" / "src")) {
    const std::string extension = entry.path().extension().string();
    if (extension != ".ts" && extension != ".tsx" && extension != ".css") continue;
    if (entry.path().string().find("/wire/") != std::string::npos) continue;  // generated
    house.lines["web"] += static_cast<int>(std::ranges::count(text_of(entry.path()), '\n'));
  }
  return house;
}

TEST(IncludeRule, HoldsInEveryRoom) {
  const House house = look();
  EXPECT_THAT(house.broken, IsEmpty());
  EXPECT_THAT(house.outside, IsEmpty());
  for (const auto& [room, rule] : rules()) EXPECT_GT(house.lines.count(room), 0U) << room;
}

TEST(IncludeRule, NoRoomHoldsMoreThanAFifth) {
  const House house = look();
  int all = 0;
  for (const auto& [room, lines] : house.lines) all += lines;
  ASSERT_GT(all, 10'000);
  for (const auto& [room, lines] : house.lines) EXPECT_LE(5 * lines, all) << room;
}

TEST(IncludeRule, HasNoCircle) {
  // A room may depend only on rooms with fewer dependencies.
  std::map<std::string, std::size_t> height;
  const std::function<std::size_t(const std::string&, std::size_t)> climb =
      [&](const std::string& room, std::size_t depth) -> std::size_t {
    EXPECT_LT(depth, rules().size()) << room << " stands on itself";
    if (depth >= rules().size() || height.contains(room)) return height[room];
    std::size_t highest = 0;
    for (const std::string& below : rules().at(room).rooms) {
      highest = std::max(highest, climb(below, depth + 1) + 1);
    }
    return height[room] = highest;
  };
  for (const auto& [room, rule] : rules()) climb(room, 0);
  EXPECT_EQ(height["algo"], 0U);
  EXPECT_GT(height["server/cli"], height["server/lab"]);
}

}  // namespace
