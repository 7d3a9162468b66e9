// algo/strip/elastic_strip_controller.cpp: one tick of the strip.
#include "algo/strip/elastic_strip_controller.hpp"

#include <initializer_list>
#include <string_view>

#include "algo/common_layers.hpp"
#include "algo/driving.hpp"
#include "algo/explain.hpp"
#include "algo/strip/strip_law.hpp"

namespace algo {
namespace {

constexpr LayerInfo kNodes{
    .name = "strip.nodes", .label = "Pass point", .kind = LayerKind::Points, .tone = Tone::Accent};
constexpr LayerInfo kInternal{.name = "strip.internal",
                              .label = "Internal force",
                              .kind = LayerKind::Arrows,
                              .tone = Tone::Internal};
constexpr LayerInfo kExternal{.name = "strip.external",
                              .label = "External forces",
                              .kind = LayerKind::Arrows,
                              .tone = Tone::External};
constexpr LayerInfo kPush{.name = "strip.push",
                          .label = "Push to the chosen side",
                          .kind = LayerKind::Arrows,
                          .tone = Tone::External,
                          .style = LayerStyle::Dashed};
constexpr LayerInfo kElastic{.name = "strip.elastic",
                             .label = "Elastic force",
                             .kind = LayerKind::Arrows,
                             .tone = Tone::Elastic};

constexpr double kNoticeable = 0.005;  // [m] a smaller force gets no sentence,
constexpr double kVisible = 1e-4;      // [m] and one below this no arrow: F_int is often rounding

}  // namespace

struct ElasticStripController::Strip {
  Vec2 start_W{0, 0};  // P^{j-1}
  Vec2 via_W{0, 0};    // P^j
  Vec2 end_W{0, 0};    // P^{j+1}
};

void ElasticStripController::reset(const Pose2& /*start_W*/) {
  side_.reset();
  goal_.reset();
  kept_via_W_.reset();
  damped_W_.reset();
  buffer_.clear();
}

/// Side, kept via and buffer belong to one goal: another goal has another line to it.
void ElasticStripController::follow_goal(const SetGoal& goal, const Vec2& start_W) {
  if (goal_ && goal_->position_W == goal.position_W) return;
  side_.reset();
  kept_via_W_.reset();
  damped_W_.reset();
  buffer_.reset(start_W, goal.position_W);
  goal_ = goal;
}

/// Half a step to the via and half a step on, so that |end - start| = min(S, D).
ElasticStripController::Strip ElasticStripController::lay_strip(
    const Vec2& start_W, const Vec2& goal_W, const Parameters& parameters) const {
  const double half_step = parameters[kStripStep] / 2;
  Strip strip;
  strip.start_W = start_W;
  strip.via_W = get_posi(start_W, goal_W, half_step, 1.0).position();
  strip.end_W = get_posi(strip.via_W, goal_W, half_step, 1.0).position();
  if (reading_.keep_via) strip.via_W = kept_via_W_.value_or(strip.via_W);
  return strip;
}

/// The external force of each side, from the present pose. False if the robot stands on an obstacle
/// point: no direction then leads away from it.
bool ElasticStripController::push(const ControlInput& in, const ForceSettings& settings) {
  const Vec2 p = in.odometry.pose.position();
  const std::optional<Nearest>& left = in.scene->left;
  const std::optional<Nearest>& right = in.scene->right;
  const bool both = reading_.sides == Sides::Both;
  const double d_left = left ? (p - left->point_W).norm() : 0;
  const double d_right = right ? (p - right->point_W).norm() : 0;
  if ((left && d_left == 0) || (right && d_right == 0)) return false;
  // Of equals, the lower beam, which is on the right.
  if (left && (both || !right || d_left < d_right)) {
    forces_.left_W = external_force(settings, p, left->point_W);
  }
  if (right && (both || !left || d_right <= d_left)) {
    forces_.right_W = external_force(settings, p, right->point_W);
  }
  return true;
}

/// Our extension: a force that is a low-pass of the published one.
void ElasticStripController::damp(double time_constant, double dt) {
  const Vec2 last = damped_W_.value_or(forces_.elastic_W);
  damped_W_ = last + dt / (time_constant + dt) * (forces_.elastic_W - last);
  forces_.elastic_W = *damped_W_;
}

void ElasticStripController::choose(const ControlInput& in, const Vec2& goal_W, double reach) {
  const SideInput input{
      in.stamp, in.odometry.pose, goal_W, reach, in.spec->radius, &in.scene->scan};
  const SidePush push = side_.update(input, forces_.left_W + forces_.right_W);
  forces_.push_W = push.force_W;
  forces_.elastic_W += push.force_W;
  forces_.side = side_.state().side;
  forces_.side_since = side_.state().since;
  forces_.side_alpha = push.alpha;
  forces_.blocked_beam = push.blocked_beam;
}

void ElasticStripController::update(const ControlInput& in,
                                    const Parameters& parameters,
                                    ControlOutput& out) {
  out.clear();
  forces_ = {};
  if (!all_finite(in, parameters)) return;
  if (!in.goal) {
    reset(in.odometry.pose);
    return;
  }
  const SetGoal& goal = *in.goal;
  const Pose2& pose = in.odometry.pose;
  follow_goal(goal, pose.position());
  const double reach = parameters[kSafetyDistance] + in.spec->radius;
  const ForceSettings settings{
      reading_.law, reach, parameters[kRepulsionGain], parameters[kStripStep]};

  const Strip strip = lay_strip(pose.position(), goal.position_W, parameters);
  const double k_c = parameters[algo::kContractionGain];
  forces_.internal_W = internal_force(strip.start_W, strip.via_W, strip.end_W, k_c);
  const bool free_to_move = push(in, settings);
  forces_.elastic_W = forces_.internal_W + forces_.left_W + forces_.right_W;
  if (reading_.choose_side) choose(in, goal.position_W, reach);
  if (const double damping = parameters[kDamping]; damping > 0) damp(damping, in.dt);
  const Vec2 pass_W = update_strip(pose, strip.end_W, forces_.elastic_W).updated.position();
  kept_via_W_ = pass_W;
  out.pass_W = pass_W;
  show(strip, pass_W, goal.position_W, out);
  const Vec2 next_W = next_point(pose.position(), pass_W, parameters);

  const double to_goal = (goal.position_W - pose.position()).norm();
  if (!free_to_move) return;
  out.twist = to_goal < parameters[algo::kGoalReach] ? turn_to(pose, goal, parameters)
                                                     : drive_to(pose, next_W, parameters);
}

/// The pass point, or as the sibling thesis has it, the next point of its buffer.
Vec2 ElasticStripController::next_point(const Vec2& p_W,
                                        const Vec2& pass_W,
                                        const Parameters& parameters) {
  if (parameters[kViaBuffer] == 0) return pass_W;
  const auto rule = parameters[kViaBuffer] == 1 ? IsSortRule::Corrected : IsSortRule::Literal;
  buffer_.advance(p_W);
  const bool pushed = !forces_.left_W.isZero(0) || !forces_.right_W.isZero(0);
  if (pushed) buffer_.insert(pass_W, rule);
  const std::optional<Via> next = buffer_.get_position(buffer_.cursor() + 1);
  return next ? next->position_W : pass_W;
}

void ElasticStripController::show(const Strip& strip,
                                  const Vec2& pass_W,
                                  const Vec2& goal_W,
                                  ControlOutput& out) const {
  put(add_layer(out.layers, layers::kStrip), strip.start_W, pass_W);
  put(add_layer(out.layers, layers::kStripAhead), pass_W, goal_W);
  put(add_layer(out.layers, kNodes), pass_W);
  const auto arrows = [&](const LayerInfo& info, std::initializer_list<const Vec2*> forces) {
    Layer& layer = add_layer(out.layers, info, 4 * forces.size());
    for (const Vec2* force : forces) {
      if (force->squaredNorm() > kVisible * kVisible) put(layer, strip.end_W, *force);
    }
  };
  arrows(kInternal, {&forces_.internal_W});
  arrows(kExternal, {&forces_.left_W, &forces_.right_W});
  arrows(kPush, {&forces_.push_W});
  arrows(kElastic, {&forces_.elastic_W});

  const double before = (pass_W - strip.start_W).norm();
  const double after = (strip.end_W - pass_W).norm();
  const auto measure = [&](std::string_view name, std::string_view unit, double value) {
    out.measures.push_back({name, unit, value});
  };
  measure("strip.length", "m", before + after);
  measure("strip.internal", "m", forces_.internal_W.norm());
  measure("strip.left", "m", forces_.left_W.norm());
  measure("strip.right", "m", forces_.right_W.norm());
  measure("strip.push", "m", forces_.push_W.norm());
  measure("strip.elastic", "m", forces_.elastic_W.norm());
  measure("strip.side", "", static_cast<double>(forces_.side));
  if (before + after > 0) measure("strip.share", "", before / (before + after));
}

void ElasticStripController::explain(const Telemetry& t, Explanation& words) const {
  if (t.mission == Mission::Stuck) {
    say(words.why,
        "The pull to the goal and the push of %.2f m from obstacles cancel;",
        forces_.elastic_W.norm());
    return;
  }
  const double left = forces_.left_W.norm();
  const double right = forces_.right_W.norm();
  const bool by_left = left >= right;
  const std::optional<Nearest>& nearest = by_left ? t.scene.left : t.scene.right;
  const double force = by_left ? left : right;
  if (force < kNoticeable || !nearest) {
    say_driving(t, words);
    return;
  }
  say(words.why,
      "External force %.2f m from the nearest %s return at %.2f m",
      force,
      by_left ? "left" : "right",
      nearest->distance);
  if (forces_.side == Side::None) {
    say(words.what, "Keeping clear of the %s obstacle", by_left ? "left" : "right");
    words.why += '.';
    return;
  }
  say(words.what, "Passing the obstacle on its %s", forces_.side == Side::Left ? "left" : "right");
  say(words.why, "; side chosen %.1f s ago.", t.observation.stamp - forces_.side_since);
}

}  // namespace algo
