// server/experiment/sweep/sweep_html.cpp: tables and pictures under one style sheet.
#include "server/experiment/sweep/sweep_html.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "server/experiment/svg_canvas.hpp"
#include "server/experiment/sweep/report_sections.hpp"
#include "server/experiment/sweep/sweep_report.hpp"

namespace server::sweep {
namespace {

using experiment::xml_text;

constexpr std::string_view kStyle = R"css(
:root{color-scheme:light dark;--ink:#17212b;--soft:#4d5b68;--line:#dde3e8;--ground:#f4f6f8;--card:#fff;--warn:#8f1d14}
@media(prefers-color-scheme:dark){:root{--ink:#e7edf2;--soft:#a5b1bc;--line:#2c3742;--ground:#0c1116;--card:#12181f;--warn:#ff8a7a}}
*{box-sizing:border-box}
body{margin:0 auto;padding:1rem;max-width:76rem;background:var(--ground);color:var(--ink);font:15px/1.5 system-ui,sans-serif}
h1{margin:.2rem 0;font-size:1.6rem;overflow-wrap:anywhere}
h2{margin:0 0 .5rem;font-size:1.15rem}
p{margin:.3rem 0 .8rem;max-width:50rem;color:var(--soft)}
section{margin:1rem 0;padding:1rem;border:1px solid var(--line);border-radius:8px;background:var(--card)}
.wide{overflow-x:auto}
.warn{padding:.6rem 1rem;border:2px solid var(--warn);border-radius:8px;color:var(--warn);font-weight:600}
table{border-collapse:collapse;font-size:13px;font-variant-numeric:tabular-nums}
th,td{padding:.3rem .7rem;border-bottom:1px solid var(--line);text-align:left;vertical-align:top;white-space:nowrap}
th{color:var(--soft);font-weight:600}
.n{text-align:right}
.pictures{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(30rem,100%),1fr));gap:1rem}
figure{margin:0}
figcaption{margin-bottom:.3rem;font-weight:600}
figure svg{width:100%;min-width:26rem;height:auto}
th button{all:unset;cursor:pointer;text-decoration:underline dotted}
th button:focus-visible{outline:2px solid}
)css";

/// Sorts the table of runs by the column of a pressed heading; a second press turns it round.
constexpr std::string_view kScript = R"js(
document.querySelectorAll('#runs th').forEach((th, column) => {
  const button = document.createElement('button');
  button.textContent = th.textContent;
  th.replaceChildren(button);
  let up = false;
  button.onclick = () => {
    up = !up;
    const body = document.querySelector('#runs tbody');
    const text = row => row.cells[column].textContent;
    const compare = (a, b) => text(a) === '' ? 1 : text(b) === '' ? -1 :
      (up ? 1 : -1) * text(a).localeCompare(text(b), 'en', {numeric: true});
    body.append(...[...body.rows].sort(compare));
  };
});
)js";

std::string figure_cell(const Rows& rows, std::size_t run, std::string_view column) {
  const double value = rows.figure(run, column);
  return std::isfinite(value) ? fmt::format("{:.3f}", value) : "";
}

/// The runs with their most important figures; runs.csv has all of them.
experiment::Table short_runs_table(const Plan& plan, const Rows& rows) {
  experiment::Table table{.header = {"run",
                                     "scenario",
                                     "controller",
                                     "outcome",
                                     "reason",
                                     "seed",
                                     "time [s]",
                                     "path [m]",
                                     "least clearance [m]"},
                          .words = 5};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const RunPlace at = plan.place(i);
    table.rows.push_back({fmt::format("{}", i),
                          plan.document().scenarios[at.scenario].name,
                          plan.arms()[at.arm].label,
                          rows.has(i) ? std::string(algo::name(rows.outcome(i))) : "missing",
                          rows.reason(i),
                          fmt::format("{}", plan.seed(i)),
                          figure_cell(rows, i, "time_s"),
                          figure_cell(rows, i, "path_m"),
                          figure_cell(rows, i, "min_clearance_m")});
  }
  return table;
}

std::string pictures_html(std::span<const Picture> pictures) {
  if (pictures.empty()) return {};
  std::string text = "<section><h2>Pictures</h2>\n<div class=\"pictures\">\n";
  for (const Picture& each : pictures) {
    text +=
        fmt::format("<figure><figcaption>{}</figcaption><div class=\"wide\">{}</div></figure>\n",
                    xml_text(each.title),
                    each.svg);
  }
  return text + "</div></section>\n";
}

std::string section_html(const Section& section) {
  return fmt::format("<section><h2>{}</h2>\n<p>{}</p>\n<div class=\"wide\">{}</div></section>\n",
                     xml_text(section.title),
                     xml_text(section.text),
                     to_html(section.table));
}

std::string runs_html(const Plan& plan, const Rows& rows) {
  if (rows.size() > kMostListed) {
    return fmt::format("<section><h2>Runs</h2><p>The {} runs are in runs.csv.</p></section>\n",
                       rows.size());
  }
  return fmt::format(
      "<section id=\"runs\"><h2>Runs</h2>\n<p>runs.csv has every figure of them, and the command "
      "that repeats each. Press a heading to sort.</p>\n<div "
      "class=\"wide\">{}</div></section>\n<script>{}</script>\n",
      to_html(short_runs_table(plan, rows)),
      kScript);
}

}  // namespace

std::string to_html(const Plan& plan,
                    const Rows& rows,
                    const Results& results,
                    std::span<const Picture> pictures) {
  std::string text = fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width,initial-scale=1\">\n<title>{0}: report of an "
      "experiment</title>\n<style>{1}</style></head>\n<body>\n<h1>{0}</h1>\n<p>{2}</p>\n",
      xml_text(plan.document().name),
      kStyle,
      xml_text(summary_of(plan)));
  if (!results.complete()) {
    text += fmt::format("<div class=\"warn\">{}</div>\n", incomplete_text(results));
  }
  const std::vector<Section> sections = sections_of(plan, results);
  for (const Section& section : sections) {
    text += section_html(section);
    if (&section == &sections.front()) text += pictures_html(pictures);
  }
  return text + runs_html(plan, rows) + "</body></html>\n";
}

}  // namespace server::sweep
