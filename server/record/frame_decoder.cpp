// server/record/frame_decoder.cpp: reads an untrusted frame part by part.
#include <algorithm>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include "telemetry_generated.h"

#include "algo/pipeline/parameter_table.hpp"
#include "server/record/frame_codec.hpp"

namespace server {
namespace {

namespace fb = tautline::wire;

algo::Vec2 from_wire(const fb::Vec2& v) {
  return {v.x(), v.y()};
}
algo::Vec3 from_wire(const fb::Vec3& v) {
  return {v.x(), v.y(), v.z()};
}
algo::Vec2 from_wire(const fb::Vec2f& v) {
  return {v.x(), v.y()};
}
algo::Pose2 from_wire(const fb::Pose2& p) {
  return {p.x(), p.y(), p.heading()};
}
algo::Pose2 from_wire(const fb::Pose2f& p) {
  return {p.x(), p.y(), p.heading()};
}
algo::Twist2 from_wire(const fb::Twist2& t) {
  return {t.v(), t.omega()};
}

/// The library's verifier checks the length of a vector of structs or doubles, but not its
/// alignment.
template <typename Element>
void check_alignment(const flatbuffers::Vector<Element>& list) {
  using Value = std::remove_pointer_t<Element>;  // itself, or the struct
  if (reinterpret_cast<std::uintptr_t>(list.Data()) % alignof(Value) == 0) return;
  throw WireError("A list in the frame does not lie where its elements can be read.");
}

algo::ObstaclePath read_path(const fb::ObstaclePath& path) {
  algo::ObstaclePath out{path.period(), path.phase(), {}, path.comes_and_goes()};
  if (path.keys() == nullptr || path.keys()->size() % 3 != 0 || !(path.period() > 0)) {
    throw WireError("The path of an obstacle in the frame is not complete.");
  }
  check_alignment(*path.keys());
  for (unsigned i = 0; i < path.keys()->size(); i += 3) {
    out.keys.push_back({path.keys()->Get(i), {path.keys()->Get(i + 1), path.keys()->Get(i + 2)}});
  }
  return out;
}

algo::Obstacle read_obstacle(const fb::Obstacle* o) {
  if (o == nullptr || o->pose() == nullptr || o->size() == nullptr) {
    throw WireError("An obstacle in the frame lacks its pose or size.");
  }
  algo::Obstacle out;
  out.id = o->id();
  out.pose_W = from_wire(*o->pose());
  out.height = o->height();
  out.reflectivity = o->reflectivity();
  out.specular = o->specular();
  out.bottom = o->bottom();
  if (o->path() != nullptr) out.path = read_path(*o->path());
  const double a = o->size()->x();
  const double c = o->size()->y();
  switch (o->kind()) {
    case fb::ShapeKind_Cylinder:
      out.shape = algo::Cylinder{a};
      break;
    case fb::ShapeKind_Box:
      out.shape = algo::Box{a, c};
      break;
    case fb::ShapeKind_Wall:
      out.shape = algo::Wall{a, c};
      break;
    case fb::ShapeKind_Ramp:
      out.shape = algo::Ramp{a, c, o->low()};
      break;
    case fb::ShapeKind_Trench:
      out.shape = algo::Trench{a, c, -o->low()};
      break;
    case fb::ShapeKind_Polygon: {
      algo::Polygon polygon;
      if (o->points() != nullptr) {
        check_alignment(*o->points());
        for (const fb::Vec2* p : *o->points()) polygon.points.push_back(from_wire(*p));
      }
      out.shape = std::move(polygon);
      break;
    }
    default:
      throw WireError("An obstacle in the frame has an unknown shape.");
  }
  return out;
}

algo::SetGoal read_goal(const fb::SetGoal& goal) {
  if (goal.position() == nullptr) throw WireError("A goal in the frame lacks its position.");
  algo::SetGoal out;
  out.position_W = from_wire(*goal.position());
  if (goal.has_heading()) out.heading = goal.heading();
  return out;
}

algo::JointValues read_joints(const flatbuffers::Vector<double>* list) {
  algo::JointValues values{};
  if (list == nullptr || list->size() != values.size()) {
    throw WireError("The frame does not have one number for each joint of an arm.");
  }
  check_alignment(*list);
  std::copy(list->begin(), list->end(), values.begin());
  return values;
}

algo::SetHandGoal read_hand_goal(const fb::SetHandGoal& goal) {
  if (goal.position() == nullptr || goal.attitude() == nullptr) {
    throw WireError("A goal of the hand in the frame lacks its position or attitude.");
  }
  algo::SetHandGoal out;
  out.position_W = from_wire(*goal.position());
  if (goal.path() != nullptr) {
    check_alignment(*goal.path());
    out.path_W.reserve(goal.path()->size());
    for (const fb::Vec3* point : *goal.path()) out.path_W.push_back(from_wire(*point));
  }
  const fb::Quaternion& a = *goal.attitude();
  out.attitude_W = {a.w(), a.x(), a.y(), a.z()};
  if (const auto angle = goal.arm_angle()) out.arm_angle = *angle;
  out.base_stays = goal.base_stays();
  if (goal.then() != nullptr) out.then = read_goal(*goal.then());
  return out;
}

algo::SetParameter read_parameter(const fb::SetParameter& r) {
  const std::string name = r.name() == nullptr ? "" : r.name()->str();
  const algo::ParameterInfo* const parameter = algo::find_parameter(name);
  if (parameter == nullptr) throw WireError("The frame sets an unknown parameter '" + name + "'.");
  return {parameter, r.value()};
}

algo::Request read_request(const fb::RequestBox& box) {
  if (box.request() == nullptr) throw WireError("The frame has an empty request.");
  switch (box.request_type()) {
    case fb::Request_SetGoal:
      return read_goal(*box.request_as_SetGoal());
    case fb::Request_AddGoal: {
      const auto* add = box.request_as_AddGoal();
      if (add->goal() == nullptr) throw WireError("A further goal in the frame is empty.");
      return algo::AddGoal{read_goal(*add->goal())};
    }
    case fb::Request_SetGoals: {
      const auto* list = box.request_as_SetGoals();
      algo::SetGoals out{{}, list->next(), list->loop()};
      if (list->goals() != nullptr) {
        for (const fb::SetGoal* goal : *list->goals()) out.goals.push_back(read_goal(*goal));
      }
      if (out.next >= std::max<std::size_t>(1, out.goals.size())) {
        throw WireError("A list of goals in the frame begins behind its end.");
      }
      return out;
    }
    case fb::Request_ClearGoal:
      return algo::ClearGoal{};
    case fb::Request_AddObstacle:
      return algo::AddObstacle{read_obstacle(box.request_as_AddObstacle()->obstacle())};
    case fb::Request_ChangeObstacle:
      return algo::ChangeObstacle{read_obstacle(box.request_as_ChangeObstacle()->obstacle())};
    case fb::Request_MoveObstacle: {
      const auto* move = box.request_as_MoveObstacle();
      if (move->pose() == nullptr) throw WireError("A move in the frame lacks its pose.");
      return algo::MoveObstacle{move->id(), from_wire(*move->pose())};
    }
    case fb::Request_RemoveObstacle:
      return algo::RemoveObstacle{box.request_as_RemoveObstacle()->id()};
    case fb::Request_Joystick: {
      const auto* stick = box.request_as_Joystick();
      if (stick->mode() > static_cast<std::uint8_t>(algo::StickMode::Elastic)) {
        throw WireError("The frame has a stick of an unknown mode.");
      }
      const std::string_view driver = stick->driver() ? stick->driver()->string_view() : "";
      if (driver.size() > algo::Name::kLongest) {
        throw WireError("The frame has a driver of too long a name.");
      }
      return algo::Joystick{stick->forward(),
                            stick->turn(),
                            static_cast<algo::StickMode>(stick->mode()),
                            stick->round_trip(),
                            driver};
    }
    case fb::Request_Stop:
      return algo::Stop{box.request_as_Stop()->engaged()};
    case fb::Request_SetParameter:
      return read_parameter(*box.request_as_SetParameter());
    case fb::Request_SetJoints:
      return algo::SetJoints{read_joints(box.request_as_SetJoints()->positions())};
    case fb::Request_SetHandGoal:
      return read_hand_goal(*box.request_as_SetHandGoal());
    case fb::Request_Carry: {
      const auto* carry = box.request_as_Carry();
      if (carry->goal() == nullptr) throw WireError("A goal to carry to in the frame is empty.");
      return algo::Carry{read_goal(*carry->goal())};
    }
    case fb::Request_SetInitialPose: {
      const auto* at = box.request_as_SetInitialPose();
      if (at->pose() == nullptr) return algo::SetInitialPose{};
      return algo::SetInitialPose{from_wire(*at->pose())};
    }
    case fb::Request_TakePlan:
      return algo::TakePlan{};
    default:
      throw WireError("The frame has a request of an unknown kind.");
  }
}

void read_scan(const fb::LaserScan& in, algo::LaserScan& scan) {
  if (in.ranges() == nullptr || in.turns() == 0) {
    throw WireError("A scan in the frame lacks its turns or ranges.");
  }
  scan.mount_R = in.mount() == nullptr ? algo::Pose2{} : from_wire(*in.mount());
  scan.stamp = in.stamp();
  scan.angle_min = in.angle_min();
  scan.angle_increment = in.angle_increment();
  scan.range_max = in.range_max();
  scan.turn_period = in.turn_period();
  scan.turns = in.turns();
  scan.resize(in.ranges()->size());
  for (std::size_t i = 0; i < scan.size(); ++i) {
    algo::unpack_beam(scan, i, in.ranges()->Get(static_cast<flatbuffers::uoffset_t>(i)));
  }
}

template <typename T>
void check_enum(T value, T max, const char* what) {
  if (value > max) throw WireError(std::string("The frame has an unknown ") + what + ".");
}

void read_line(const fb::LaserLine& line, algo::Observation& o) {
  o.line.fresh = true;
  o.line.stamp = line.stamp();
  if (line.pixels() == nullptr) return;
  check_alignment(*line.pixels());
  if (line.pixels()->size() % 2 != 0) throw WireError("The laser line in the frame is not whole.");
  for (unsigned i = 0; i < line.pixels()->size(); i += 2) {
    o.line.pixels.push_back({line.pixels()->Get(i), line.pixels()->Get(i + 1)});
  }
}

void read_map_pose(const fb::MapPose& in, algo::Observation& o) {
  check_enum(in.fix(), fb::MapFix_MAX, "fix on the map");
  o.map_pose = {.fix = static_cast<algo::MapFix>(in.fix()),
                .places = in.places(),
                .epoch = in.epoch(),
                .wheels = in.wheels() == nullptr ? algo::Pose2{} : from_wire(*in.wheels()),
                .xx = in.xx(),
                .xy = in.xy(),
                .yy = in.yy(),
                .turn = in.turn(),
                .fit = in.fit()};
}

void read_observation(const fb::Frame& f, algo::Observation& o) {
  o.clear_sensors();
  o.stamp = f.clock()->stamp();
  check_enum(f.halt(), fb::Halt_MAX, "halt");
  o.halt = static_cast<algo::Halt>(f.halt());
  const fb::Odometry& odometry = *f.odometry();
  o.odometry = {f.odometry_stamp().value_or(o.stamp),
                from_wire(odometry.pose()),
                from_wire(odometry.twist())};
  if (f.scans() != nullptr) {
    for (const fb::LaserScan* scan : *f.scans()) read_scan(*scan, o.scans.append());
  }
  const auto read_ring = [](const auto* wire, algo::Recycled<algo::RangeReading>& ring) {
    if (wire == nullptr) return;
    check_alignment(*wire);
    for (const fb::RangeReading* r : *wire) {
      check_enum(r->status(), fb::BeamStatus_MAX, "beam status");
      ring.push_back({from_wire(r->mount()),
                      r->stamp(),
                      r->range(),
                      r->range_max(),
                      static_cast<algo::Beam>(r->status())});
    }
  };
  read_ring(f.sonar(), o.sonar);
  read_ring(f.infrared(), o.infrared);
  if (f.bumpers() != nullptr) {
    check_alignment(*f.bumpers());
    for (const fb::Bumper* r : *f.bumpers()) {
      o.bumpers.push_back({from_wire(r->mount()), r->stamp(), r->pressed()});
    }
  }
  if (const auto* g = f.gyro()) o.gyro = {f.gyro_stamp().value_or(o.stamp), g->rate()};
  if (const auto* i = f.inclinometer()) {
    o.inclinometer = {f.inclinometer_stamp().value_or(o.stamp), i->roll(), i->pitch()};
  }
  if (const auto* r = f.floor()) {
    o.floor = {r->stamp(), r->far_left(), r->far_right(), r->near_left(), r->near_right()};
  }
  if (f.line() != nullptr) read_line(*f.line(), o);
  if (const auto* e = f.encoders()) {
    o.encoders = {f.encoders_stamp().value_or(o.stamp), e->left(), e->right()};
  }
  if (const auto* joints = f.joints()) {
    o.joints = {joints->stamp().value_or(o.stamp),
                read_joints(joints->positions()),
                read_joints(joints->rates())};
  }
  if (f.map_pose() != nullptr) read_map_pose(*f.map_pose(), o);
  if (f.channels() == nullptr) return;
  for (const fb::Reading* r : *f.channels()) {
    algo::ChannelReading& reading = o.channels.append();
    reading.channel = r->channel();
    reading.stamp = r->stamp().value_or(o.stamp);
    reading.values.clear();
    if (r->values() == nullptr) continue;
    check_alignment(*r->values());
    reading.values.assign(r->values()->begin(), r->values()->end());
  }
}

std::optional<algo::Tilt> read_tilt(const fb::Tilt* tilt) {
  if (tilt == nullptr) return std::nullopt;
  return algo::Tilt{tilt->z(), tilt->roll(), tilt->pitch()};
}

algo::Name read_name(const flatbuffers::String* text, const char* what) {
  if (text == nullptr) return {};
  if (text->size() > algo::Name::kLongest) {
    throw WireError(std::string("The name of a ") + what + " in the frame is too long.");
  }
  return text->string_view();
}

algo::Command read_command(const fb::Frame& f) {
  algo::Command command{.base = from_wire(*f.command())};
  const auto* rates = f.joint_rates();
  if (rates == nullptr) return command;
  if (rates->size() > algo::kMostJoints) {
    throw WireError("The frame commands more joints than a robot may have.");
  }
  check_alignment(*rates);
  command.joints = static_cast<std::uint8_t>(rates->size());
  std::copy(rates->begin(), rates->end(), command.joint_rates.begin());
  return command;
}

void read_arm(const fb::Frame& f, algo::ArmTelemetry& arm) {
  const fb::Arm* in = f.arm();
  arm.present = in != nullptr;
  arm.hand_goal.reset();
  arm.joint_goal.reset();
  arm.ghost.clear();
  arm.plan_fresh = false;
  if (in == nullptr) return;
  check_enum(in->state(), fb::ArmState_MAX, "state of the arm");
  arm.state = static_cast<algo::ArmState>(in->state());
  arm.own_clearance = in->own_clearance();
  arm.plan = in->plan();
  if (in->clearance() == nullptr || in->clearance()->size() != arm.clearance.size()) {
    throw WireError("The frame does not have the clearance of each link of an arm.");
  }
  check_alignment(*in->clearance());
  std::copy(in->clearance()->begin(), in->clearance()->end(), arm.clearance.begin());
  if (in->hand_goal() != nullptr) arm.hand_goal = read_hand_goal(*in->hand_goal());
  if (in->joint_goal() != nullptr) arm.joint_goal = {read_joints(in->joint_goal())};
  const auto* ghost = in->ghost();
  if (ghost == nullptr) return;
  check_alignment(*ghost);
  constexpr std::size_t kNumbers = std::tuple_size_v<algo::GhostPose>;
  if (ghost->size() % kNumbers != 0) throw WireError("The plan in the frame is not whole.");
  arm.plan_fresh = true;
  for (const float* from = ghost->data(); from != ghost->data() + ghost->size(); from += kNumbers) {
    std::copy(from, from + kNumbers, arm.ghost.append().begin());
  }
}

/// Reads the controller's decision, without layers and measures.
void read_output(const fb::Frame& f, algo::Telemetry& t) {
  t.output.clear();
  t.output.waits = f.decision()->waits();
  t.output.state = f.decision()->state();
  t.output.answered = f.answer() != nullptr;
  if (t.output.answered) t.output.twist = from_wire(*f.answer());
  if (f.answer_joints() != nullptr) t.output.joint_rates = read_joints(f.answer_joints());
  t.layers.clear();
  const fb::News* news = f.news();
  t.words_fresh = news != nullptr && news->what() != nullptr && news->why() != nullptr;
  t.words = {};
  if (t.words_fresh) t.words = {news->what()->str(), news->why()->str()};
  t.legend = f.decision()->legend();
  t.legend_fresh = news != nullptr && news->layers() != nullptr;
  t.scene.fresh = !t.observation.scans.empty();
}

}  // namespace

void decode_frame(std::span<const std::byte> bytes, algo::Telemetry& t) {
  // FlatBuffers reads doubles in place, but a frame inside a message may have any alignment.
  constexpr std::size_t kAlignment = alignof(double);
  if (reinterpret_cast<std::uintptr_t>(bytes.data()) % kAlignment != 0) {
    const std::vector<std::byte> aligned(bytes.begin(), bytes.end());
    decode_frame(aligned, t);
    return;
  }
  const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
  flatbuffers::Verifier verifier(data, bytes.size());
  if (!fb::VerifyFrameBuffer(verifier)) throw WireError("The bytes are not a telemetry frame.");
  const fb::Frame& f = *fb::GetFrame(data);
  if (f.clock() == nullptr || f.odometry() == nullptr || f.command() == nullptr ||
      f.decision() == nullptr) {
    throw WireError("The frame lacks its clock, odometry, command or decision.");
  }
  const fb::Decision& decision = *f.decision();
  check_enum(decision.mission(), fb::Mission_MAX, "mission");

  t.tick = f.clock()->tick();
  t.requests.clear();
  if (f.requests() != nullptr) {
    for (const fb::RequestBox* box : *f.requests()) t.requests.push_back(read_request(*box));
  }
  read_observation(f, t.observation);
  t.ground_truth.reset();
  if (const auto* g = f.truth()) {
    t.ground_truth = {.pose = from_wire(g->pose()),
                      .obstacle_distance = g->obstacle_distance(),
                      .clearance = g->clearance(),
                      .collided = f.collided(),
                      .tilt = read_tilt(f.tilt()),
                      .overturned = f.overturned(),
                      .fallen = f.fallen()};
    if (const auto touched = f.touched()) {
      check_enum(*touched, fb::BodyLink_MAX, "part of a robot");
      t.ground_truth->touched = static_cast<algo::BodyLink>(*touched);
    }
  }
  t.moved.clear();
  if (f.moved() != nullptr) {
    check_alignment(*f.moved());
    for (const fb::Moved* m : *f.moved())
      t.moved.push_back({m->id(), {m->x(), m->y(), m->heading()}});
  }
  t.goal.reset();
  if (const auto* goal = f.goal()) {
    t.goal = algo::SetGoal{from_wire(*goal), std::nullopt};
    if (const auto heading = f.goal_heading()) t.goal->heading = *heading;
  }
  t.goals_ahead.clear();
  if (f.goals_ahead() != nullptr) {
    for (const fb::Vec2f* p : *f.goals_ahead()) t.goals_ahead.push_back({from_wire(*p), {}});
  }
  read_output(f, t);
  read_arm(f, t.arm);
  t.command = read_command(f);
  t.hold = {.name = read_name(f.hold(), "hold")};
  t.limit = {.name = read_name(f.limit(), "limit")};
  t.mission = static_cast<algo::Mission>(decision.mission());
  t.behaviour =
      f.behaviour() == nullptr ? algo::behaviours::kAvoid : read_name(f.behaviour(), "behaviour");
  t.clearance = decision.clearance();
}

}  // namespace server
