// server/lab/reproduce/filter_study.hpp: reproduces chapter 3 of the thesis: the pseudomedian
// filter on laser scans, beside other filters, and whether the chapter's claims hold.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "server/lab/reproduce/filter_figures.hpp"
#include "server/lab/reproduce/filter_scenes.hpp"

namespace server {

struct FilterStudyOptions {
  /// Folder with CARMEN logs of a real scanner. Without it a simulated recording is used.
  std::optional<std::filesystem::path> logs{};
};

struct SceneResult {
  FilterScene scene{};
  std::vector<std::vector<double>> after_mm{};  // one scan a filter, in the table's order
  std::vector<FilterFigures> figures{};
};

struct RecordingResult {
  std::string name{};
  std::size_t scans = 0, beams = 0;
  double step_mm = 1;
  bool simulated = false;
  int half_width = 1;
  std::vector<FilterFigures> figures{};
};

/// The scan of a recording with the most single-beam outliers, for a picture.
struct Example {
  std::string name{};
  bool simulated = false;
  int half_width = 1;
  ScanValues before{};
  std::vector<ScanValues> after{};  // one a filter, in the table's order
};

/// The share of each test signal that one filter leaves: 0 nothing, 1 all of it.
struct SignalResult {
  std::string filter{};
  int half_width = 1;
  double single = 0;    // of one impulse
  double adjacent = 0;  // of two impulses side by side
  double apart = 0;     // of two impulses one sample apart: the highest value anywhere
  double step = 0;      // largest error at a step, as a share of its height
  double ramp = 0;      // largest error inside a ramp, as a share of its rise per sample
  double fastest = 0;   // amplitude of an oscillation from sample to sample
  double slower = 0;    // amplitude of one with two samples up and two down
};

/// `off`: share of 360 values wrong by more than kImpulse_mm after filtering, when the share
/// `spoiled` was salt or pepper.
struct NoiseResult {
  double spoiled = 0;  // nominal share
  std::string filter{};
  int half_width = 1;
  double off = 0;
};

/// CPU time of one pass over 360 values, as the ratio pseudomedian / median. Both are measured in
/// turn in the same process.
struct CostResult {
  int half_width = 1;
  double product = 0;   // algo's kernels
  double textbook = 0;  // Eq. 1 word for word / the usual running median
};

enum class Verdict { Reproduced, InPart, NotReproduced };
/// "reproduced", "only in part", "not reproduced"
std::string_view name(Verdict verdict);

struct Claim {
  std::string source{};
  std::string sentence{};
  std::string rule{};   // how the figures decide the verdict
  std::string found{};  // the figures
  Verdict verdict = Verdict::NotReproduced;
};

struct FilterStudy {
  SceneResult flat{};
  std::vector<SceneResult> scenes{};
  double as_printed_step = 0;  // of Eq. 1 as printed: largest error at a step, N = 1, of its height
  std::vector<SignalResult> signals{};
  std::vector<NoiseResult> noise{};
  std::vector<RecordingResult> recordings{};
  Example example{};
  std::vector<CostResult> cost{};
  std::vector<Claim> claims{};
};

/// Every result except the cost is the same on each call. Throws std::runtime_error with a sentence
/// when the logs cannot be read.
FilterStudy study_filters(const FilterStudyOptions& options);

// ---- the parts of the study ----
std::vector<SignalResult> study_signals();
std::vector<NoiseResult> study_noise();
std::vector<CostResult> study_cost();
std::vector<Claim> judge_claims(const FilterStudy& study);

// ---- the study as a document ----
std::string to_text(const FilterStudy& study);
nlohmann::json to_json(const FilterStudy& study);
/// A section of Markdown that shows pictures from the folder `pictures` (relative to its file).
std::string to_markdown(const FilterStudy& study, const std::string& pictures);

struct Picture {
  std::string file{};  // "filter-one-obstacle.svg"
  std::string svg{};
};
std::vector<Picture> draw(const FilterStudy& study);

/// Writes the pictures to pictures/reproduction beside `file`, and the section into `file`:
/// replaces the old section, or else appends it. Throws std::runtime_error with a sentence.
void write_markdown(const FilterStudy& study, const std::filesystem::path& file);

}  // namespace server
