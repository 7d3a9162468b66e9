// server/experiment/sweep/sweep_report.cpp: the report as Markdown and LaTeX, and all files.
#include "server/experiment/sweep/sweep_report.hpp"

#include <algorithm>
#include <fstream>
#include <stdexcept>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "server/experiment/sweep/report_sections.hpp"
#include "server/experiment/sweep/sweep_figures.hpp"
#include "server/experiment/sweep/sweep_html.hpp"
#include "server/experiment/sweep/sweep_tables.hpp"
#include "server/run/text_file.hpp"

namespace server::sweep {
namespace {

constexpr std::size_t kBlock = 1000;  // runs that are text in memory at a time

/// Writes runs_table() block by block: as one table, 100,000 runs take hundreds of megabytes.
void write_runs(const Plan& plan, const Rows& rows, const std::filesystem::path& file) {
  std::ofstream out(file, std::ios::binary);
  for (std::size_t first = 0; first < rows.size(); first += kBlock) {
    const std::size_t last = std::min(first + kBlock, rows.size());
    const std::string text = to_csv(runs_table(plan, rows, first, last));
    const std::size_t head = first == 0 ? 0 : text.find('\n') + 1;
    out << std::string_view(text).substr(head);
  }
  if (!out.flush()) throw std::runtime_error(file.string() + ": cannot be written");
}

}  // namespace

std::string incomplete_text(const Results& results) {
  if (results.complete()) return {};
  return fmt::format("INCOMPLETE: of {} runs, {} are missing and {} failed.",
                     results.runs,
                     results.missing,
                     results.failed);
}

std::string to_markdown(const Plan& plan, const Results& results) {
  std::string text;
  if (!results.complete()) text += fmt::format("**{}**\n\n", incomplete_text(results));
  text += fmt::format("# {}\n\n{}\n", plan.document().name, summary_of(plan));
  for (const Section& section : sections_of(plan, results)) {
    text += fmt::format("\n## {}\n\n", section.title);
    if (!section.text.empty()) text += section.text + "\n\n";
    text += to_markdown(section.table);
    text.pop_back();  // a table ends with a blank line, and the next heading begins with one
  }
  return text;
}

std::string to_latex(const Plan& plan, const Results& results) {
  std::string text =
      "\\documentclass{article}\n\\usepackage[T1]{fontenc}\n\\usepackage[landscape,margin=15mm]{"
      "geometry}\n"
      "\\begin{document}\n";
  if (!results.complete()) text += fmt::format("\\textbf{{{}}}\n\n", incomplete_text(results));
  text += fmt::format("\\section*{{{}}}\n{}\n",
                      experiment::latex_text(plan.document().name),
                      experiment::latex_text(summary_of(plan)));
  for (const Section& section : sections_of(plan, results)) {
    text += fmt::format("\n\\subsection*{{{}}}\n{}\n\n\\noindent\n{}",
                        section.title,
                        experiment::latex_text(section.text),
                        to_latex(section.table));
  }
  return text + "\\end{document}\n";
}

void write_report(const Plan& plan,
                  const Rows& rows,
                  const Results& results,
                  const std::filesystem::path& folder) {
  write_runs(plan, rows, folder / "runs.csv");
  replace_text(folder / "results.json", results_json(plan, results).dump(1) + "\n");
  replace_text(folder / "report.md", to_markdown(plan, results));
  replace_text(folder / "report.tex", to_latex(plan, results));
  const std::vector<Picture> pictures = pictures_of(plan, rows, results);
  replace_text(folder / "report.html", to_html(plan, rows, results, pictures));
  make_folder(folder / "pictures");
  for (const Picture& each : pictures) {
    replace_text(folder / "pictures" / each.file, each.svg);
  }
}

}  // namespace server::sweep
