// tests/server/lab/filter_study_data_test.cpp: the filter study on recordings of a real scanner.
#include <filesystem>
#include <string>
#include <vector>

#include "tests/folders.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/lab/reproduce/filter_figures.hpp"

namespace server {
namespace {

using ::testing::ElementsAre;

const std::vector<Recording>& recordings() {
  static const std::vector<Recording> read = read_recordings(tests::shared_data() / "laser");
  return read;
}

TEST(FilterStudyData, EveryScanIsReadInTheDevicesOwnStep) {
  ASSERT_EQ(recordings().size(), 3U);
  std::vector<std::size_t> scans;
  std::vector<std::size_t> beams;
  std::vector<double> steps;
  for (const Recording& each : recordings()) {
    scans.push_back(each.scans.size());
    beams.push_back(each.scans.front().mm.size());
    steps.push_back(each.step_mm);
    const FilterFigures before = judge_recording(each, study_filters_table()[0], 1);
    EXPECT_EQ(before.not_whole, 0) << each.name;
    EXPECT_EQ(before.not_in_window, 0) << each.name;
    EXPECT_EQ(before.oscillation, 1) << each.name;
    EXPECT_EQ(before.edge_blur, 0) << each.name;
  }
  EXPECT_THAT(scans, ElementsAre(2000, 910, 237));
  EXPECT_THAT(beams, ElementsAre(360, 180, 181));
  EXPECT_THAT(steps, ElementsAre(10, 10, 1));
}

/// On real scans too, the pseudomedian leaves outliers that lulu removes, keeps edges and gives
/// values that were not measured; the mean blurs.
TEST(FilterStudyData, FiltersActOnRealScansAsOnSignals) {
  const auto filters = study_filters_table();
  for (const Recording& each : recordings()) {
    for (const int N : {1, 2}) {
      const FilterFigures before = judge_recording(each, filters[0], N);
      const FilterFigures pseudomedian = judge_recording(each, filters[1], N);
      const FilterFigures median = judge_recording(each, filters[2], N);
      const FilterFigures lulu = judge_recording(each, filters[3], N);
      const FilterFigures mean = judge_recording(each, filters[4], N);
      EXPECT_LT(pseudomedian.impulses, before.impulses / 2) << each.name;
      EXPECT_GT(pseudomedian.impulses, 0) << each.name;
      EXPECT_LT(lulu.impulses, pseudomedian.impulses) << each.name;
      EXPECT_LT(*pseudomedian.edge_blur, 0.05) << each.name;
      EXPECT_GT(*mean.edge_blur, 1) << each.name;
      EXPECT_GT(pseudomedian.not_in_window, 0) << each.name;
      EXPECT_EQ(median.not_in_window, 0) << each.name;
    }
  }
}

}  // namespace
}  // namespace server
