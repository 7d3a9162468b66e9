// algo/full_strip/full_strip_report.cpp: the layers and words of a tick of the full strip.
#include "algo/common_layers.hpp"
#include "algo/explain.hpp"
#include "algo/full_strip/full_strip_controller.hpp"

namespace algo {
namespace {

constexpr std::uint32_t kDrawn = 240;  // cells along the drawn map's edge: 12 m
constexpr double kOutOfSight = 0.2;    // [s] since last seen
constexpr std::size_t kFewMoving = 8;  // reserved capacity

/// The measure of a robot with a known map: why the map speaks against the way.
constexpr std::string_view kMapDoubt = "map.doubt";
constexpr double kDrawnTaken = 1;  // it shows something on the goal
constexpr double kNoDrawnWay = 2;  // it shows no way to the goal

constexpr LayerInfo kMap{
    .name = "map", .label = "Map", .kind = LayerKind::Grid, .tone = Tone::External};
constexpr LayerInfo kMoving{.name = "moving",
                            .label = "Moving obstacles",
                            .kind = LayerKind::Circles,
                            .tone = Tone::Moving};
constexpr LayerInfo kHidden{.name = "moving.hidden",
                            .label = "Moving obstacles, out of sight",
                            .kind = LayerKind::Circles,
                            .tone = Tone::Moving,
                            .style = LayerStyle::Faint};
constexpr LayerInfo kVelocities{.name = "moving.velocity",
                                .label = "Its way in a second",
                                .kind = LayerKind::Arrows,
                                .tone = Tone::Moving,
                                .unit = "m/s"};

}  // namespace

void FullStripController::report(const ControlInput& in, ControlOutput& out) const {
  out.state = state_;
  out.waits = state_ == kNoWay || state_ == kGoalTaken || state_ == kBlocked ||
              state_ == kCornered || state_ == kPlanning;
  Layer& map = add_layer(out.layers, kMap);
  if (in.grids) senses_.map().draw(in.odometry.pose.position(), kDrawn, map);
  Layer& plan = add_layer(out.layers, layers::kPlan);
  for (const Vec2& point : route_.path_W()) put(plan, point);
  if (limits_.jerk > 0 || limits_.angular_jerk > 0) {
    out.measures.push_back({kHardCommand, "", hard_ ? 1.0 : 0.0});
  }
  if (drawn_) tell_map(out);
  show_weighed(out);
  show_strip(out);
  show_moving(out);
}

/// Tells if the way rests on a doubt of the known map.
void FullStripController::tell_map(ControlOutput& out) const {
  const auto cell = BuildingMemory::cell_of(*route_.goal_W());
  const bool taken = route_.goal_replaced() && !senses_.memory().seen(cell);
  const double doubt = route_.doubts_walls() ? kNoDrawnWay : taken ? kDrawnTaken : 0;
  out.measures.push_back({kMapDoubt, "", doubt});
}

void FullStripController::show_weighed(ControlOutput& out) const {
  const auto show = [&](const LayerInfo& info, const auto& belongs) {
    Layer& layer = add_layer(out.layers, info, 2 * Weighing::kMost);
    for (const Candidate& c : weighed_.candidates) {
      if (belongs(c)) put(layer, c.horizon * c.twist.v, c.horizon * c.twist.omega);
    }
  };
  show(layers::kRefused, [](const Candidate& c) { return !c.allowed; });
  show(layers::kAllowed, [](const Candidate& c) { return c.allowed && !c.chosen; });
  show(layers::kChosen, [](const Candidate& c) { return c.chosen; });
}

void FullStripController::show_strip(ControlOutput& out) const {
  Layer& line = add_layer(out.layers, layers::kStrip);
  for (const Node& node : route_.strip().nodes()) put(line, node.position_W);
  Layer& ahead = add_layer(out.layers, layers::kStripAhead, 4);
  const NodeStrip& strip = route_.strip();
  if (strip.empty()) return;
  // It ends short of a goal that lies beyond the map or under an obstacle.
  const auto& goal_W = route_.goal_W();
  if (goal_W && strip.end_W() != *goal_W) put(ahead, strip.end_W(), *goal_W);
  out.measures.push_back({"strip.length", "m", strip.length()});
}

void FullStripController::show_moving(ControlOutput& out) const {
  const auto show = [&](const LayerInfo& info, bool hidden) {
    Layer& circles = add_layer(out.layers, info, 3 * kFewMoving);
    for (const Track& track : senses_.tracker().moving()) {
      if ((track.unseen > kOutOfSight) == hidden) put(circles, track.position_W, track.radius);
    }
  };
  show(kMoving, false);
  show(kHidden, true);
  Layer& velocities = add_layer(out.layers, kVelocities, 4 * kFewMoving);
  for (const Track& track : senses_.tracker().moving())
    put(velocities, track.position_W, track.velocity_W);
  if (!among_moving_) return;
  out.measures.push_back(
      {"moving.count", "", static_cast<double>(senses_.tracker().moving().size())});
}

void FullStripController::explain(const Telemetry& t, Explanation& words) const {
  const double moving = t.output.measure("moving.count").value_or(0);
  switch (t.output.state) {
    case kNone:
      say_driving(t, words);
      break;
    case kTurning:
      words.what = "Turning towards the strip";
      words.why = "It leads away at too wide an angle to drive into.";
      break;
    case kManeuvering:
      words.what = "Manoeuvring";
      words.why = "The place is too narrow to turn in; it moves to and fro.";
      break;
    case kGivingWay:
      words.what = "Giving way";
      say(words.why, "%.0f things move; waiting costs less than driving on.", moving);
      break;
    case kCornered:
      words.what = "Making room";
      say(words.why, "%.0f things move and every motion comes too close to one.", moving);
      break;
    case kEscaping:
      words.what = "Making room";
      words.why = "Something stands closer than the strip may pass.";
      break;
    case kBackingOff:
      words.what = "Backing off";
      words.why = "There was no way on for too long; a new strip is laid.";
      break;
    case kNoWay:
      words.what = "No way known";
      say(words.why,
          "The map shows no way to the goal, %.2f m away. It is asked again every second.",
          to_goal(t));
      break;
    case kGoalTaken:
      words.what = "The goal is taken";
      say(words.why,
          "Something stands on it, %.2f m away, or too close to it. It is looked at again four "
          "times a second.",
          to_goal(t));
      break;
    case kPlanning:
      words.what = "Looking for a way";
      say(words.why, "It searches its map for a way to the goal, %.2f m away.", to_goal(t));
      break;
    case kBlocked:
      words.what = "Standing still";
      words.why = "No motion could be braked in time. ";
      say_surroundings(t, words.why);
      break;
    default:
      words.what = "Following the strip";
      if (t.output.measure(kMapDoubt).value_or(0) == kNoDrawnWay) {
        words.why = "The known map shows no way to the goal: it drives to see if a wall is gone. ";
      } else if (t.output.measure(kMapDoubt).value_or(0) == kDrawnTaken) {
        words.why = "The known map shows something on the goal: it drives to see if it is there. ";
      }
      say(words.why,
          "%.2f m along it to the goal, at %.2f m/s. ",
          t.output.measure("strip.length").value_or(0),
          t.output.twist.v);
      say_surroundings(t, words.why);
  }
}

}  // namespace algo
