// server/experiment/svg_canvas.cpp: shapes to text.
#include "server/experiment/svg_canvas.hpp"

#include <fmt/format.h>

namespace server::experiment {
namespace {

std::string listed(std::span<const algo::Vec2> points) {
  std::string out;
  for (const algo::Vec2& p : points) {
    out += fmt::format("{}{:.1f},{:.1f}", out.empty() ? "" : " ", p.x(), p.y());
  }
  return out;
}

}  // namespace

std::string xml_text(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '&':
        out += "&amp;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

void SvgCanvas::circle(const algo::Vec2& centre, double radius, std::string_view attributes) {
  body_ += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" {}/>\n",
                       centre.x(),
                       centre.y(),
                       radius,
                       attributes);
}

void SvgCanvas::line(const algo::Vec2& from, const algo::Vec2& to, std::string_view attributes) {
  body_ += fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>\n",
                       from.x(),
                       from.y(),
                       to.x(),
                       to.y(),
                       attributes);
}

void SvgCanvas::polygon(std::span<const algo::Vec2> points, std::string_view attributes) {
  body_ += fmt::format("<polygon points=\"{}\" {}/>\n", listed(points), attributes);
}

void SvgCanvas::polyline(std::span<const algo::Vec2> points, std::string_view attributes) {
  body_ += fmt::format("<polyline points=\"{}\" fill=\"none\" {}/>\n", listed(points), attributes);
}

void SvgCanvas::path(std::string_view steps, std::string_view attributes) {
  body_ += fmt::format("<path {} d=\"{}\"/>\n", attributes, steps);
}

void SvgCanvas::text(const algo::Vec2& at, std::string_view words, std::string_view attributes) {
  body_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\"{}{}>{}</text>\n",
                       at.x(),
                       at.y(),
                       attributes.empty() ? "" : " ",
                       attributes,
                       xml_text(words));
}

std::string SvgCanvas::document(std::string_view title) const {
  const std::string style =
      style_sheet_.empty() ? "" : fmt::format("<style>{}</style>\n", style_sheet_);
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" "
      "height=\"{1:.0f}\" role=\"img\" font-family=\"sans-serif\" font-size=\"12\">\n"
      "<title>{2}</title>\n{3}"
      "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n{4}</svg>\n",
      width_,
      height_,
      xml_text(title),
      style,
      body_);
}

}  // namespace server::experiment
