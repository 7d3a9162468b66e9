// server/lab/reproduce/filter_pictures.cpp: before and after as SVG, one small panel a filter.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "server/lab/reproduce/filter_study.hpp"

namespace server {
namespace {

constexpr double kPanelWidth = 440;
constexpr double kPanelHeight = 190;
constexpr double kLeft = 44;  // room for the numbers of an axis
constexpr double kTop = 30;
constexpr double kBottom = 22;
constexpr double kRight = 12;
constexpr std::size_t kColumns = 2;
constexpr double kHead = 34;

/// One panel: values [mm] over beams, in the panel's own corner of the picture.
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

  std::string frame(std::string_view title) const {
    std::string out = fmt::format(
        "<text x=\"{:.0f}\" y=\"{:.0f}\" class=\"title\">{}</text>\n", x(0), y_ + kTop - 10, title);
    const double step = top_mm_ > 20000 ? 20000 : top_mm_ > 9000 ? 4000 : 2000;
    for (double mm = 0; mm <= top_mm_; mm += step) {
      out += fmt::format(
          "<path class=\"grid\" d=\"M{:.1f} {:.1f}H{:.1f}\"/>"
          "<text x=\"{:.0f}\" y=\"{:.1f}\" class=\"end\">{:.0f}</text>\n",
          x(0),
          y(mm),
          x(static_cast<double>(beams_ - 1)),
          x(0) - 5,
          y(mm) + 4,
          mm / 1000);
    }
    for (std::size_t beam = 0; beam < beams_; beam += 90) {
      out += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" class=\"middle\">{}</text>\n",
                         x(static_cast<double>(beam)),
                         y(0) + 15,
                         beam);
    }
    return out;
  }

  /// A line with a gap wherever a value is not valid; `valid` empty: all are.
  std::string line(const std::vector<double>& mm,
                   const std::vector<std::uint8_t>& valid,
                   std::string_view style) const {
    std::string path;
    bool down = false;
    for (std::size_t i = 0; i < mm.size(); ++i) {
      if (!valid.empty() && valid[i] == 0) {
        down = false;
        continue;
      }
      path += fmt::format("{}{:.1f} {:.1f}", down ? "L" : "M", x(static_cast<double>(i)), y(mm[i]));
      down = true;
    }
    return fmt::format("<path class=\"{}\" d=\"{}\"/>\n", style, path);
  }

 private:
  double x_ = 0, y_ = 0;
  std::size_t beams_ = 1;
  double top_mm_ = 1;
};

std::string begin(const std::string& title, std::size_t panels) {
  const double width = kColumns * kPanelWidth;
  const double height = kHead + std::ceil(static_cast<double>(panels) / kColumns) * kPanelHeight;
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" "
      "width=\"{0:.0f}\" height=\"{1:.0f}\" role=\"img\">\n<title>{2}</title>\n"
      "<style>text{{font:12px system-ui,sans-serif;fill:#555}}"
      ".head{{font-size:15px;font-weight:600;fill:#222}}.title{{font-weight:600;fill:#222}}"
      ".end{{text-anchor:end}}.middle{{text-anchor:middle}}path{{fill:none}}"
      ".grid{{stroke:#e6e6e6}}.before{{stroke:#e3a18c;stroke-width:1}}"
      ".after{{stroke:#1a5fb4;stroke-width:1.4;stroke-linejoin:round}}</style>\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n"
      "<text x=\"{3:.0f}\" y=\"24\" class=\"head\">{2}</text>\n",
      width,
      height,
      title,
      kLeft);
}

std::string panel_title(std::string_view filter, int half_width) {
  if (filter == "before") return "before; range in metres over beams";
  return fmt::format("{}, N = {}", filter, half_width);
}

/// The axis' end: above the highest value, unless a few far ones would squash all others.
double top_of(const std::vector<double>& mm, const std::vector<std::uint8_t>& valid) {
  std::vector<double> sorted{1000};
  for (std::size_t i = 0; i < mm.size(); ++i) {
    if (valid.empty() || valid[i] != 0) sorted.push_back(mm[i]);
  }
  std::ranges::sort(sorted);
  const double most = sorted[(sorted.size() - 1) * 95 / 100];
  return std::ceil(std::min(sorted.back() * 1.03, 2 * most) / 500) * 500;
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '<') {
      out += "&lt;";
    } else if (c == '&') {
      out += "&amp;";
    } else {
      out += c;
    }
  }
  return out;
}

std::string draw_panels(const std::string& title,
                        const ScanValues& before,
                        const std::vector<ScanValues>& after,
                        int half_width) {
  const std::span<const StudyFilter> filters = study_filters_table();
  std::string out = begin(title, filters.size());
  const double top = top_of(before.mm, before.valid);
  for (std::size_t k = 0; k < filters.size(); ++k) {
    const Panel panel(k, before.mm.size(), top);
    out += panel.frame(panel_title(filters[k].name, half_width));
    if (k > 0) out += panel.line(before.mm, before.valid, "before");
    out += panel.line(after[k].mm, after[k].valid, "after");
  }
  return out + "</svg>\n";
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
                 .svg = draw_panels("The scan with the most outliers of " + escaped(example.name),
                                    example.before,
                                    example.after,
                                    example.half_width)});
  return out;
}

}  // namespace server
