// tests/algo/filter/golden_median_test.cpp: golden vectors of section B: the causal median.
#include <string>
#include <vector>

#include "tests/algo/golden.hpp"
#include <gtest/gtest.h>

#include "algo/filter/causal_median.hpp"

namespace {

using algo::MedianRank;
using golden::Json;

TEST(MedianGolden, SortVectors) {
  const Json document = golden::load("B_median.json");
  const double tolerance = golden::tolerance(document);
  ASSERT_FALSE(document.at("sort_vectors").empty());
  for (const Json& vector : document.at("sort_vectors")) {
    std::vector<double> values = golden::numbers(vector.at("in"));
    EXPECT_TRUE(golden::close(algo::descending_median(values, MedianRank::Corrected),
                              vector.at("corrected_D_ceil"),
                              tolerance));
    EXPECT_TRUE(golden::close(algo::descending_median(values, MedianRank::Literal),
                              vector.at("literal_D_N_over_2_floor"),
                              tolerance));
  }
}

/// Pushing a whole window replaces the prefill completely.
TEST(MedianGolden, SortVectorsAsStream) {
  const Json document = golden::load("B_median.json");
  for (const Json& vector : document.at("sort_vectors")) {
    const std::vector<double> values = golden::numbers(vector.at("in"));
    algo::CausalMedian corrected(values.size());
    algo::CausalMedian literal(values.size(), MedianRank::Literal);
    double last_corrected = 0;
    double last_literal = 0;
    for (const double value : values) {
      last_corrected = corrected.push(value).value();
      last_literal = literal.push(value).value();
    }
    EXPECT_TRUE(
        golden::close(last_corrected, vector.at("corrected_D_ceil"), golden::tolerance(document)));
    EXPECT_TRUE(golden::close(
        last_literal, vector.at("literal_D_N_over_2_floor"), golden::tolerance(document)));
  }
}

void expect_stream(const Json& stream, double tolerance) {
  ASSERT_EQ(stream.value("prefill", "first sample"), "first sample");
  algo::CausalMedian median(stream.at("NI").get<std::size_t>());
  ASSERT_EQ(stream.at("in").size(), stream.at("out").size());
  for (std::size_t i = 0; i < stream.at("in").size(); ++i) {
    const auto out = median.push(stream.at("in").at(i));
    ASSERT_TRUE(out.has_value());
    EXPECT_TRUE(golden::close(*out, stream.at("out").at(i), tolerance)) << "sample " << i;
  }
}

TEST(MedianGolden, CausalStream) {
  const Json document = golden::load("B_median.json");
  const Json& streams = document.at("causal_stream");
  if (streams.is_object()) return expect_stream(streams, golden::tolerance(document));
  for (const Json& stream : streams) expect_stream(stream, golden::tolerance(document));
}

}  // namespace
