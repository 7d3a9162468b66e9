// server/lab/reproduce/masuda_document.cpp: the study as tables, for the terminal, as Markdown and
// as JSON.
#include <fmt/format.h>

#include "server/experiment/table.hpp"
#include "server/lab/reproduce/marked.hpp"
#include "server/lab/reproduce/masuda_study.hpp"

namespace server::reproduce {
namespace {

using experiment::Table;
using nlohmann::json;

constexpr Marks kMasudaMarks{"<!-- masuda study: made by the program, not by hand -->\n",
                             "<!-- end of the masuda study -->\n"};

struct TableTitle {
  const char* number = "";
  const char* words = "";
};
constexpr TableTitle kTableTitles[] = {
    {"I", "Height of a step at rest [cm]; d1 0, N1 5; 1,000 trials"},
    {"II", "Upward slope at rest [degrees]; 1,000 trials"},
    {"III", "Downward slope at rest [degrees]; 1,000 trials"},
    {"IV", "Slopes while driving [degrees]; 100 drives"},
    {"V", "Steps while driving [cm]; 100 drives"},
    {"VI", "Trenches while driving [cm], as deep as wide; 100 drives; values are Eq. 13's depth"},
};

std::string figure_of(double value, int digits = 2) {
  return fmt::format("{:.{}f}", value, digits);
}

void add_spread(std::vector<std::string>& line, const std::optional<MasudaSpread>& spread) {
  if (!spread || spread->count == 0) {
    const char* const none = spread ? "-" : "NA";
    line.insert(line.end(), {none, none, none, none});
    return;
  }
  line.insert(line.end(),
              {figure_of(spread->mean),
               figure_of(spread->max),
               figure_of(spread->min),
               figure_of(spread->variance, 4)});
}

Table table_of(const MasudaStudy& study, std::string_view name) {
  Table out;
  bool driven = false;
  for (const MasudaRow& row : study.rows) driven = driven || (row.table == name && row.driven());
  out.header = {"true"};
  if (driven) {
    out.header.insert(out.header.end(), {"paper found", "found", "as printed"});
  } else {
    out.header.insert(out.header.end(), {"N1", "d1 cm"});
  }
  out.header.insert(
      out.header.end(),
      {"paper mean", "max", "min", "var", "mean", "max", "min", "var", "as printed: mean"});
  if (driven) out.header.push_back("band");
  for (const MasudaRow& row : study.rows) {
    if (row.table != name) continue;
    std::vector<std::string>& line = out.rows.emplace_back();
    line.push_back(figure_of(row.truth));
    if (driven) {
      line.push_back(fmt::format("{}", row.paper_success));
      line.push_back(fmt::format("{}", row.success));
      line.push_back(fmt::format("{}", row.literal_success));
    } else {
      line.push_back(fmt::format("{}", row.window));
      line.push_back(fmt::format("{:g}", row.d1));
    }
    add_spread(line, row.paper);
    add_spread(line, row.ours);
    line.push_back(row.literal.count > 0 ? figure_of(row.literal.mean) : "-");
    if (driven) line.push_back(row.holds() ? "holds" : "FAILS");
  }
  return out;
}

Table claims_table(const MasudaStudy& study) {
  Table out{.header = {"source", "claim", "verdict", "figures", "rule"}, .words = 5};
  for (const server::Claim& each : study.claims) {
    out.rows.push_back(
        {each.source, each.sentence, std::string(name(each.verdict)), each.found, each.rule});
  }
  return out;
}

std::string flat_sentence(const MasudaStudy& study) {
  return fmt::format("Flat floor: {} false alarms in 100 drives of 1 m.", study.flat_alarms);
}

json to_json(const MasudaSpread& spread) {
  return {{"count", spread.count},
          {"mean", spread.mean},
          {"max", spread.max},
          {"min", spread.min},
          {"variance", spread.variance}};
}

}  // namespace

std::string to_text(const MasudaStudy& study) {
  std::string out = "Masuda et al. 2008: steps, slopes and trenches by four distances\n";
  for (const TableTitle& title : kTableTitles) {
    out += fmt::format("\nTable {}. {}\n{}",
                       title.number,
                       title.words,
                       experiment::to_text(table_of(study, title.number)));
  }
  out += fmt::format("\n{}\n\n", flat_sentence(study));
  for (const server::Claim& each : study.claims) {
    out += fmt::format(
        "{} ({}): {}\n    {}\n", each.sentence, each.source, name(each.verdict), each.found);
  }
  out += all_hold(study) ? "\nEach band holds.\n" : "\nA band FAILS.\n";
  return out;
}

json to_json(const MasudaStudy& study) {
  json out = {{"all_hold", all_hold(study)},
              {"flat_alarms", study.flat_alarms},
              {"rows", json::array()},
              {"claims", json::array()}};
  for (const MasudaRow& row : study.rows) {
    json line = {{"table", row.table},
                 {"true", row.truth},
                 {"paper", row.paper ? to_json(*row.paper) : json(nullptr)},
                 {"ours", to_json(row.ours)},
                 {"as_printed", to_json(row.literal)}};
    if (row.driven()) {
      line["paper_found"] = row.paper_success;
      line["found"] = row.success;
      line["as_printed_found"] = row.literal_success;
      line["holds"] = row.holds();
    } else {
      line["d1_cm"] = row.d1;
      line["window"] = row.window;
    }
    out["rows"].push_back(std::move(line));
  }
  for (const server::Claim& each : study.claims) {
    out["claims"].push_back({{"source", each.source},
                             {"claim", each.sentence},
                             {"rule", each.rule},
                             {"figures", each.found},
                             {"verdict", name(each.verdict)}});
  }
  return out;
}

std::string to_markdown(const MasudaStudy& study, const std::string& pictures) {
  std::string out =
      "## Tables\n\nThe paper's values stand before ours. *As printed* takes the printed rules, "
      "D[N/2] of the window, and means of all trials.\n";
  for (const TableTitle& title : kTableTitles) {
    out += fmt::format("\n### Table {}\n\n{}.\n\n{}",
                       title.number,
                       title.words,
                       experiment::to_markdown(table_of(study, title.number)));
  }
  out += fmt::format("\n{}\n\n## Figures\n", flat_sentence(study));
  out += fmt::format("\n![Fig. 4: towards a step of 18 mm]({}/{})\n", pictures, kMasudaStepPicture);
  out += fmt::format(
      "\n![Fig. 5: towards a slope of -20 degrees]({}/{})\n", pictures, kMasudaSlopePicture);
  out +=
      fmt::format("\n![Fig. 10: a trench met obliquely]({}/{})\n", pictures, kMasudaTrenchPicture);
  out += fmt::format("\n## Claims\n\n{}", experiment::to_markdown(claims_table(study)));
  while (out.ends_with("\n\n")) out.pop_back();
  return out;
}

void write_markdown(const MasudaStudy& study, const std::filesystem::path& file) {
  write_study(file, kMasudaMarks, study, draw(study));
}

}  // namespace server::reproduce
