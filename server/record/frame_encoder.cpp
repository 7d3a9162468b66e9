// server/record/frame_encoder.cpp: one function per part of the frame, in the order of
// telemetry.fbs.
#include <algorithm>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

#include "telemetry_generated.h"

#include "algo/gate.hpp"
#include "server/record/frame_codec.hpp"

namespace server {
namespace {

namespace fb = tautline::wire;
using Builder = flatbuffers::FlatBufferBuilder;
template <typename T>
using Offset = flatbuffers::Offset<T>;

fb::Vec2 to_wire(const algo::Vec2& v) {
  return {v.x(), v.y()};
}
fb::Vec3 to_wire(const algo::Vec3& v) {
  return {v.x(), v.y(), v.z()};
}
fb::Vec2f to_float(const algo::Vec2& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y())};
}
fb::Pose2 to_wire(const algo::Pose2& p) {
  return {p.x, p.y, p.heading};
}
fb::Twist2 to_wire(const algo::Twist2& t) {
  return {t.v, t.omega};
}
fb::Pose2f to_float(const algo::Pose2& p) {
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.heading)};
}
fb::RangeReading to_wire(const algo::RangeReading& r) {
  return {to_wire(r.mount_R), r.stamp, r.range, r.range_max, static_cast<fb::BeamStatus>(r.status)};
}
fb::Bumper to_wire(const algo::BumperReading& b) {
  return {b.stamp, to_float(b.mount_R), b.pressed};
}
fb::Vec2f to_wire(const algo::SetGoal& goal) {
  return to_float(goal.position_W);
}
fb::Moved to_wire(const algo::Moved& m) {
  const fb::Pose2f pose = to_float(m.pose_W);
  return {rounded(pose.x()), rounded(pose.y()), rounded(pose.heading()), m.id};
}

Offset<fb::ObstaclePath> write_path(Builder& b, const algo::ObstaclePath& path) {
  std::vector<double> keys;
  for (const auto& key : path.keys) {
    keys.insert(keys.end(), {key.time, key.position_W.x(), key.position_W.y()});
  }
  return fb::CreateObstaclePathDirect(b, path.period, path.phase, &keys, path.comes_and_goes);
}

Offset<fb::Obstacle> write_obstacle(Builder& b, const algo::Obstacle& o) {
  fb::ShapeKind kind{};
  fb::Vec2 size{};
  double low = 0;
  std::vector<fb::Vec2> points;
  std::visit(
      [&](const auto& shape) {
        using S = std::decay_t<decltype(shape)>;
        if constexpr (std::is_same_v<S, algo::Cylinder>) {
          kind = fb::ShapeKind_Cylinder;
          size = {shape.radius, 0};
        } else if constexpr (std::is_same_v<S, algo::Box>) {
          kind = fb::ShapeKind_Box;
          size = {shape.length, shape.width};
        } else if constexpr (std::is_same_v<S, algo::Polygon>) {
          kind = fb::ShapeKind_Polygon;
          for (const algo::Vec2& p : shape.points) points.push_back(to_wire(p));
        } else if constexpr (std::is_same_v<S, algo::Wall>) {
          kind = fb::ShapeKind_Wall;
          size = {shape.length, shape.thickness};
        } else if constexpr (std::is_same_v<S, algo::Ramp>) {
          kind = fb::ShapeKind_Ramp;
          size = {shape.length, shape.width};
          low = shape.low;
        } else {
          kind = fb::ShapeKind_Trench;
          size = {shape.length, shape.width};
          low = -shape.depth;
        }
      },
      o.shape);
  const auto point_vector =
      points.empty() ? 0 : b.CreateVectorOfStructs(points.data(), points.size());
  const auto path = o.path ? write_path(b, *o.path) : 0;
  const fb::Pose2 pose = to_wire(o.pose_W);
  return fb::CreateObstacle(b,
                            o.id,
                            &pose,
                            kind,
                            &size,
                            point_vector,
                            o.height,
                            o.reflectivity,
                            o.specular,
                            path,
                            low,
                            o.bottom);
}

Offset<fb::SetGoal> write_goal(Builder& b, const algo::SetGoal& goal) {
  const fb::Vec2 position = to_wire(goal.position_W);
  return fb::CreateSetGoal(b, &position, goal.heading.value_or(0), goal.heading.has_value());
}

Offset<flatbuffers::Vector<double>> write_joints(Builder& b, const algo::JointValues& values) {
  return b.CreateVector(values.data(), values.size());
}

