// server/lab/mapping/map_document.cpp: the figures as tables: on the terminal and as Markdown.
#include <numeric>

#include <fmt/format.h>

#include "algo/units.hpp"
#include "server/experiment/table.hpp"
#include "server/lab/mapping/map_study.hpp"
#include "server/lab/reproduce/marked.hpp"
#include "server/run/text_file.hpp"

namespace server::mapping {
namespace {

using experiment::Table;

using algo::units::kRadiansPerDegree;

constexpr reproduce::Marks kMarks{"<!-- maps: made by the program, not by hand -->\n",
                                  "<!-- end of the maps -->\n"};

std::string metres(double value) {
  return fmt::format("{:.3f}", value);
}
std::string share(double part, double whole) {
  return whole > 0 ? fmt::format("{:.2f}", part / whole) : "-";
}

Table run_table(const MapStudy& study) {
  Table out{.header = {"seed", "odometry: end m", "RMS m", "step of 10 m"}};
  if (study.options.match) {
    for (const char* title :
         {"matched: end m", "RMS m", "step of 10 m", "end left", "RMS left", "step left"}) {
      out.header.emplace_back(title);
    }
  }
  for (const MapRun& run : study.runs) {
    std::vector<std::string>& row = out.rows.emplace_back();
    row = {fmt::format("{}", run.seed),
           metres(run.odometry.end),
           metres(run.odometry.rms),
           metres(run.odometry.rms_10m)};
    if (!study.options.match) continue;
    row.push_back(metres(run.matched.end));
    row.push_back(metres(run.matched.rms));
    row.push_back(metres(run.matched.rms_10m));
    row.push_back(share(run.matched.end, run.odometry.end));
    row.push_back(share(run.matched.rms, run.odometry.rms));
    row.push_back(share(run.matched.rms_10m, run.odometry.rms_10m));
  }
  return out;
}

std::string head_of(const MapStudy& study) {
  const sim::DriveConfig& errors = study.options.errors;
  return fmt::format(
      "{} scans over {:.0f} m; odometry of {:.3g} % scale error, {:.3g} % yaw slip, noise {:.3g}",
      study.log.scans.size(),
      path_length(study.log.path_W),
      100 * errors.odometry_scale,
      100 * errors.odometry_slip,
      errors.odometry_noise);
}

/// Milliseconds per scan, mean over all runs.
double scan_ms(const MapStudy& study) {
  double sum = 0;
  for (const MapRun& run : study.runs) sum += run.scan_time;
  return 1e3 * sum / static_cast<double>(study.runs.size());
}

/// Compares the walls' thickness along our path and the log's, over all pieces and seeds.
std::string sharpness_sentence(const MapStudy& study) {
  if (!study.options.match) return "";
  double ours = 0;
  std::size_t thinner = 0;
  std::size_t pieces = 0;
  for (const MapRun& run : study.runs) {
    for (std::size_t i = 0; i < study.log_cells.size(); ++i) {
      ours += static_cast<double>(run.matched_cells[i]);
      if (run.matched_cells[i] < study.log_cells[i]) ++thinner;
      ++pieces;
    }
  }
  const double logs = static_cast<double>(study.runs.size()) *
                      std::accumulate(study.log_cells.begin(), study.log_cells.end(), 0.0);
  return fmt::format(
      "Drawn along the matched path, the walls of 10 m of path occupy {:.0f} % of the cells that "
      "they occupy along the log's own poses; fewer in {} of {} pieces.\n",
      100 * ours / logs,
      thinner,
      pieces);
}

std::string time_sentence(const MapStudy& study) {
  if (!study.options.match) return "";
  const MapRun& first = study.runs.front();
  return fmt::format(
      "Each scan took {:.1f} ms; {} loops were closed; the submaps and their graph take {:.1f} "
      "MB.\n",
      scan_ms(study),
      first.loops,
      1e-6 * static_cast<double>(first.map_bytes));
}

/// Adds one log to `section` and writes its pictures.
void add_log(const MapStudy& study, const std::filesystem::path& folder, std::string& section) {
  const std::string& name = study.log.name;
  section += fmt::format("### {}\n\n{}. {}{}\n{}",
                         name,
                         head_of(study),
                         time_sentence(study),
                         sharpness_sentence(study),
                         to_markdown(run_table(study)));
  const MapRun& first = study.runs.front();
  const auto picture = [&](const std::string& ending,
                           const std::vector<algo::Pose2>& path_W,
                           const std::string& title) {
    const std::string file = fmt::format("{}-{}.svg", name, ending);
    write_text(folder / file, draw_map(study.log, path_W, title));
    section += fmt::format("![{}](pictures/mapping/{})\n\n", title, file);
  };
  picture("odometry",
          first.odometry_W,
          fmt::format("{}: by the odometry of seed {}", name, first.seed));
  if (!study.options.match) return;
  picture("matched",
          first.matched_W,
          fmt::format("{}: by the matched scans, from the same odometry", name));
}

std::string relation_sentence(const MapStudy& study) {
  if (study.options.relations.empty()) return "";
  const RelationError& error = study.runs.front().relations;
  return fmt::format(
      "By {} surveyed relations, the matched path is off by {:.3f} +- {:.3f} m and {:.2f} +- "
      "{:.2f} degrees.\n",
      error.count,
      error.translation_mean,
      error.translation_sd,
      error.rotation_mean / kRadiansPerDegree,
      error.rotation_sd / kRadiansPerDegree);
}

}  // namespace

std::string to_text(const MapStudy& study) {
  return fmt::format("{}: {}\n{}{}{}{}",
                     study.log.name,
                     head_of(study),
                     to_text(run_table(study)),
                     relation_sentence(study),
                     time_sentence(study),
                     sharpness_sentence(study));
}

void write_markdown(const std::vector<MapStudy>& studies, const std::filesystem::path& file) {
  const std::filesystem::path pictures = reproduce::folder_beside(file, "pictures/mapping");
  std::string section;
  for (const MapStudy& study : studies) add_log(study, pictures, section);
  reproduce::put_marked(file, kMarks, section);
}

}  // namespace server::mapping
