// server/lab/reproduce/filter_pictures.cpp: scans before and after filtering as SVG, one small
// panel per filter.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "server/experiment/svg_canvas.hpp"
#include "server/lab/reproduce/filter_study.hpp"

namespace server {
namespace {

using experiment::SvgCanvas;

constexpr double kPanelWidth = 440;
constexpr double kPanelHeight = 190;
constexpr double kLeft = 44;  // [px] for the numbers of an axis
constexpr double kTop = 30;
constexpr double kBottom = 22;
constexpr double kRight = 12;
constexpr std::size_t kColumns = 2;
constexpr double kHead = 34;

/// One panel: values [mm] over beams, at the panel's own place in the picture.
class Panel {
 public:
  Panel(std::size_t place, std::size_t beams, double top_mm)
      : x_(static_cast<double>(place % kColumns) * kPanelWidth),
        y_(kHead + std::floor(static_cast<double>(place) / kColumns) * kPanelHeight),
        beams_(beams),
        top_mm_(top_mm) {}

  double x(double beam) const {
    return x_ + kLeft + beam / static_cast<double>(beams_ - 1) * (kPanelWidth - kLeft - kRight);
  }
  double y(double mm) const {
    const double part = std::clamp(mm / top_mm_, 0.0, 1.0);
    return y_ + kPanelHeight - kBottom - part * (kPanelHeight - kTop - kBottom);
  }

  void frame(std::string_view title, SvgCanvas& canvas) const {
    canvas.text({x(0), y_ + kTop - 10}, title, "class=\"title\"");
    const double step = top_mm_ > 20000 ? 20000 : top_mm_ > 9000 ? 4000 : 2000;
    for (double mm = 0; mm <= top_mm_; mm += step) {
      canvas.line({x(0), y(mm)}, {x(static_cast<double>(beams_ - 1)), y(mm)}, "class=\"grid\"");
      canvas.text({x(0) - 5, y(mm) + 4}, fmt::format("{:.0f}", mm / 1000), "class=\"end\"");
    }
    for (std::size_t beam = 0; beam < beams_; beam += 90) {
      canvas.text(
          {x(static_cast<double>(beam)), y(0) + 15}, fmt::format("{}", beam), "class=\"middle\"");
    }
  }

  /// Draws a line with a gap at each invalid value; if `valid` is empty, all are valid.
  void line(const ScanValues& scan, std::string_view attributes, SvgCanvas& canvas) const {
    std::string steps;
    bool down = false;
    for (std::size_t i = 0; i < scan.mm.size(); ++i) {
      if (!scan.valid.empty() && scan.valid[i] == 0) {
        down = false;
        continue;
      }
      steps += fmt::format(
          "{}{:.1f} {:.1f}", down ? "L" : "M", x(static_cast<double>(i)), y(scan.mm[i]));
      down = true;
    }
    canvas.path(steps, attributes);
  }

 private:
  double x_ = 0, y_ = 0;
  std::size_t beams_ = 1;
  double top_mm_ = 1;
};

constexpr std::string_view kStyles =
    "text{font:12px system-ui,sans-serif;fill:#555}"
    ".head{font-size:15px;font-weight:600;fill:#222}.title{font-weight:600;fill:#222}"
    ".end{text-anchor:end}.middle{text-anchor:middle}path{fill:none}"
    ".grid{stroke:#e6e6e6}.before{stroke:#e3a18c;stroke-width:1}"
    ".after{stroke:#1a5fb4;stroke-width:1.4;stroke-linejoin:round}";

std::string panel_title(std::string_view filter, int half_width) {
  if (filter == "before") return "before; range in metres over beams";
  return fmt::format("{}, N = {}", filter, half_width);
}

/// The axis' end: above the highest value, unless a few outliers would squash all other values.
double top_of(const ScanValues& scan) {
  std::vector<double> sorted{1000};
  for (std::size_t i = 0; i < scan.mm.size(); ++i) {
    if (scan.valid.empty() || scan.valid[i] != 0) sorted.push_back(scan.mm[i]);
  }
  std::ranges::sort(sorted);
  const double most = sorted[(sorted.size() - 1) * 95 / 100];
  return std::ceil(std::min(sorted.back() * 1.03, 2 * most) / 500) * 500;
}

std::string draw_panels(const std::string& title,
                        const ScanValues& before,
                        const std::vector<ScanValues>& after,
                        int half_width) {
  const std::span<const StudyFilter> filters = study_filters_table();
  const double rows = std::ceil(static_cast<double>(filters.size()) / kColumns);
  SvgCanvas canvas(kColumns * kPanelWidth, kHead + rows * kPanelHeight, kStyles);
  canvas.text({kLeft, 24}, title, "class=\"head\"");
  const double top = top_of(before);
  for (std::size_t k = 0; k < filters.size(); ++k) {
    const Panel panel(k, before.mm.size(), top);
    panel.frame(panel_title(filters[k].name, half_width), canvas);
    if (k > 0) panel.line(before, "class=\"before\"", canvas);
    panel.line(after[k], "class=\"after\"", canvas);
  }
  return canvas.document(title);
}

}  // namespace

std::vector<Picture> draw(const FilterStudy& study) {
  std::vector<Picture> out;
  for (const SceneResult& each : study.scenes) {
    std::vector<ScanValues> after;
    after.reserve(each.after_mm.size());
    for (const std::vector<double>& mm : each.after_mm) after.push_back({.mm = mm, .valid = {}});
    out.push_back({.file = "filter-" + each.scene.name + ".svg",
                   .svg = draw_panels(each.scene.title,
                                      {.mm = each.scene.before_mm, .valid = {}},
                                      after,
                                      each.scene.half_width)});
  }
  const Example& example = study.example;
  out.push_back({.file = "filter-recording.svg",
                 .svg = draw_panels("The scan with the most outliers of " + example.name,
                                    example.before,
                                    example.after,
                                    example.half_width)});
  return out;
}

}  // namespace server