Offset<fb::SetHandGoal> write_hand_goal(Builder& b, const algo::SetHandGoal& goal) {
  const algo::Quaternion& a = goal.attitude_W;
  const fb::Vec3 position = to_wire(goal.position_W);
  std::vector<fb::Vec3> path;
  path.reserve(goal.path_W.size());
  for (const algo::Vec3& point_W : goal.path_W) path.push_back(to_wire(point_W));
  const auto points = path.empty() ? 0 : b.CreateVectorOfStructs(path.data(), path.size());
  const fb::Quaternion attitude(a.w, a.x, a.y, a.z);
  const auto then = goal.then ? write_goal(b, *goal.then) : 0;
  fb::SetHandGoalBuilder out(b);
  out.add_position(&position);
  out.add_attitude(&attitude);
  if (goal.arm_angle) out.add_arm_angle(*goal.arm_angle);
  out.add_base_stays(goal.base_stays);
  out.add_then(then);
  out.add_path(points);
  return out.Finish();
}

struct RequestWriter {
  Builder& b;
  using Written = std::pair<fb::Request, Offset<void>>;

  Written operator()(const algo::SetGoal& r) const {
    return {fb::Request_SetGoal, write_goal(b, r).Union()};
  }
  Written operator()(const algo::AddGoal& r) const {
    return {fb::Request_AddGoal, fb::CreateAddGoal(b, write_goal(b, r.goal)).Union()};
  }
  Written operator()(const algo::SetGoals& r) const {
    std::vector<Offset<fb::SetGoal>> goals;
    goals.reserve(r.goals.size());
    for (const algo::SetGoal& goal : r.goals) goals.push_back(write_goal(b, goal));
    return {fb::Request_SetGoals, fb::CreateSetGoalsDirect(b, &goals, r.next, r.loop).Union()};
  }
  Written operator()(const algo::ClearGoal&) const {
    return {fb::Request_ClearGoal, fb::CreateClearGoal(b).Union()};
  }
  Written operator()(const algo::AddObstacle& r) const {
    return {fb::Request_AddObstacle,
            fb::CreateAddObstacle(b, write_obstacle(b, r.obstacle)).Union()};
  }
  Written operator()(const algo::ChangeObstacle& r) const {
    return {fb::Request_ChangeObstacle,
            fb::CreateChangeObstacle(b, write_obstacle(b, r.obstacle)).Union()};
  }
  Written operator()(const algo::MoveObstacle& r) const {
    const fb::Pose2 pose = to_wire(r.pose_W);
    return {fb::Request_MoveObstacle, fb::CreateMoveObstacle(b, r.id, &pose).Union()};
  }
  Written operator()(const algo::RemoveObstacle& r) const {
    return {fb::Request_RemoveObstacle, fb::CreateRemoveObstacle(b, r.id).Union()};
  }
  Written operator()(const algo::Joystick& r) const {
    const std::string_view driver = r.driver.view();
    const auto name = driver.empty() ? flatbuffers::Offset<flatbuffers::String>()
                                     : b.CreateString(driver.data(), driver.size());
    const auto mode = static_cast<std::uint8_t>(r.mode);
    return {fb::Request_Joystick,
            fb::CreateJoystick(b, r.forward, r.turn, mode, r.round_trip, name).Union()};
  }
  Written operator()(const algo::Stop& r) const {
    return {fb::Request_Stop, fb::CreateStop(b, r.engaged).Union()};
  }
  Written operator()(const algo::SetParameter& r) const {
    const std::string_view name = r.parameter->key();
    const auto text = b.CreateString(name.data(), name.size());
    return {fb::Request_SetParameter, fb::CreateSetParameter(b, text, r.value).Union()};
  }
  Written operator()(const algo::SetJoints& r) const {
    const auto positions = write_joints(b, r.position);
    return {fb::Request_SetJoints, fb::CreateSetJoints(b, positions).Union()};
  }
  Written operator()(const algo::SetHandGoal& r) const {
    return {fb::Request_SetHandGoal, write_hand_goal(b, r).Union()};
  }
  Written operator()(const algo::Carry& r) const {
    return {fb::Request_Carry, fb::CreateCarry(b, write_goal(b, r.goal)).Union()};
  }
  Written operator()(const algo::SetInitialPose& r) const {
    const fb::Pose2 pose = to_wire(r.pose_W.value_or(algo::Pose2{}));
    return {fb::Request_SetInitialPose,
            fb::CreateSetInitialPose(b, r.pose_W ? &pose : nullptr).Union()};
  }
  Written operator()(const algo::TakePlan&) const {
    return {fb::Request_TakePlan, fb::CreateTakePlan(b).Union()};
  }
};

