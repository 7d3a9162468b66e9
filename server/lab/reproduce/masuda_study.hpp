// server/lab/reproduce/masuda_study.hpp: reproduces Masuda et al. 2008: Tables I-VI, Fig. 4, 5 and
// 10, and the claims of the text.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "server/lab/reproduce/filter_study.hpp"
#include "server/lab/reproduce/masuda_bench.hpp"

namespace server::reproduce {

/// One line of Tables I-VI. Values in the paper's units: cm, degrees.
struct MasudaRow {
  std::string table{};  // "IV"
  MasudaGround ground{};
  double d1 = 0;           // [cm] of Tables II and III
  std::size_t window = 5;  // N1
  double truth = 0;
  std::optional<MasudaSpread> paper{};  // none where the paper has NA
  MasudaSpread ours{};
  MasudaSpread literal{};
  // Of 100 drives, in Tables IV-VI.
  std::size_t paper_success = 0, success = 0, literal_success = 0;
  std::size_t least = 0, most = 100;  // the band of success,
  double off = 0;                     // and of the values; 0: none
  bool driven() const { return table == "IV" || table == "V" || table == "VI"; }
  bool holds() const;
};

struct MasudaStudy {
  std::vector<MasudaRow> rows{};
  std::size_t flat_alarms = 0;  // in 100 drives over flat floor
  std::vector<server::Claim> claims{};
  MasudaTrace step{};                   // Fig. 4
  MasudaTrace slope{};                  // Fig. 5
  std::vector<MasudaTrace> trenches{};  // Fig. 10, at 10, 20 and 30 degrees
};

/// The same study each time, bit for bit.
MasudaStudy study_masuda();

/// The claims of the text against the tables.
std::vector<server::Claim> judge_masuda(const MasudaStudy& study);

/// True if each row lies within its band and no flat floor was an alarm.
bool all_hold(const MasudaStudy& study);

// ---- the study as a document ----
std::string to_text(const MasudaStudy& study);
nlohmann::json to_json(const MasudaStudy& study);
std::string to_markdown(const MasudaStudy& study, const std::string& pictures);
std::vector<Picture> draw(const MasudaStudy& study);
constexpr std::string_view kMasudaStepPicture = "masuda-step.svg";
constexpr std::string_view kMasudaSlopePicture = "masuda-slope.svg";
constexpr std::string_view kMasudaTrenchPicture = "masuda-trench.svg";
/// As for the filter study: the pictures beside `file`, and the section in it.
void write_markdown(const MasudaStudy& study, const std::filesystem::path& file);

}  // namespace server::reproduce
