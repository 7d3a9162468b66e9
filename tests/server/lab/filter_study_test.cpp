// tests/server/lab/filter_study_test.cpp: the filter study: its references, its figures and its
// verdicts.
#include "server/lab/reproduce/filter_study.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "tests/folders.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/random.hpp"

namespace server {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Samples = std::vector<double>;
namespace fs = std::filesystem;

/// The study without recordings, made once: only the cost differs between repetitions.
const FilterStudy& study() {
  static const FilterStudy made = study_filters({});
  return made;
}

const StudyFilter& filter(std::string_view name) {
  return *std::ranges::find(study_filters_table(), name, &StudyFilter::name);
}

std::string text_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

// ---- The references ----

TEST(FilterReferences, MeanAndMidrangeByHand) {
  const Samples in = {1, 2, 9, 2, 1};
  EXPECT_THAT(filtered(filter("mean"), in, 1),
              ElementsAre(4.0 / 3, 4, 13.0 / 3, 4, 4.0 / 3));  // (1 + 1 + 2) / 3 at the border
  EXPECT_THAT(filtered(filter("midrange"), in, 1), ElementsAre(1.5, 5, 5.5, 5, 1.5));
  EXPECT_EQ(filtered(filter("before"), in, 1), in);
}

TEST(FilterReferences, AnInvalidSampleNeverEntersTheMean) {
  const Samples in = {1, 2, 8190, 4, 5};
  const std::vector<std::uint8_t> valid = {1, 1, 0, 1, 1};
  algo::FilterScratch scratch;
  Samples out(5);
  std::vector<std::uint8_t> out_valid(5);
  filter("mean").apply(in, valid, 1, scratch, out, out_valid);
  EXPECT_THAT(out, ElementsAre(4.0 / 3, 1.5, 8190, 4.5, 14.0 / 3));
  EXPECT_THAT(out_valid, ElementsAre(1, 1, 0, 1, 1));
}

/// The baseline of the cost must be the same filter.
TEST(FilterReferences, TextbookFormsEqualTheProduct) {
  sim::Random random(1);
  Samples in(200);
  for (double& value : in) value = std::floor(random.uniform(0, 30));
  Samples out(in.size());
  for (const int N : {1, 2, 5, 10}) {
    pseudomedian_by_definition(in, N, out);
    EXPECT_EQ(out, filtered(filter("pseudomedian"), in, N)) << N;
    running_median(in, N, out);
    EXPECT_EQ(out, filtered(filter("median"), in, N)) << N;
  }
}

TEST(FilterReferences, EquationOneAsPrintedIsAnotherFilter) {
  // N = 1: the only group is [1..2], so the result is the mean of a sample and its predecessor.
  EXPECT_THAT(pseudomedian_as_printed(Samples{0, 0, 1, 1, 5}, 1), ElementsAre(0, 0, 0.5, 1, 3));
}

// ---- The figures ----

TEST(FilterFigures, ASpikeAndAnEdgeByHand) {
  FilterScene scene{.name = "", .title = "", .half_width = 1, .spikes = {{5, 3000}}};
  scene.truth_mm.assign(40, 1000);
  std::fill(scene.truth_mm.begin() + 20, scene.truth_mm.end(), 2000);
  scene.before_mm = scene.truth_mm;
  scene.before_mm[5] = 3000;

  Samples after = scene.before_mm;
  after[5] = 2000;     // half of the spike
  after[20] = 1000;    // the edge one beam later
  after[30] = 2000.5;  // not a measured value
  const FilterFigures figures = judge_scene(scene, "some", after, 1);
  EXPECT_EQ(figures.impulses, 1);
  EXPECT_EQ(figures.height_left, 0.5);
  EXPECT_EQ(figures.edge_shift, 1);
  EXPECT_EQ(figures.edge_blur, 1);                    // beam 20 alone
  EXPECT_DOUBLE_EQ(figures.not_in_window, 2.0 / 40);  // beams 5 and 30
  EXPECT_DOUBLE_EQ(figures.not_whole, 1.0 / 40);
  EXPECT_NEAR(*figures.rms_mm, std::sqrt((2e6 + 0.25) / 40), 1e-9);
}

TEST(FilterFigures, ALostEdgeCountsAsFarAway) {
  FilterScene scene{.name = "", .title = "", .half_width = 1};
  scene.truth_mm.assign(40, 1000);
  std::fill(scene.truth_mm.begin() + 20, scene.truth_mm.end(), 2000);
  scene.before_mm = scene.truth_mm;
  const FilterFigures figures = judge_scene(scene, "gone", Samples(40, 1000), 1);
  EXPECT_EQ(figures.edge_shift, 3);  // the reach of the search, 2N + 1
  EXPECT_FALSE(figures.height_left.has_value());
}

TEST(FilterFigures, OutliersNeedAgreeingNeighbours) {
  const auto count = [](Samples mm, std::vector<std::uint8_t> valid) {
    return outliers({.mm = std::move(mm), .valid = std::move(valid)});
  };
  EXPECT_EQ(count({1000, 1301, 1000}, {1, 1, 1}), 1U);
  EXPECT_EQ(count({1000, 699, 1000}, {1, 1, 1}), 1U);
  EXPECT_EQ(count({1000, 1300, 1000}, {1, 1, 1}), 0U);
  EXPECT_EQ(count({1000, 2000, 1151}, {1, 1, 1}), 0U);  // an edge, not an outlier
  EXPECT_EQ(count({1000, 2000, 1000}, {1, 1, 0}), 0U);
  EXPECT_EQ(count({1000}, {1}), 0U);
}

// ---- The scenes ----

TEST(FilterScenes, AreThoseOfTheThesis) {
  const std::vector<FilterScene> scenes = chapter_3_scenes();
  ASSERT_EQ(scenes.size(), 3U);
  const auto beams = [](const FilterScene& scene) {
    std::vector<std::size_t> out;
    for (const Spike& spike : scene.spikes) out.push_back(spike.beam);
    return out;
  };
  EXPECT_THAT(beams(scenes[0]), ElementsAre(186, 264, 266, 272, 292));
  EXPECT_THAT(beams(scenes[1]), ElementsAre());
  EXPECT_THAT(beams(scenes[2]), ElementsAre(220));
  EXPECT_EQ(scenes[0].half_width, 1);
  EXPECT_EQ(scenes[1].half_width, 2);
  EXPECT_EQ(scenes[2].half_width, 2);
  for (const FilterScene& scene : scenes) {
    ASSERT_EQ(scene.before_mm.size(), 360U);
    ASSERT_EQ(scene.truth_mm.size(), 360U);
    for (std::size_t i = 0; i < 360; ++i) {
      EXPECT_EQ(scene.before_mm[i], std::nearbyint(scene.before_mm[i])) << "whole millimetres";
    }
    // One edge on either side of each obstacle.
    const FilterFigures before = judge_scene(scene, "before", scene.before_mm, scene.half_width);
    EXPECT_EQ(before.impulses, static_cast<double>(scene.spikes.size())) << scene.title;
    EXPECT_EQ(before.edge_blur, 0) << scene.title;
  }
}

/// The notes' prototype, to the digit: tests/golden/A_pseudomedian.json, scan360.
TEST(FilterScenes, FlatLayoutGivesThePrototypesValues) {
  std::ifstream stream(tests::folder() / "golden/A_pseudomedian.json");
  const json about = json::parse(stream).at("scan360");
  const FilterScene flat = flat_scene();
  ASSERT_EQ(flat.spikes.size(), about.at("spikes").size());
  for (const Spike& spike : flat.spikes) {
    EXPECT_EQ(about.at("spikes").at(std::to_string(spike.beam)), spike.mm);
  }
  for (const json& result : about.at("results")) {
    Samples expected = flat.truth_mm;
    for (const auto& [beam, mm] : result.at("changed").items()) {
      expected.at(std::stoul(beam)) = mm.get<double>();
    }
    EXPECT_EQ(filtered(filter("pseudomedian"), flat.before_mm, result.at("N")), expected);
  }
}

// ---- The study ----

/// equations.md A, the table "what it really does".
TEST(FilterStudy, TestSignalsAsDerived) {
  const auto row = [](std::string_view name, int N) {
    return *std::ranges::find_if(study().signals, [&](const SignalResult& each) {
      return each.filter == name && each.half_width == N;
    });
  };
  for (const int N : {1, 2}) {
    EXPECT_EQ(row("pseudomedian", N).single, 0.5);
    EXPECT_EQ(row("pseudomedian", N).apart, 0.5);
    EXPECT_EQ(row("pseudomedian", N).fastest, 0);
    EXPECT_EQ(row("median", N).single, 0);
    EXPECT_EQ(row("median", N).fastest, 1);
    EXPECT_EQ(row("lulu", N).single, 0);
    for (const std::string_view name : {"pseudomedian", "median", "lulu"}) {
      EXPECT_EQ(row(name, N).step, 0) << name;
      EXPECT_EQ(row(name, N).ramp, 0) << name;
    }
  }
  EXPECT_EQ(row("pseudomedian", 1).adjacent, 1);
  EXPECT_EQ(row("pseudomedian", 2).adjacent, 0.5);
  EXPECT_EQ(row("median", 2).adjacent, 0);
}

TEST(FilterStudy, VerdictsFollowTheFigures) {
  std::map<std::string, std::string> verdicts;
  for (const Claim& each : study().claims) {
    verdicts[each.sentence.substr(0, 40)] = name(each.verdict);
    EXPECT_FALSE(each.found.empty()) << each.sentence;
    EXPECT_FALSE(each.rule.empty()) << each.sentence;
  }
  EXPECT_EQ(study().claims.size(), 9U);
  const auto of = [&](const std::string& sentence) { return verdicts.at(sentence.substr(0, 40)); };
  EXPECT_EQ(of("Equation 1 as printed (groups [i..N+1], i"), "not reproduced");
  EXPECT_EQ(of("The pseudomedian filter does not completely"), "reproduced");
  EXPECT_EQ(of("The pseudomedian filter preserves edges."), "reproduced");
  EXPECT_EQ(of("Mean and midrange neither preserve edges nor"), "reproduced");
  EXPECT_EQ(of("The pseudomedian filter blocks a fast oscillation"), "reproduced");
  EXPECT_EQ(of("The result need not be one of the window's"), "reproduced");
  // The cost has no expected verdict: it is measured.
}

/// The figures decide the verdicts: in a study with a filter that does nothing, the claims fail.
TEST(FilterStudy, VerdictsTurnWhenTheFiguresDo) {
  FilterStudy changed = study();
  for (SignalResult& each : changed.signals) {
    if (each.filter == "pseudomedian") each.single = each.fastest = each.step = 0;
    if (each.filter == "pseudomedian" && each.half_width == 1) each.fastest = 1;
  }
  for (SceneResult& each : changed.scenes) {
    each.figures[1].impulses = 0;
    each.figures[1].edge_blur = 3;
  }
  for (CostResult& each : changed.cost) each.product = each.textbook = 0.5;
  const std::vector<Claim> claims = judge_claims(changed);
  EXPECT_EQ(claims.at(1).verdict, Verdict::NotReproduced);  // impulses stay
  EXPECT_EQ(claims.at(2).verdict, Verdict::Reproduced);     // noises removed
  EXPECT_EQ(claims.at(4).verdict, Verdict::InPart);         // edges
  EXPECT_EQ(claims.at(6).verdict, Verdict::NotReproduced);  // oscillation
  EXPECT_EQ(claims.at(8).verdict, Verdict::Reproduced);     // cost
  for (CostResult& each : changed.cost) each.product = each.textbook = 1.5;
  EXPECT_EQ(judge_claims(changed).at(8).verdict, Verdict::NotReproduced);
}

TEST(FilterStudy, RepeatsExactlyExceptForTheCost) {
  json first = to_json(study());
  FilterStudy again = study_filters({});
  again.cost = study().cost;
  again.claims = judge_claims(again);
  EXPECT_EQ(first, to_json(again));
}

TEST(FilterStudy, ReportsMissingRecordings) {
  EXPECT_TRUE(study().example.simulated);
  EXPECT_THAT(to_text(study()), HasSubstr("No folder of recordings was given"));
  EXPECT_THAT(to_markdown(study(), "pictures"), HasSubstr("No folder of recordings was given"));
  const json document = to_json(study());
  for (const json& each : document.at("recordings")) EXPECT_EQ(each.at("simulated"), true);
}

/// A temporary folder for one test.
class FilterStudyFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path folder_ =
      fs::temp_directory_path() / (std::string("tautline_filter_study_") +
                                   ::testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(FilterStudyFiles, SectionIsReplacedInPlaceAndItsPicturesExist) {
  const fs::path file = folder_ / "reproduction.md";
  std::ofstream(file) << "# Kept\n";
  write_markdown(study(), file);
  const std::string once = text_of(file);
  EXPECT_THAT(once, ::testing::StartsWith("# Kept\n\n<!-- filter study"));
  std::ofstream(file, std::ios::app) << "\nAlso kept\n";
  write_markdown(study(), file);
  EXPECT_EQ(text_of(file), once + "\nAlso kept\n");
  for (const Picture& picture : draw(study())) {
    const std::string path = "pictures/reproduction/" + picture.file;
    EXPECT_THAT(once, HasSubstr("(" + path + ")"));
    EXPECT_THAT(text_of(folder_ / path), ::testing::EndsWith("</svg>\n"));
    EXPECT_EQ(picture.svg.find("nan"), std::string::npos);
  }
}

TEST_F(FilterStudyFiles, AFolderInPlaceOfAFileIsRefusedBeforeAnythingIsWritten) {
  const fs::path taken = folder_ / "page.md";
  fs::create_directories(taken);
  EXPECT_THROW(write_markdown(study(), taken), std::runtime_error);
  EXPECT_FALSE(fs::exists(folder_ / "pictures"));
}

TEST_F(FilterStudyFiles, BadFoldersAreRefusedWithASentence) {
  const auto sentence = [](const fs::path& folder) -> std::string {
    try {
      read_recordings(folder);
    } catch (const std::runtime_error& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_THAT(sentence(folder_ / "none"), HasSubstr("cannot be read"));
  EXPECT_THAT(sentence(folder_), HasSubstr("holds no *.log"));
  std::ofstream(folder_ / "empty.log") << "# nothing\n";
  EXPECT_THAT(sentence(folder_), HasSubstr("holds no scan"));
}

TEST_F(FilterStudyFiles, ReadsARecordingAndLeavesItsCodesOut) {
  std::ofstream(folder_ / "small.log")
      << "FLASER 5 1.00 1.00 9.00 1.00 81.91 0 0 0 0 0 0 1.0 host 1.0\n"
         "FLASER 5 2.00 2.00 2.00 2.00 2.00 0 0 0 0 0 0 1.2 host 1.2\n";
  const std::vector<Recording> recordings = read_recordings(folder_);
  ASSERT_EQ(recordings.size(), 1U);
  EXPECT_EQ(recordings[0].name, "small");
  EXPECT_EQ(recordings[0].step_mm, 10);
  ASSERT_EQ(recordings[0].scans.size(), 2U);
  EXPECT_THAT(recordings[0].scans[0].valid, ElementsAre(1, 1, 1, 1, 0));
  EXPECT_EQ(recordings[0].scans[0].mm[2], 9000);
  EXPECT_EQ(judge_recording(recordings[0], filter("before"), 1).impulses, 0.5);
  EXPECT_EQ(judge_recording(recordings[0], filter("median"), 1).impulses, 0);
}

}  // namespace
}  // namespace server