Offset<fb::LaserScan> write_scan(Builder& b, const algo::LaserScan& scan) {
  std::uint16_t* samples = nullptr;
  const auto ranges = b.CreateUninitializedVector(scan.size(), &samples);
  algo::pack_beams(scan, {samples, scan.size()});
  const fb::Pose2 mount = to_wire(scan.mount_R);
  fb::LaserScanBuilder out(b);
  out.add_stamp(scan.stamp);
  if (scan.mount_R != algo::Pose2{}) out.add_mount(&mount);
  out.add_angle_min(scan.angle_min);
  out.add_angle_increment(scan.angle_increment);
  out.add_range_max(scan.range_max);
  out.add_turn_period(scan.turn_period);
  out.add_turns(scan.turns);
  out.add_ranges(ranges);
  return out.Finish();
}

template <typename Wire, typename List>
Offset<flatbuffers::Vector<const Wire*>> write_structs(Builder& b, const List& list) {
  if (list.empty()) return 0;
  // Not CreateUninitializedVectorOfStructs(), which aligns a struct by its size.
  return b.CreateVectorOfStructs<Wire>(list.size(),
                                       [&](std::size_t i, Wire* out) { *out = to_wire(list[i]); });
}

Offset<flatbuffers::String> write_name(Builder& b, const algo::Name& name) {
  if (name.empty()) return 0;
  return b.CreateString(name.view().data(), name.view().size());
}

Offset<fb::LaserLine> write_line(Builder& b, const algo::LineImage& line) {
  if (!line.fresh) return 0;
  float* to = nullptr;
  const auto pixels = b.CreateUninitializedVector(2 * line.pixels.size(), &to);
  for (const algo::LinePixel& pixel : line.pixels) {
    *to++ = pixel.u;
    *to++ = pixel.v;
  }
  return fb::CreateLaserLine(b, pixels, line.stamp);
}

Offset<flatbuffers::Vector<Offset<fb::Reading>>> write_channels(Builder& b,
                                                                const algo::Observation& o) {
  if (o.channels.empty()) return 0;
  std::vector<Offset<fb::Reading>> readings;
  for (const algo::ChannelReading& reading : o.channels) {
    const auto values = b.CreateVector(reading.values);
    fb::ReadingBuilder out(b);
    out.add_channel(reading.channel);
    out.add_values(values);
    if (reading.stamp != o.stamp) out.add_stamp(reading.stamp);
    readings.push_back(out.Finish());
  }
  return b.CreateVector(readings);
}

Offset<flatbuffers::Vector<Offset<fb::RequestBox>>> write_requests(
    Builder& b, const algo::Recycled<algo::Request>& requests) {
  if (requests.empty()) return 0;
  std::vector<Offset<fb::RequestBox>> boxes;
  for (const algo::Request& request : requests) {
    const auto [type, offset] = std::visit(RequestWriter{b}, request);
    boxes.push_back(fb::CreateRequestBox(b, type, offset));
  }
  return b.CreateVector(boxes);
}

Offset<fb::Joints> write_reading(Builder& b, const algo::Observation& o) {
  if (!o.joints) return 0;
  const auto positions = write_joints(b, o.joints->position);
  const auto rates = write_joints(b, o.joints->rate);
  fb::JointsBuilder out(b);
  out.add_positions(positions);
  out.add_rates(rates);
  if (o.joints->stamp != o.stamp) out.add_stamp(o.joints->stamp);
  return out.Finish();
}

Offset<fb::MapPose> write_map_pose(Builder& b, const algo::Observation& o) {
  if (!o.map_pose) return 0;
  const algo::MapPose& at = *o.map_pose;
  const fb::Pose2 wheels = to_wire(at.wheels);
  return fb::CreateMapPose(b,
                           &wheels,
                           at.xx,
                           at.xy,
                           at.yy,
                           at.turn,
                           at.fit,
                           at.places,
                           at.epoch,
                           static_cast<fb::MapFix>(at.fix));
}

