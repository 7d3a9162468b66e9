// tests/server/lab/masuda_study_test.cpp: the tables of Masuda et al. 2008: each value in its band,
// the documents, and that a study repeats.
#include "server/lab/reproduce/masuda_study.hpp"

#include <algorithm>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "algo/units.hpp"

namespace server::reproduce {
namespace {

using algo::GroundClass;
using testing::HasSubstr;
using namespace algo::units;

/// Made once: 1,600 drives and 56,000 trials at rest.
const MasudaStudy& ground_study() {
  static const MasudaStudy made = study_masuda();
  return made;
}

TEST(MasudaStudy, EveryValueLiesInItsBand) {
  for (const MasudaRow& row : ground_study().rows) {
    EXPECT_TRUE(row.holds()) << row.table << ' ' << row.truth << ": found " << row.success << ", "
                             << row.ours.min << " to " << row.ours.max;
  }
  EXPECT_EQ(ground_study().flat_alarms, 0U);
  EXPECT_TRUE(all_hold(ground_study()));
}

TEST(MasudaStudy, HasTheLinesOfThePaper) {
  const auto lines = [](std::string_view table) {
    return std::ranges::count(ground_study().rows, table, &MasudaRow::table);
  };
  EXPECT_EQ(lines("I"), 2);
  EXPECT_EQ(lines("II"), 18);
  EXPECT_EQ(lines("III"), 9);
  EXPECT_EQ(lines("IV"), 4);
  EXPECT_EQ(lines("V"), 2);
  EXPECT_EQ(lines("VI"), 2);
  EXPECT_EQ(std::ranges::count_if(ground_study().rows,
                                  [](const MasudaRow& row) { return !row.paper.has_value(); }),
            2);  // NA
}

/// At a window of 21 and 20 degrees, light that grazes a slope down varies at least three times as
/// much as light on a slope up.
TEST(MasudaStudy, DownwardSlopesVaryMost) {
  double up = 0;
  double down = 0;
  for (const MasudaRow& row : ground_study().rows) {
    if (row.window != 21 || row.driven()) continue;
    if (row.truth == 20) up += row.ours.max - row.ours.min;
    if (row.truth == -20) down += row.ours.max - row.ours.min;
  }
  EXPECT_GT(up, 0);
  EXPECT_GE(down, 3 * up);
}

TEST(MasudaStudy, PrintedRulesFindNoStep) {
  for (const MasudaRow& row : ground_study().rows) {
    if (row.table != "V") continue;
    EXPECT_EQ(row.literal_success, 0U) << row.truth;
  }
}

TEST(MasudaStudy, BandsCanFail) {
  MasudaStudy study = ground_study();
  study.flat_alarms = 1;
  EXPECT_FALSE(all_hold(study));
  study.flat_alarms = 0;
  const auto step = std::ranges::find(study.rows, "V", &MasudaRow::table);
  step->ours.max = step->truth + 0.21;
  EXPECT_FALSE(all_hold(study));
  EXPECT_THAT(to_text(study), HasSubstr("A band FAILS."));
}

TEST(MasudaStudy, DrivesRepeat) {
  const MasudaGround step{.kind = GroundClass::StepUp, .size = 0.013};
  const MasudaDrive a = drive_over(step, {}, 5);
  const MasudaDrive b = drive_over(step, {}, 5);
  EXPECT_EQ(a.value, b.value);
  EXPECT_EQ(a.found, GroundClass::StepUp);
  EXPECT_NE(drive_over(step, {}, 6).value, a.value);
}

/// A trench met obliquely is met by one side after the other (Fig. 10).
TEST(MasudaStudy, ObliqueTrenchesAreMetOneSideAfterTheOther) {
  ASSERT_EQ(ground_study().trenches.size(), 3U);
  double last = 0;
  for (const MasudaTrace& trace : ground_study().trenches) {
    const auto first = [&trace](std::size_t sensor) {
      const auto found =
          std::ranges::find_if(trace.smooth[sensor], [](double range) { return range > 0.205; });
      return trace.way.at(static_cast<std::size_t>(found - trace.smooth[sensor].begin()));
    };
    const double apart = first(3) - first(2);  // right after left
    EXPECT_GT(apart, last + 0.02);
    last = apart;
  }
}

TEST(MasudaStudy, DocumentsNameTheFigures) {
  const std::string text = to_text(ground_study());
  EXPECT_THAT(text, HasSubstr("Table VI"));
  EXPECT_THAT(text, HasSubstr("-12.71"));
  EXPECT_THAT(text, HasSubstr("Each band holds."));
  const nlohmann::json document = to_json(ground_study());
  EXPECT_EQ(document.at("rows").size(), ground_study().rows.size());
  EXPECT_TRUE(document.at("all_hold").get<bool>());
  for (const Picture& picture : draw(ground_study())) {
    EXPECT_THAT(to_markdown(ground_study(), "pictures"), HasSubstr(picture.file));
    EXPECT_THAT(picture.svg, HasSubstr("<path"));
  }
}

}  // namespace
}  // namespace server::reproduce
