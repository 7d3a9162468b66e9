// tests/docs_test.cpp: every file that a Markdown page links to exists, and every section that the
// code cites. Each part built on the coverage page has a file and a test. The page on hardware has
// the result of every fault that the trials inject. The web page has words for every hold and
// limit.
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/folders.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

fs::path root() {
  return tests::folder().parent_path();
}

std::string text_of(const fs::path& file) {
  const std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// The page without code blocks and code spans, which hold no links.
std::string prose_of(const std::string& markdown) {
  std::string prose;
  std::istringstream lines(markdown);
  bool in_block = false;
  for (std::string line; std::getline(lines, line);) {
    const bool fence = line.starts_with("```");
    if (fence) in_block = !in_block;
    if (fence || in_block) continue;
    bool in_code = false;
    for (const char c : line) {
      if (c == '`') in_code = !in_code;
      if (!in_code) prose += c;
    }
    prose += '\n';
  }
  return prose;
}

/// Targets of [text](target) and ![text](target) that are local files, without their anchors.
std::vector<std::string> links_of(const std::string& markdown) {
  static const std::regex link(R"(\]\(([^)\s#]+)(#[^)]*)?\))");
  const std::string prose = prose_of(markdown);
  std::vector<std::string> found;
  for (std::sregex_iterator it(prose.begin(), prose.end(), link), end; it != end; ++it) {
    const std::string target = (*it)[1];
    if (target.find("://") == std::string::npos) found.push_back(target);
  }
  return found;
}

/// "FILE: TARGET" for each link to a missing file.
std::vector<std::string> broken_links(const fs::path& page) {
  std::set<std::string> broken;
  for (const std::string& target : links_of(text_of(page))) {
    if (!fs::exists(page.parent_path() / target)) {
      broken.insert(page.filename().string() + ": " + target);
    }
  }
  return {broken.begin(), broken.end()};
}

std::vector<fs::path> pages() {
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(root())) {
    if (entry.path().extension() == ".md") found.push_back(entry.path());
  }
  for (const auto& entry : fs::recursive_directory_iterator(root() / "docs")) {
    if (entry.path().extension() == ".md") found.push_back(entry.path());
  }
  return found;
}

/// Cells of a table row, trimmed; empty for any other line.
std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  if (!line.starts_with("| ")) return cells;
  std::istringstream parts(line.substr(1));
  for (std::string part; std::getline(parts, part, '|');) {
    const std::size_t first = part.find_first_not_of(' ');
    const std::size_t last = part.find_last_not_of(' ');
    cells.push_back(first == std::string::npos ? "" : part.substr(first, last - first + 1));
  }
  return cells;
}

/// "equations.md E.4": the sections of docs/ that the file `text` cites.
std::vector<std::string> citations_in(const std::string& text) {
  static const std::regex citation(R"(\b([a-z0-9-]+\.md) ([A-Z](\.[0-9]+)?|[0-9]+)\b)");
  std::vector<std::string> found;
  for (std::sregex_iterator it(text.begin(), text.end(), citation), end; it != end; ++it) {
    found.push_back(it->str(1) + " " + it->str(2));
  }
  return found;
}

/// The sections of `page` that have a letter or a number, as citations_in() gives them.
std::set<std::string> sections_of(const fs::path& page) {
  static const std::regex heading(R"(^#+ ([A-Z](\.[0-9]+)?|[0-9]+)\.? .*)");
  std::set<std::string> found;
  std::istringstream lines(text_of(page));
  std::smatch match;
  for (std::string line; std::getline(lines, line);) {
    if (std::regex_match(line, match, heading)) {
      found.insert(page.filename().string() + " " + match.str(1));
    }
  }
  return found;
}

TEST(Docs, EverySectionThatTheCodeCitesIsThere) {
  EXPECT_THAT(citations_in("thesis Eq. 3; equations.md E.4 and physics.md 3. Then (sensors.md 2)"),
              ElementsAre("equations.md E.4", "physics.md 3", "sensors.md 2"));
  std::set<std::string> sections;
  for (const fs::path& page : pages()) sections.merge(sections_of(page));
  std::set<std::string> missing;
  int cited = 0;
  for (const char* folder : {"algo", "sim", "drivers", "db", "server", "web/src", "tests"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root() / folder)) {
      const std::string kind = entry.path().extension();
      if (kind != ".hpp" && kind != ".cpp" && kind != ".ts" && kind != ".tsx") continue;
      if (entry.path().filename() == "docs_test.cpp") continue;
      for (const std::string& citation : citations_in(text_of(entry.path()))) {
        ++cited;
        if (!sections.contains(citation)) missing.insert(citation);
      }
    }
  }
  EXPECT_GT(cited, 20);
  EXPECT_THAT(missing, IsEmpty());
}