template <typename Numbers>
Offset<flatbuffers::Vector<float>> write_floats(Builder& b, const Numbers& numbers) {
  std::vector<float> floats(numbers.begin(), numbers.end());
  return b.CreateVector(floats);
}

Offset<fb::Arm> write_arm(Builder& b, const algo::ArmTelemetry& arm) {
  if (!arm.present) return 0;
  const auto clearance = write_floats(b, arm.clearance);
  const auto hand = arm.hand_goal ? write_hand_goal(b, *arm.hand_goal) : 0;
  const auto joints = arm.joint_goal ? write_joints(b, arm.joint_goal->position) : 0;
  std::vector<float> poses;
  if (arm.plan_fresh) {
    for (const algo::GhostPose& pose : arm.ghost)
      poses.insert(poses.end(), pose.begin(), pose.end());
  }
  const auto ghost = arm.plan_fresh ? b.CreateVector(poses) : 0;
  fb::ArmBuilder out(b);
  out.add_clearance(clearance);
  out.add_own_clearance(static_cast<float>(arm.own_clearance));
  out.add_state(static_cast<fb::ArmState>(arm.state));
  out.add_hand_goal(hand);
  out.add_joint_goal(joints);
  out.add_plan(arm.plan);
  out.add_ghost(ghost);
  return out.Finish();
}

struct FrameWriter {
  fb::FrameBuilder frame;
  const algo::Telemetry& t;

  void doubles();
  void truth();
  void decision();
};

// Structs live inside the table: the locals only have to outlive their add_ call.

/// Adds all fields aligned to eight bytes together, so that padding wastes no byte. Adds a stamp
/// only if it differs from the frame's.
void FrameWriter::doubles() {
  const algo::Observation& o = t.observation;
  const fb::Clock clock(t.tick, o.stamp);
  frame.add_clock(&clock);
  const fb::Odometry odometry(to_wire(o.odometry.pose), to_wire(o.odometry.twist));
  frame.add_odometry(&odometry);
  if (o.odometry.stamp != o.stamp) frame.add_odometry_stamp(o.odometry.stamp);
  if (o.gyro) {
    const fb::YawGyro gyro(o.gyro->rate);
    frame.add_gyro(&gyro);
    if (o.gyro->stamp != o.stamp) frame.add_gyro_stamp(o.gyro->stamp);
  }
  if (o.inclinometer) {
    const fb::Inclinometer inclinometer(o.inclinometer->roll, o.inclinometer->pitch);
    frame.add_inclinometer(&inclinometer);
    if (o.inclinometer->stamp != o.stamp) frame.add_inclinometer_stamp(o.inclinometer->stamp);
  }
  if (o.floor) {
    const algo::FloorRanges& r = *o.floor;
    const fb::FloorRanges floor(r.stamp, r.far_left, r.far_right, r.near_left, r.near_right);
    frame.add_floor(&floor);
  }
  if (o.encoders && o.encoders->stamp != o.stamp) frame.add_encoders_stamp(o.encoders->stamp);
  if (t.hold == algo::holds::kStaleScan && t.scene.scan.size() > 0) {
    frame.add_newest_scan(t.scene.scan.stamp);
  }
  const fb::Twist2 command = to_wire(t.command.base);
  frame.add_command(&command);
  const fb::Twist2 answer = to_wire(t.output.twist);
  if (t.output.answered) frame.add_answer(&answer);
}

void FrameWriter::truth() {
  if (!t.ground_truth) return;
  const algo::GroundTruth& g = *t.ground_truth;
  const fb::GroundTruth truth(
      to_float(g.pose), static_cast<float>(g.obstacle_distance), static_cast<float>(g.clearance));
  frame.add_truth(&truth);
  frame.add_collided(g.collided);
  frame.add_overturned(g.overturned);
  frame.add_fallen(g.fallen);
  if (g.touched) frame.add_touched(static_cast<fb::BodyLink>(*g.touched));
  if (!g.tilt) return;
  const fb::Tilt tilt(static_cast<float>(g.tilt->z),
                      static_cast<float>(g.tilt->roll),
                      static_cast<float>(g.tilt->pitch));
  frame.add_tilt(&tilt);
}

void FrameWriter::decision() {
  const algo::ControlOutput& out = t.output;
  const fb::Decision decision(static_cast<float>(t.clearance),
                              t.legend,
                              static_cast<fb::Mission>(t.mission),
                              out.state,
                              out.waits);
  frame.add_decision(&decision);
  frame.add_halt(static_cast<fb::Halt>(t.observation.halt));
  if (!t.goal) return;
  const fb::Vec2f goal = to_float(t.goal->position_W);
  frame.add_goal(&goal);
  if (t.goal->heading) frame.add_goal_heading(static_cast<float>(*t.goal->heading));
}

}  // namespace

