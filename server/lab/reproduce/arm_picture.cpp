// server/lab/reproduce/arm_picture.cpp: the strips as printed and as ours, from above.
#include <fmt/format.h>

#include "server/experiment/svg_canvas.hpp"
#include "server/lab/reproduce/arm_course.hpp"
#include "server/lab/reproduce/arm_study.hpp"

namespace server::reproduce {
namespace {

constexpr double kArmWide = 900;       // [px]
constexpr double kArmPanel = 330;      // [px] height of one strip
constexpr double kPerMetre = 200;      // [px]
constexpr double kArmLeft = 50;        // [px] of x = 0
constexpr double kBasePath = 110;      // [px] of y = 0 below a panel's top
constexpr double kWristInside = 0.15;  // [m] of the pictured post

constexpr std::string_view kArmStyle =
    "text{font:13px system-ui,sans-serif;fill:#555}.head{font-size:15px;font-weight:600;fill:#222}"
    "rect{fill:#fff}.base{fill:none;stroke:#b9c2ca}.way{stroke:#b9c2ca;stroke-dasharray:4 4}"
    ".arm{fill:none;stroke:#3f88c5;stroke-width:2;stroke-opacity:.75}"
    ".hand{fill:none;stroke:#d1495b;stroke-width:2}.post{fill:#8a949e}"
    "@media(prefers-color-scheme:dark){rect{fill:#12181f}text{fill:#a5b1bc}.head{fill:#e7edf2}"
    ".base,.way{stroke:#46525e}}";

/// A strip in its own panel, whose top is at `top` [px].
void draw_strip(const std::vector<algo::BodyFrames>& strip,
                const std::string& title,
                double top,
                experiment::SvgCanvas& canvas) {
  const auto on_page = [&](const algo::Vec3& p) {
    return algo::Vec2(kArmLeft + kPerMetre * p.x(), top + kBasePath - kPerMetre * p.y());
  };
  const ArmCarried carried = carried_arm();
  canvas.text({kArmLeft, top + 20}, title, "class=\"head\"");
  canvas.line(on_page({0, 0, 0}), on_page({ArmCarried::kWay, 0, 0}), "class=\"way\"");
  canvas.circle(on_page({ArmCarried::kWay / 2, carried.hand_y + kWristInside, 0}),
                kPerMetre * kPostRadius,
                "class=\"post\"");
  std::vector<algo::Vec2> hands;
  for (const algo::BodyFrames& frames : strip) {
    const std::array<algo::Vec2, 4> arm{on_page(frames.shoulder()),
                                        on_page(frames.elbow()),
                                        on_page(frames.wrist()),
                                        on_page(frames.hand())};
    canvas.polyline(arm, "class=\"arm\"");
    hands.push_back(arm.back());
  }
  for (const algo::BodyFrames* end : {&strip.front(), &strip.back()}) {
    canvas.circle(
        on_page(end->base_W.translation()), kPerMetre * carried.body.base_radius, "class=\"base\"");
  }
  canvas.polyline(hands, "class=\"hand\"");
}

}  // namespace

std::string draw(const ArmStudy& study) {
  const std::string title = "The strip of arm and base, from above";
  experiment::SvgCanvas canvas(kArmWide, 2 * kArmPanel, kArmStyle);
  const std::array<const char*, 2> titles{
      "As printed: the configurations part, and the post passes through the arm between them",
      "Ours: the arm folds before the post and stretches behind it"};
  for (std::size_t k = 0; k < titles.size(); ++k) {
    if (study.pictured[k].empty()) continue;
    draw_strip(study.pictured[k], titles[k], kArmPanel * static_cast<double>(k), canvas);
  }
  return canvas.document(title);
}

}  // namespace server::reproduce