TEST(Docs, LinksAreFoundAsMarkdownHasThem) {
  EXPECT_THAT(links_of("[a](x.md) and ![b](p/q.svg), [c](y.md#part), [d](https://e.org/z)\n"
                       "[e](#here) `[f](no.md)`\n```\n[g](no.md)\n```\n[h](adr)"),
              ElementsAre("x.md", "p/q.svg", "y.md", "adr"));
}

TEST(Docs, EveryLinkedFileExists) {
  const std::vector<fs::path> all = pages();
  EXPECT_GT(all.size(), 5U) << "looked in " << root();
  for (const fs::path& page : all) EXPECT_THAT(broken_links(page), IsEmpty());
}

/// Rows of four cells are part, code, test, verdict.
TEST(Docs, CoverageClaimsNothingBuiltWithoutAFileAndATest) {
  std::istringstream lines(text_of(root() / "docs/coverage.md"));
  int built = 0;
  for (std::string line; std::getline(lines, line);) {
    const std::vector<std::string> cells = cells_of(line);
    if (cells.size() != 4) continue;
    const std::string& verdict = cells[3];
    if (!verdict.starts_with("built") && !verdict.starts_with("corrected")) continue;
    ++built;
    EXPECT_THAT(links_of(cells[1]), ::testing::Not(IsEmpty())) << line;
    EXPECT_THAT(links_of(cells[2]), ::testing::Not(IsEmpty())) << line;
    for (const std::string& test : links_of(cells[2])) EXPECT_TRUE(test.starts_with("../tests/"));
  }
  EXPECT_GT(built, 10);
}

/// Rows of seven cells, which `tests/dev/hardware_faults.py` prints, begin with fault and base.
TEST(Docs, HardwareHasARowForEveryFaultOnEveryBase) {
  std::istringstream lines(text_of(root() / "docs/hardware.md"));
  std::set<std::string> rows;
  for (std::string line; std::getline(lines, line);) {
    const std::vector<std::string> cells = cells_of(line);
    if (cells.size() == 7) rows.insert(cells[0] + ", " + cells[1]);
  }
  std::set<std::string> wanted{"fault, base"};
  for (const auto& fault : nlohmann::json::parse(text_of(root() / "tests/hardware/faults.json"))) {
    for (const char* base : {"roboteq", "p2os", "analog"}) {
      wanted.insert(fault.at("fault").get<std::string>().append(", ").append(base));
    }
  }
  for (const auto& fault :
       nlohmann::json::parse(text_of(root() / "tests/hardware/floor_faults.json"))) {
    wanted.insert(fault.at("fault").get<std::string>().append(", roboteq"));
  }
  EXPECT_EQ(rows, wanted);
}

/// Names of the constants of `type` in the headers below algo, as in `Hold kBumper{"bumper", ...`.
std::set<std::string> names_of(const std::string& type) {
  const std::regex constant("constexpr " + type + R"re( k\w+\{\s*"(\w+)")re");
  std::set<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(root() / "algo")) {
    if (entry.path().extension() != ".hpp") continue;
    const std::string text = text_of(entry.path());
    for (std::sregex_iterator it(text.begin(), text.end(), constant), end; it != end; ++it) {
      names.insert((*it)[1]);
    }
  }
  return names;
}

/// The keys of the table `name` in a script of the page.
std::set<std::string> keys_in(const fs::path& script, const std::string& name) {
  const std::string text = text_of(root() / script);
  const std::size_t begin = text.find("const " + name + ":");
  std::istringstream lines(text.substr(begin, text.find("\n};", begin) - begin));
  static const std::regex entry(R"(^  (\w+): .*)");
  std::set<std::string> keys;
  std::smatch match;
  for (std::string line; std::getline(lines, line);) {
    if (std::regex_match(line, match, entry)) keys.insert(match[1]);
  }
  return keys;
}

TEST(Docs, ThePageHasWordsForEveryHoldAndLimit) {
  std::set<std::string> holds = names_of("Hold");
  EXPECT_EQ(holds.erase("stopped"), 1U) << "which is no mark of the timeline";
  EXPECT_EQ(keys_in("web/src/state/events.ts", "kHoldWords"), holds);
  EXPECT_EQ(keys_in("web/src/teleop/reasons.ts", "kLimits"), names_of("Limit"));
}

}  // namespace
