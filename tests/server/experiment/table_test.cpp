// tests/server/experiment/table_test.cpp: one table in each format.
#include "server/experiment/table.hpp"

#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include <gtest/gtest.h>
#include <unistd.h>

#include "server/experiment/trial.hpp"

namespace server::experiment {
namespace {

Table sample() {
  return {.header = {"controller", "time s", "share"},
          .rows = {{"strip", "12.5", "50 %"}, {"say \"go\", now", "7", ""}},
          .words = 1};
}

TEST(Table, AsText) {
  EXPECT_EQ(to_text(sample()),
            "controller     time s  share\n"
            "strip            12.5   50 %\n"
            "say \"go\", now       7\n");
}

TEST(Table, AsMarkdown) {
  EXPECT_EQ(to_markdown(sample()),
            "| controller | time s | share |\n"
            "| --- | ---: | ---: |\n"
            "| strip | 12.5 | 50 % |\n"
            "| say \"go\", now | 7 |  |\n\n");
}

TEST(Table, AsCsvQuotesWhatNeedsIt) {
  EXPECT_EQ(to_csv(sample()),
            "controller,time s,share\r\n"
            "strip,12.5,50 %\r\n"
            "\"say \"\"go\"\", now\",7,\r\n");
}

TEST(Table, AsLatexEscapesWhatTexReserves) {
  EXPECT_EQ(to_latex(sample()),
            "\\begin{tabular}{lrr}\n\\hline\n"
            "controller & time s & share \\\\\n\\hline\n"
            "strip & 12.5 & 50 \\% \\\\\n"
            "say \"go\", now & 7 &  \\\\\n"
            "\\hline\n\\end{tabular}\n");
  const Table odd{.header = {"a_b~c\\d{e}"}, .rows = {}, .words = 1};
  EXPECT_NE(to_latex(odd).find("a\\_b\\~{}c\\textbackslash{}d\\{e\\}"), std::string::npos);
}

TEST(Table, AsJsonNumbersAreNumbers) {
  const nlohmann::json json = to_json(sample());
  ASSERT_EQ(json.size(), 2U);
  EXPECT_EQ(json[0]["time s"], 12.5);
  EXPECT_EQ(json[1]["time s"], 7);
  EXPECT_EQ(json[0]["share"], "50 %");
  EXPECT_TRUE(json[1]["share"].is_null());
  // A text that looks like a number stays a text.
  const Table words{.header = {"world", "x"}, .rows = {{"7", "inf"}}, .words = 1};
  EXPECT_EQ(to_json(words)[0]["world"], "7");
  EXPECT_TRUE(to_json(words)[0]["x"].is_null());
}

TEST(Table, FileExtensionSelectsTheFormat) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("tautline_table_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  const auto written = [&](const char* name) {
    write_table(sample(), (folder / name).string());
    std::ostringstream text;
    text << std::ifstream(folder / name, std::ios::binary).rdbuf();
    return text.str();
  };
  EXPECT_EQ(written("a.txt"), to_text(sample()));
  EXPECT_EQ(written("a.md"), to_markdown(sample()));
  EXPECT_EQ(written("a.csv"), to_csv(sample()));
  EXPECT_EQ(written("a.tex"), to_latex(sample()));
  EXPECT_EQ(nlohmann::json::parse(written("a.json")), to_json(sample()));
  EXPECT_TRUE(is_table_file("rows.csv"));
  EXPECT_FALSE(is_table_file("rows.xls"));
  EXPECT_THROW(write_table(sample(), (folder / "a.xls").string()), std::invalid_argument);
  EXPECT_THROW(write_table(sample(), (folder / "no/a.csv").string()), std::runtime_error);
  std::filesystem::remove_all(folder);
}

TEST(Table, ARunIsALineWithEveryFigureInFull) {
  Table table;
  const Row row{
      .outcome = algo::Outcome::Stuck,
      .reason = "No way.",
      .figures = {{"time_s", 0.1}, {"min_clearance_m", std::numeric_limits<double>::infinity()}}};
  add_run(table, {"world"}, {"7"}, row);
  add_run(table, {"world"}, {"8"}, row);
  EXPECT_EQ(table.header,
            (std::vector<std::string>{"world", "outcome", "reason", "time_s", "min_clearance_m"}));
  ASSERT_EQ(table.rows.size(), 2U);
  EXPECT_EQ(table.rows[1], (std::vector<std::string>{"8", "stuck", "No way.", "0.1", ""}));
  EXPECT_EQ(table.words, 3U);
}

}  // namespace
}  // namespace server::experiment
