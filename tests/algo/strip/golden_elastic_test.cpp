// tests/algo/strip/golden_elastic_test.cpp: golden vectors of section D: the strip and the via
// buffer.
#include <vector>

#include "tests/algo/golden.hpp"
#include <gtest/gtest.h>

#include "algo/strip/strip.hpp"
#include "algo/strip/via_buffer.hpp"

namespace {

using algo::IsSortRule;
using golden::Json;

const Json& elastic_document() {
  static const Json loaded = golden::load("D_elastic.json");
  return loaded;
}
double elastic_tolerance() {
  return golden::tolerance(elastic_document());
}

TEST(ElasticGolden, GetPosi) {
  ASSERT_FALSE(elastic_document().at("get_posi").empty());
  for (const Json& vector : elastic_document().at("get_posi")) {
    const algo::Pose2 out = algo::get_posi(golden::point_mm(vector.at("from")),
                                           golden::point_mm(vector.at("to")),
                                           vector.at("v").get<double>() * golden::kMm,
                                           vector.at("T"));
    EXPECT_TRUE(golden::close_mm(out.position(), vector.at("out"), elastic_tolerance()));
    EXPECT_TRUE(golden::close_angle(out.heading, vector.at("out").at(2), elastic_tolerance()));
  }
}

TEST(ElasticGolden, Internal) {
  ASSERT_FALSE(elastic_document().at("internal").empty());
  for (const Json& vector : elastic_document().at("internal")) {
    const algo::Vec2 force = algo::internal_force(golden::point_mm(vector.at("P0")),
                                                  golden::point_mm(vector.at("P1")),
                                                  golden::point_mm(vector.at("P2")),
                                                  vector.at("Kc"));
    EXPECT_TRUE(golden::close_mm(force, vector.at("F"), elastic_tolerance()));
  }
}

TEST(ElasticGolden, External) {
  ASSERT_FALSE(elastic_document().at("external").empty());
  for (const Json& vector : elastic_document().at("external")) {
    const double reach = vector.at("d_o").get<double>() * golden::kMm;
    const double k_r = vector.at("Kr");
    const algo::Vec2 p = golden::point_mm(vector.at("P"));
    const algo::Vec2 obstacle = golden::point_mm(vector.at("P_obs"));
    const algo::ForceSettings settings{algo::ForceLaw::Original, reach, k_r, 0.0};
    EXPECT_TRUE(golden::close_mm(
        algo::external_force(settings, p, obstacle), vector.at("F"), elastic_tolerance()));
    const double potential = algo::potential((p - obstacle).norm(), reach, k_r);
    EXPECT_TRUE(golden::close(
        potential / (golden::kMm * golden::kMm), vector.at("V"), elastic_tolerance()));
  }
}

TEST(ElasticGolden, Update) {
  ASSERT_FALSE(elastic_document().at("update").empty());
  for (const Json& vector : elastic_document().at("update")) {
    const algo::StripUpdate update = algo::update_strip(golden::pose_mm(vector.at("cur")),
                                                        golden::point_mm(vector.at("next")),
                                                        golden::point_mm(vector.at("F")));
    EXPECT_TRUE(golden::close_mm(update.delta_W, vector.at("delta"), elastic_tolerance()));
    EXPECT_TRUE(
        golden::close_mm(update.updated.position(), vector.at("updated"), elastic_tolerance()));
    EXPECT_TRUE(golden::close_angle(
        update.updated.heading, vector.at("updated").at(2), elastic_tolerance()));
    EXPECT_TRUE(golden::close_angle(update.turn, vector.at("dtheta"), elastic_tolerance()));
  }
}

TEST(ElasticGolden, IsSort) {
  ASSERT_FALSE(elastic_document().at("is_sort").empty());
  for (const Json& vector : elastic_document().at("is_sort")) {
    const algo::Vec2 offset = golden::point_mm({vector.at("dx"), vector.at("dy")});
    for (const algo::Vec2& from : {algo::Vec2{0, 0}, algo::Vec2{1.3, -2.7}}) {
      EXPECT_EQ(algo::is_sort(from + offset, from, IsSortRule::Literal),
                vector.at("literal").get<bool>())
          << vector.dump();
      EXPECT_EQ(algo::is_sort(from + offset, from, IsSortRule::Corrected),
                vector.at("corrected").get<bool>())
          << vector.dump();
    }
  }
}

void expect_points(const algo::ViaBuffer& buffer, const Json& out) {
  ASSERT_EQ(buffer.last(), out.at("last").get<std::size_t>());
  EXPECT_EQ(buffer.cursor(), out.at("cur").get<std::size_t>());
  for (std::size_t i = 0; i < out.at("points").size(); ++i) {
    EXPECT_TRUE(golden::close_mm(
        buffer.get_position(i).value().position_W, out.at("points").at(i), elastic_tolerance()))
        << "point " << i;
  }
}

TEST(ElasticGolden, SortPosition) {
  ASSERT_FALSE(elastic_document().at("sort_position").empty());
  for (const Json& vector : elastic_document().at("sort_position")) {
    std::vector<algo::Via> points;
    for (std::size_t i = 0; i < vector.at("last").get<std::size_t>(); ++i) {
      points.push_back({golden::point_mm(vector.at("points").at(i)), false});
    }
    points.back().is_goal = true;
    algo::ViaBuffer buffer;
    buffer.assign(points, vector.at("cur").get<std::size_t>());
    const bool accepted = buffer.sort_position(golden::point_mm(vector.at("via")),
                                               golden::point_mm(vector.at("goal")));
    EXPECT_EQ(accepted, vector.at("out").at("accepted").get<bool>());
    expect_points(buffer, vector.at("out"));
  }
}

}  // namespace
