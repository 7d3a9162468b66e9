// server/experiment/row_chart.cpp: values to pixels, rows of bars, boxes and cells.
#include "server/experiment/row_chart.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace server::experiment {
namespace {

constexpr double kWidth = 640;      // [px]
constexpr double kRow = 30;         // [px]
constexpr double kTop = 12;         // [px]
constexpr double kBottom = 48;      // [px] ticks and the name of the axis
constexpr double kRight = 24;       // [px]
constexpr double kLetter = 7;       // [px] of the width of a letter, on average and generously
constexpr std::size_t kLabel = 36;  // most letters of a label
constexpr double kTicks = 5;        // about so many

std::string shortened(const std::string& label) {
  return label.size() <= kLabel ? label : label.substr(0, kLabel - 3) + "...";
}

double label_width(const std::vector<std::string>& labels) {
  std::size_t longest = 0;
  for (const std::string& each : labels) longest = std::max(longest, shortened(each).size());
  return 16 + kLetter * static_cast<double>(longest);
}

/// 1, 2 or 5 times a power of ten, so that about kTicks steps make `span`.
double round_step(double span) {
  const double raw = span / kTicks;
  const double power = std::pow(10, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (raw <= factor * power * 1.0001) return factor * power;
  }
  return 10 * power;
}

}  // namespace

std::string_view chart_style() {
  return "rect{fill:#fff}text{fill:#17212b;font-size:13px}.muted{fill:#4d5b68}.grid{stroke:#dde3e8}"
         ".bar{fill:#8a5c00;fill-opacity:.75}.mark{stroke:#17212b;stroke-width:1.6}"
         ".box{fill:#8a5c00;fill-opacity:.25;stroke:#8a5c00}.cell{fill:#8a5c00}.on{fill:#fff}"
         "@media(prefers-color-scheme:dark){rect{fill:#12181f}text{fill:#e7edf2}"
         ".muted{fill:#a5b1bc}.grid{stroke:#2c3742}.bar{fill:#e0a93a}.mark{stroke:#e7edf2}"
         ".box{fill:#e0a93a;stroke:#e0a93a}.cell{fill:#e0a93a}.on{fill:#12181f}}";
}

RowChart::RowChart(const std::vector<std::string>& labels,
                   std::string_view axis,
                   const Interval& range)
    : rows_(labels.size()),
      left_(label_width(labels)),
      step_(round_step(std::max(range.high - range.low, 1e-9 + 1e-6 * std::abs(range.high)))),
      low_(std::floor(range.low / step_ + 1e-9) * step_),
      high_(std::max(std::ceil(range.high / step_ - 1e-9) * step_, low_ + step_)),
      canvas_(kWidth, kTop + kRow * static_cast<double>(rows_) + kBottom, chart_style()) {
  draw_axis(axis);
  for (std::size_t row = 0; row < rows_; ++row) {
    canvas_.text({left_ - 8, y(row) + 4}, shortened(labels[row]), "text-anchor=\"end\"");
  }
}

void RowChart::draw_axis(std::string_view axis) {
  const double bottom = kTop + kRow * static_cast<double>(rows_);
  const int digits = std::max(0, static_cast<int>(-std::floor(std::log10(step_) + 1e-9)));
  const auto steps = static_cast<int>(std::lround((high_ - low_) / step_));
  for (int k = 0; k <= steps; ++k) {
    const double value = low_ + k * step_;
    canvas_.line({x(value), kTop}, {x(value), bottom}, "class=\"grid\"");
    canvas_.text({x(value), bottom + 16},
                 fmt::format("{:.{}f}", value, digits),
                 "class=\"muted\" text-anchor=\"middle\"");
  }
  canvas_.text({(left_ + kWidth - kRight) / 2, bottom + 36}, axis, "text-anchor=\"middle\"");
}

