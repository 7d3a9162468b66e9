// algo/terrain/ground_verdict.cpp: compares findings with limits, and names them.
#include "algo/terrain/ground_verdict.hpp"

#include <cmath>

#include "algo/explain.hpp"
#include "algo/units.hpp"

namespace algo {
namespace {

double weight(const GroundFinding& finding) {
  switch (finding.kind) {
    case GroundClass::Flat:
    case GroundClass::Pending:
      return -1;
    case GroundClass::Unknown:
      return std::numeric_limits<double>::infinity();
    case GroundClass::Trench:
      return finding.width;
    case GroundClass::StepUp:
    case GroundClass::StepDown:
      return std::abs(finding.height);
    default:
      return std::abs(finding.slope);
  }
}

}  // namespace

bool passable(const GroundFinding& finding,
              const ClimbLimits& limits,
              double pitch,
              const Parameters& p) {
  // Comparisons are written so that NaN is not passable.
  switch (finding.kind) {
    case GroundClass::Flat:
    case GroundClass::Pending:
      return true;
    case GroundClass::StepUp:
      return finding.height <= limits.step_up - p[kStepMargin];
    case GroundClass::StepDown:
      return -finding.height <= limits.step_down - p[kStepMargin];
    case GroundClass::Trench:
      return finding.width <= p[kTrenchRatio] * limits.trench;
    case GroundClass::SlopeUp:
    case GroundClass::SlopeDown: {
      const double slope = finding.slope - pitch;
      return slope <= limits.slope_up - p[kUphillMargin] &&
             -slope <= limits.slope_down - p[kDownhillMargin];
    }
    case GroundClass::Unknown:
      return false;
  }
  return false;
}

const GroundFinding& worse(const GroundFinding& a, const GroundFinding& b) {
  return weight(b) > weight(a) ? b : a;
}

void say_ground(const GroundFinding& finding, std::string& text) {
  constexpr double kCm = 100;
  const double degrees = std::abs(finding.slope) / units::kRadiansPerDegree;
  switch (finding.kind) {
    case GroundClass::Flat:
      text += "flat";
      return;
    case GroundClass::Pending:
      text += "something farther ahead";
      return;
    case GroundClass::StepUp:
      return say(text, "step up %.1f cm", kCm * finding.height);
    case GroundClass::StepDown:
      return say(text, "step down %.1f cm", -kCm * finding.height);
    case GroundClass::Trench:
      if (!std::isfinite(finding.width)) return say(text, "wide trench");
      return say(text, "trench %.1f cm", kCm * finding.width);
    case GroundClass::SlopeUp:
      return say(text, "slope up %.0f degrees", degrees);
    case GroundClass::SlopeDown:
      return say(text, "slope down %.0f degrees", degrees);
    case GroundClass::Unknown:
      text += "unknown ground";
      return;
  }
}

}  // namespace algo
