// tests/bench/main.cpp: `./dev bench`: runs the rows, prints the table, keeps or compares results.
#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <string>
#include <string_view>
#include <vector>

#include "tests/bench/report.hpp"
#include "tests/bench/rows.hpp"
#include <CLI/CLI.hpp>
#include <benchmark/benchmark.h>
#include <fmt/core.h>

namespace {

using bench::Pass;

struct Family {
  std::string_view rows{};
  void (*run)(Pass&) = nullptr;
};
constexpr std::array<Family, 13> kFamilies{{
    {"P1 P1r P2 P3 P4 P5", bench::scans},
    {"P6 P7 P11", bench::ticks},
    {"P9", bench::headless},
    {"P10", bench::fleets},
    {"P12", bench::filters},
    {"P13", bench::control},
    {"P14 P16 P17", bench::streaming},
    {"P18", bench::frames},
    {"P19 P20 P21", bench::storage},
    {"P22", bench::timers},
    {"P23", bench::external},
    {"P24 P26", bench::arms},
    {"P25", bench::terrain},
}};
constexpr std::string_view kElsewhere =
    "Not here: P8 and P15 compare with other programs and are measured outside this repository.";

/// Whether `row` is one of the words of `rows`.
bool lists(std::string_view rows, std::string_view row) {
  return fmt::format(" {} ", rows).find(fmt::format(" {} ", row)) != std::string::npos;
}

bool wanted(const Family& family, const std::vector<std::string>& only) {
  return only.empty() || std::any_of(only.begin(), only.end(), [&](const std::string& row) {
           return lists(family.rows, row);
         });
}

/// @return the sentences of what failed
std::vector<std::string> run(Pass& pass, const std::vector<std::string>& only) {
  std::vector<std::string> failures;
  for (const Family& family : kFamilies) {
    if (!wanted(family, only)) continue;
    fmt::print(stderr, "{}\n", family.rows);
    try {
      family.run(pass);
    } catch (const std::exception& e) {
      failures.push_back(fmt::format("{}: {}", family.rows, e.what()));
      fmt::print(stderr, "FAILED {}\n", failures.back());
    }
  }
  return failures;
}

int bench_main(int argc, char** argv) {
  CLI::App app{"Tautline's benchmarks: ratios to references measured in the same run. " +
               std::string(kElsewhere)};
  bool quick = false;
  std::vector<std::string> only;
  std::string out;
  std::vector<std::string> files;
  app.add_flag("--quick", quick, "Only checks that ours and the references agree; no times");
  app.add_option("--only", only, "Rows to run with their families, such as P1,P12")->delimiter(',');
  int calls = 0;
  app.add_option("--count", calls, "Calls of each subject for an instruction counter; no times")
      ->check(CLI::Range(1, 100000));
  app.add_option("--out", out, "Writes the results as JSON");
  app.add_option("--compare", files, "Compares two result files; fails when something is worse")
      ->expected(2)
      ->type_name("OLD NEW");
  CLI11_PARSE(app, argc, argv);
  if (!files.empty()) return bench::compare(files[0], files[1]) == 0 ? 0 : 1;
  for (const std::string& row : only) {
    const bool known = std::any_of(kFamilies.begin(), kFamilies.end(), [&](const Family& family) {
      return lists(family.rows, row);
    });
    if (!known) throw std::runtime_error("There is no row " + row + ". " + std::string(kElsewhere));
  }

  std::array<std::string, 2> words{"bench", "--benchmark_enable_random_interleaving=true"};
  std::array<char*, 2> given{words[0].data(), words[1].data()};
  int count = 2;
  benchmark::Initialize(&count, given.data());
  Pass pass = calls > 0 ? Pass::counting(calls) : Pass(quick);
  const std::vector<std::string> failures = run(pass, only);
  if (!pass.quick()) {
    bench::print_table(pass.figures());
    fmt::print("{}\n", kElsewhere);
  }
  if (!out.empty()) bench::write_results(out, pass.figures(), failures);
  for (const std::string& failure : failures) fmt::print(stderr, "FAILED {}\n", failure);
  if (quick && failures.empty()) fmt::print("Ours and the references agree.\n");
  return failures.empty() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return bench_main(argc, argv);
  } catch (const std::exception& e) {
    fmt::print(stderr, "tautline_bench: {}\n", e.what());
    return 2;
  }
}