/// FlatBuffers writes from the leaves to the root and from the end of the buffer to its front. The
/// parts whose size varies most come first, so that all others keep their place in the frame: the
/// record compares frames byte by byte.
std::span<const std::byte> FrameEncoder::encode(const algo::Telemetry& t) {
  Builder& b = builder_;
  b.Clear();
  const algo::Observation& o = t.observation;
  const auto news = layers_.write_news(b, t);
  const auto shown = layers_.write_shown(b, t);
  b.Align(sizeof(double));  // so that the size of these parts moves nothing else
  scans_.clear();
  for (const algo::LaserScan& scan : o.scans) scans_.push_back(write_scan(b, scan));
  const auto scans = scans_.empty() ? 0 : b.CreateVector(scans_);
  const auto sonar = write_structs<fb::RangeReading>(b, o.sonar);
  const auto infrared = write_structs<fb::RangeReading>(b, o.infrared);
  const auto requests = write_requests(b, t.requests);
  const auto bumpers = write_structs<fb::Bumper>(b, o.bumpers);
  const auto moved = write_structs<fb::Moved>(b, t.moved);
  const auto goals_ahead = write_structs<fb::Vec2f>(b, t.goals_ahead);
  const auto channels = write_channels(b, o);
  const auto reading = write_reading(b, o);
  const auto map_pose = write_map_pose(b, o);
  const auto arm = write_arm(b, t.arm);
  const auto line = write_line(b, o.line);
  const auto rates =
      t.command.joints == 0 ? 0 : b.CreateVector(t.command.joint_rates.data(), t.command.joints);
  const auto& turns = t.output.joint_rates;
  const auto answer = t.output.answered && turns ? write_joints(b, *turns) : 0;
  const auto hold = write_name(b, t.hold.name);
  const auto limit = write_name(b, t.limit.name);
  const auto behaviour = t.behaviour == algo::behaviours::kAvoid ? 0 : write_name(b, t.behaviour);

  FrameWriter writer{fb::FrameBuilder(b), t};
  fb::FrameBuilder& frame = writer.frame;
  writer.doubles();
  // Offset 0 means absent: no field is written.
  frame.add_behaviour(behaviour);
  frame.add_news(news);
  frame.add_scans(scans);
  frame.add_sonar(sonar);
  frame.add_map_pose(map_pose);
  frame.add_infrared(infrared);
  frame.add_bumpers(bumpers);
  frame.add_requests(requests);
  if (o.encoders) {
    const fb::Encoders encoders(o.encoders->left, o.encoders->right);
    frame.add_encoders(&encoders);
  }
  writer.truth();
  writer.decision();
  frame.add_shown(shown.narrow);
  frame.add_shown_wide(shown.wide);
  frame.add_more(shown.more);
  frame.add_hold(hold);
  frame.add_limit(limit);
  frame.add_channels(channels);
  frame.add_line(line);
  frame.add_joint_rates(rates);
  frame.add_answer_joints(answer);
  frame.add_joints(reading);
  frame.add_arm(arm);
  frame.add_goals_ahead(goals_ahead);
  frame.add_moved(moved);
  b.Finish(frame.Finish());

  find_windows();
  return std::as_bytes(std::span(b.GetBufferPointer(), b.GetSize()));
}

std::span<const std::byte> FrameEncoder::encode(const algo::LaserScan& scan) {
  builder_.Clear();
  windows_.clear();
  builder_.Finish(write_scan(builder_, scan));
  return std::as_bytes(std::span(builder_.GetBufferPointer(), builder_.GetSize()));
}

void FrameEncoder::find_windows() {
  const std::uint8_t* bytes = builder_.GetBufferPointer();
  const fb::Frame* frame = fb::GetFrame(bytes);
  windows_.clear();
  if (frame->scans() == nullptr) return;
  for (const fb::LaserScan* scan : *frame->scans()) {
    const auto& ranges = *scan->ranges();
    windows_.push_back({static_cast<std::uint32_t>(ranges.Data() - bytes), ranges.size()});
  }
  std::ranges::reverse(windows_);  // a frame is written back to front
}

}  // namespace server