double RowChart::x(double value) const {
  const double share = (std::clamp(value, low_, high_) - low_) / (high_ - low_);
  return left_ + share * (kWidth - kRight - left_);
}

double RowChart::y(std::size_t row) const {
  return kTop + kRow * (static_cast<double>(row) + 0.5);
}

void RowChart::rectangle(
    double left, double right, double middle, double height, std::string_view style) {
  const algo::Vec2 corners[] = {{left, middle - height / 2},
                                {right, middle - height / 2},
                                {right, middle + height / 2},
                                {left, middle + height / 2}};
  canvas_.polygon(corners, style);
}

void RowChart::bar(std::size_t row, double value, const Interval& interval) {
  rectangle(x(low_), x(value), y(row), 16, "class=\"bar\"");
  canvas_.line({x(interval.low), y(row)}, {x(interval.high), y(row)}, "class=\"mark\"");
  for (const double end : {interval.low, interval.high}) {
    canvas_.line({x(end), y(row) - 5}, {x(end), y(row) + 5}, "class=\"mark\"");
  }
}

void RowChart::box(std::size_t row, const Summary& summary) {
  canvas_.line({x(summary.least), y(row)}, {x(summary.lower_quartile), y(row)}, "class=\"mark\"");
  canvas_.line({x(summary.upper_quartile), y(row)}, {x(summary.largest), y(row)}, "class=\"mark\"");
  rectangle(x(summary.lower_quartile), x(summary.upper_quartile), y(row), 16, "class=\"box\"");
  for (const double end : {summary.least, summary.largest}) {
    canvas_.line({x(end), y(row) - 4}, {x(end), y(row) + 4}, "class=\"mark\"");
  }
  canvas_.line({x(summary.median), y(row) - 8}, {x(summary.median), y(row) + 8}, "class=\"mark\"");
}

void RowChart::words(std::size_t row, std::string_view text) {
  canvas_.text({left_ + 6, y(row) + 4}, text, "class=\"muted\"");
}

std::string heat_map(std::string_view title,
                     const std::string& row_axis,
                     const std::vector<std::string>& rows,
                     const std::string& column_axis,
                     const std::vector<std::string>& columns,
                     const std::vector<std::vector<double>>& values) {
  const double left = std::max(label_width(rows), label_width({row_axis}));
  const double width = (kWidth - kRight - left) / static_cast<double>(columns.size());
  const double top = kTop + 18;
  const double bottom = top + kRow * static_cast<double>(rows.size());
  SvgCanvas canvas(kWidth, bottom + kBottom, chart_style());
  canvas.text({left - 8, kTop + 8}, shortened(row_axis), "text-anchor=\"end\"");
  canvas.text({(left + kWidth - kRight) / 2, bottom + 36}, column_axis, "text-anchor=\"middle\"");
  for (std::size_t c = 0; c < columns.size(); ++c) {
    canvas.text({left + width * (static_cast<double>(c) + 0.5), bottom + 16},
                columns[c],
                "class=\"muted\" text-anchor=\"middle\"");
  }
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const double y = top + kRow * static_cast<double>(r);
    canvas.text({left - 8, y + 19}, rows[r], "class=\"muted\" text-anchor=\"end\"");
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const double value = values[r][c];
      if (std::isnan(value)) continue;
      const double x = left + width * static_cast<double>(c);
      const algo::Vec2 corners[] = {{x + 1, y + 1},
                                    {x + width - 1, y + 1},
                                    {x + width - 1, y + kRow - 1},
                                    {x + 1, y + kRow - 1}};
      canvas.polygon(corners, fmt::format("class=\"cell\" fill-opacity=\"{:.2f}\"", value));
      canvas.text({x + width / 2, y + 19},
                  fmt::format("{:.2f}", value),
                  value > 0.6 ? "class=\"on\" text-anchor=\"middle\"" : "text-anchor=\"middle\"");
    }
  }
  return canvas.document(title);
}

}  // namespace server::experiment
