// algo/full_strip/recovery.cpp: backing off, escapes.
#include "algo/full_strip/recovery.hpp"

#include <cmath>

namespace algo {
namespace {

constexpr double kBackTime = 1.0;     // [s]
constexpr double kEscapeFrom = 0.05;  // [m/s] slower counts as at rest

}  // namespace

void Recovery::reset() {
  back_until_ = -1;
  escape_.reset();
}

void Recovery::begin_backing(double now) {
  back_until_ = now + kBackTime;
}

bool Recovery::active(double now) const {
  return now < back_until_ || (escape_ && now < escape_->until);
}

std::optional<StripCommand> Recovery::next(
    const StageInput& stage, const VelocityStage& proof, double speed, double now, Weighing& out) {
  begins_escape_ = false;
  if (now < back_until_) {
    if (const auto twist = proof.back_off(stage, out)) {
      return StripCommand{*twist, strip_state::kBackingOff};
    }
  }
  if (escape_ && now < escape_->until) {
    if (proof.still_escapes(stage, escape_->twist, escape_->until - now, out)) {
      return StripCommand{escape_->twist, strip_state::kEscaping};
    }
    escape_.reset();
  }
  if (std::abs(speed) >= kEscapeFrom) return std::nullopt;
  const auto twist = proof.escape(stage, out);
  if (!twist) return std::nullopt;
  escape_ = {*twist, now + VelocityStage::kEscape};
  begins_escape_ = true;
  return StripCommand{*twist, strip_state::kEscaping};
}

}  // namespace algo
