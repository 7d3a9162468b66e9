// tests/algo/filter/golden_pseudomedian_test.cpp: golden vectors of section A: the scan filters.
#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

#include "tests/algo/golden.hpp"
#include <gtest/gtest.h>

#include "algo/filter/filter.hpp"
#include "algo/filter/filter_kernels.hpp"

namespace {

using algo::Border;
using golden::Json;

const Json& pseudomedian_document() {
  static const Json loaded = golden::load("A_pseudomedian.json");
  return loaded;
}

void expect_list(const std::vector<double>& actual, const Json& expected, const std::string& what) {
  ASSERT_EQ(actual.size(), expected.size()) << what;
  for (std::size_t i = 0; i < actual.size(); ++i) {
    EXPECT_TRUE(
        golden::close(actual[i], expected.at(i), golden::tolerance(pseudomedian_document())))
        << what << ", sample " << i;
  }
}

TEST(PseudomedianGolden, Vectors) {
  algo::FilterScratch scratch;
  ASSERT_FALSE(pseudomedian_document().at("vectors").empty());
  for (const Json& vector : pseudomedian_document().at("vectors")) {
    const std::vector<double> in = golden::numbers(vector.at("in"));
    const int N = vector.at("N");
    const bool reflect = vector.value("border", "replicate") == "reflect";
    const Border border = reflect ? Border::Reflect : Border::Replicate;
    const std::string what =
        vector.value("case", "") + " N=" + std::to_string(N) + (reflect ? " reflect" : "");
    std::vector<double> out(in.size());
    algo::pseudomedian(in, N, border, scratch, out);
    expect_list(out, vector.at("pmed"), "pseudomedian " + what);
    if (!vector.contains("median")) continue;
    algo::median(in, N, border, scratch, out);
    expect_list(out, vector.at("median"), "median " + what);
  }
}

TEST(PseudomedianGolden, InvalidAware) {
  algo::FilterScratch scratch;
  ASSERT_FALSE(pseudomedian_document().at("invalid_aware").empty());
  for (const Json& vector : pseudomedian_document().at("invalid_aware")) {
    const std::vector<double> in = golden::numbers(vector.at("in"));
    std::vector<std::uint8_t> valid;
    for (const bool each : vector.at("valid")) valid.push_back(each ? 1 : 0);
    std::vector<double> out(in.size());
    std::vector<std::uint8_t> out_valid(in.size());
    algo::pseudomedian(in, valid, vector.at("N").get<int>(), scratch, out, out_valid);
    expect_list(out, vector.at("out"), "invalid aware");
    for (std::size_t i = 0; i < in.size(); ++i) {
      EXPECT_EQ(out_valid[i] != 0, vector.at("out_valid").at(i).get<bool>()) << i;
    }
  }
}

/// The same vectors through a whole LaserScan, 1 mm of the file as 1 mm of range.
TEST(PseudomedianGolden, InvalidAwareScan) {
  algo::ScanFilter filter;
  for (const Json& vector : pseudomedian_document().at("invalid_aware")) {
    algo::LaserScan in;
    in.range_max = 1000;
    in.resize(vector.at("in").size());
    for (std::size_t i = 0; i < in.size(); ++i) {
      in.set_ok(i, vector.at("in").at(i).get<double>() * golden::kMm);
      if (!vector.at("valid").at(i).get<bool>()) in.status[i] = algo::Beam::Invalid;
    }
    algo::LaserScan out;
    filter.apply(algo::FilterKind::Pseudomedian, vector.at("N").get<int>(), in, out);
    for (std::size_t i = 0; i < in.size(); ++i) {
      const bool valid = vector.at("out_valid").at(i);
      EXPECT_EQ(out.status[i], valid ? algo::Beam::Ok : algo::Beam::Invalid) << i;
      EXPECT_TRUE(golden::close(out.ranges[i] / golden::kMm,
                                vector.at("out").at(i),
                                golden::tolerance(pseudomedian_document())))
          << i;
    }
  }
}

/// Parses "3000 everywhere, 1500 at indices 150..210"; empty for any other text.
std::vector<double> base_scan(const std::string& text) {
  std::vector<double> scan;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ',');) {
    std::istringstream words(part);
    double value = 0;
    std::string how;
    words >> value >> how;
    if (words && how == "everywhere") {
      scan.assign(360, value);
      continue;
    }
    std::string indices;
    std::size_t first = 0;
    words >> indices >> first;
    if (!words || how != "at") return {};
    std::size_t last = first;
    words.ignore(2, '\0');  // ".."
    words >> last;
    for (std::size_t i = first; i <= (words ? last : first); ++i) scan.at(i) = value;
  }
  return scan;
}

TEST(PseudomedianGolden, Scan360) {
  const Json& about = pseudomedian_document().at("scan360");
  const std::vector<double> base = base_scan(about.at("base"));
  ASSERT_EQ(base.size(), 360U) << about.at("base");
  std::vector<double> in = base;
  for (const auto& [index, value] : about.at("spikes").items()) in.at(std::stoul(index)) = value;
  algo::FilterScratch scratch;
  for (const Json& result : about.at("results")) {
    Json expected = base;
    for (const auto& [index, value] : result.at("changed").items()) {
      expected.at(std::stoul(index)) = value;
    }
    std::vector<double> out(in.size());
    algo::pseudomedian(in, result.at("N").get<int>(), Border::Replicate, scratch, out);
    expect_list(out, expected, "scan360");
  }
}

TEST(LuluGolden, Vectors) {
  algo::FilterScratch scratch;
  ASSERT_FALSE(pseudomedian_document().at("lulu").empty());
  for (const Json& vector : pseudomedian_document().at("lulu")) {
    const std::vector<double> in = golden::numbers(vector.at("in"));
    std::vector<double> out(in.size());
    algo::lulu(in, vector.at("N").get<int>(), Border::Replicate, scratch, out);
    expect_list(out, vector.at("out"), "lulu N=" + vector.at("N").dump());
  }
}

}  // namespace
