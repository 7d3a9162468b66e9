// tests/include_rule_test.cpp: holds every #include against the dependency rule of the folders.
//
//   algo <- sim, drivers;  db alone;  server over all;  nobody includes server or tests.
//
// CMake links the same rule; this test also sees headers, and says which line breaks it.
#include <algorithm>
#include <filesystem>
#include <fstream>
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

/// The includes of a C++ text, in order; those within comments are none.
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
    // Block comments that begin after code on a line are rare and end on it; only openings count.
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

/// What one folder may include.
struct Rule {
  std::vector<std::string> folders{};  // of ours
  std::string others{};                // regex over whole header names that are not ours
  std::string forbidden_standard{};    // regex over standard headers; empty forbids none
};

const std::vector<std::string>& our_folders() {
  static const std::vector<std::string> folders{"algo", "sim", "drivers", "db", "server", "tests"};
  return folders;
}

const std::map<std::string, Rule>& rules() {
  // algo is plain data: no clock, file, thread, socket or random number behind its mathematics.
  static const std::map<std::string, Rule> table{
      {"algo",
       {.folders = {"algo"},
        .others = "Eigen/.*",
        .forbidden_standard = "thread|mutex|shared_mutex|condition_variable|atomic|future|chrono|"
                              "fstream|filesystem|iostream|random|ctime"}},
      {"sim",
       {.folders = {"sim", "algo"},
        .others = R"(Eigen/.*|bt[A-Za-z]+\.h|(LinearMath|BulletCollision|BulletDynamics)/.*)"}},
      {"drivers",
       {.folders = {"drivers", "algo"},
        .others =
            R"(Eigen/.*|(fcntl|grp|netdb|poll|pthread|pty|sched|termios|unistd)\.h|sys/[a-z]+\.h|)"
            R"(netinet/tcp\.h|)"
            R"(asm/termbits\.h|linux/serial\.h|toml\+\+/toml\.h)"}},
      {"db", {.folders = {"db"}, .others = R"((sqlite3|zstd|fcntl|unistd)\.h|sys/(file|stat)\.h)"}},
      {"server", {.folders = {"server", "db", "drivers", "sim", "algo"}, .others = ".*"}},
  };
  return table;
}

/// Why `folder` may not have `include`; empty when it may.
std::string objection(const std::string& folder, const Include& include) {
  static const std::regex standard("[a-z][a-z0-9_]*");
  const Rule& rule = rules().at(folder);
  const std::string first = include.header.substr(0, include.header.find('/'));
  const bool ours = std::ranges::count(our_folders(), first) > 0 && first != include.header;
  if (include.header.find("..") != std::string::npos) {
    return "is not written from the repository root";
  }
  if (ours) {
    return std::ranges::count(rule.folders, first) > 0 ? ""
                                                       : folder + " may not include from " + first;
  }
  if (std::regex_match(include.header, standard)) {
    return std::regex_match(include.header, std::regex(rule.forbidden_standard))
               ? folder + " has no use for <" + include.header + ">"
               : "";
  }
  if (!std::regex_match(include.header, std::regex(rule.others))) {
    return folder + " does not know this library";
  }
  if (include.quoted && include.header.find('/') == std::string::npos) {
    // A generated header is quoted; one of ours without its folder is a slip.
    return include.header.ends_with("_generated.h") ? ""
                                                    : "is not written from the repository root";
  }
  return "";
}

/// "FILE:LINE: HEADER: why" for each include that breaks the rule.
std::vector<std::string> violations(const std::string& folder,
                                    const std::string& file,
                                    std::string_view text) {
  std::vector<std::string> found;
  for (const Include& include : includes_of(text)) {
    if (const std::string why = objection(folder, include); !why.empty()) {
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
  EXPECT_THAT(broken("sim", "#include \"server/session.hpp\""),
              ElementsAre(HasSubstr("from server")));
  EXPECT_THAT(broken("server", "#include \"tests/server/client.hpp\""),
              ElementsAre(HasSubstr("from tests")));
  EXPECT_THAT(broken("server", "#include \"session.hpp\""), ElementsAre(HasSubstr("root")));
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
  EXPECT_THAT(fine("server", "#include \"telemetry_generated.h\"\n#include <boost/asio.hpp>"),
              IsEmpty());
}

TEST(IncludeRule, HoldsInEveryFolder) {
  const std::filesystem::path root = tests::folder().parent_path();
  int files = 0;
  for (const auto& [folder, rule] : rules()) {
    if (!std::filesystem::exists(root / folder)) {
      continue;  // the rule for a folder may come before it
    }
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder)) {
      const std::string extension = entry.path().extension().string();
      if (extension == ".hpp" || extension == ".cpp") {
        ++files;
        const std::string name = std::filesystem::relative(entry.path(), root).string();
        EXPECT_THAT(violations(folder, name, text_of(entry.path())), IsEmpty());
      }
    }
  }
  EXPECT_GT(files, 10) << "looked in " << root;  // algo's headers alone are ten
}

}  // namespace
