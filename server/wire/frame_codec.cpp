// server/wire/frame_codec.cpp: one function per part of the frame, in the order of telemetry.fbs.
#include "server/wire/frame_codec.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>

#include "telemetry_generated.h"

#include "algo/explain.hpp"

namespace server {
namespace {

namespace fb = tautline::wire;
using Builder = flatbuffers::FlatBufferBuilder;
template <typename T>
using Offset = flatbuffers::Offset<T>;

fb::Vec2 to_wire(const algo::Vec2& v) {
  return {v.x(), v.y()};
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
fb::Nearest to_wire(const algo::Nearest& n) {
  return {to_float(n.point_W), static_cast<float>(n.distance), n.beam};
}
fb::Vec2f to_wire(const algo::SetGoal& goal) {
  return to_float(goal.position_W);
}
fb::Vec2f to_wire(const algo::Node& n) {
  return to_float(n.position_W);
}

fb::Track to_wire(const algo::Track& track) {
  return {to_float(track.position_W),
          to_float(track.velocity_W),
          static_cast<float>(track.radius),
          static_cast<float>(track.unseen)};
}

fb::Candidate to_wire(const algo::Candidate& c) {
  return {static_cast<float>(c.twist.v),
          static_cast<float>(c.twist.omega),
          static_cast<float>(c.horizon),
          static_cast<float>(c.cost),
          c.allowed,
          c.chosen};
}

algo::Vec2 from_wire(const fb::Vec2& v) {
  return {v.x(), v.y()};
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

Offset<fb::Obstacle> write_obstacle(Builder& b, const algo::Obstacle& o) {
  fb::ShapeKind kind{};
  fb::Vec2 size{};
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
        } else {
          kind = fb::ShapeKind_Wall;
          size = {shape.length, shape.thickness};
        }
      },
      o.shape);
  const auto point_vector =
      points.empty() ? 0 : b.CreateVectorOfStructs(points.data(), points.size());
  const fb::Pose2 pose = to_wire(o.pose_W);
  return fb::CreateObstacle(
      b, o.id, &pose, kind, &size, point_vector, o.height, o.reflectivity, o.specular);
}

/// The library's verifier looks at the length of a vector of structs, not at where its elements
/// lie.
template <typename T>
void check_alignment(const flatbuffers::Vector<const T*>& structs) {
  if (reinterpret_cast<std::uintptr_t>(structs.Data()) % alignof(T) == 0) return;
  throw WireError("A list in the frame does not lie where its elements can be read.");
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

Offset<fb::SetGoal> write_goal(Builder& b, const algo::SetGoal& goal) {
  const fb::Vec2 position = to_wire(goal.position_W);
  return fb::CreateSetGoal(b, &position, goal.heading.value_or(0), goal.heading.has_value());
}

algo::SetGoal read_goal(const fb::SetGoal& goal) {
  if (goal.position() == nullptr) throw WireError("A goal in the frame lacks its position.");
  algo::SetGoal out;
  out.position_W = from_wire(*goal.position());
  if (goal.has_heading()) out.heading = goal.heading();
  return out;
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
  Written operator()(const algo::ClearGoal&) const {
    return {fb::Request_ClearGoal, fb::CreateClearGoal(b).Union()};
  }
  Written operator()(const algo::AddObstacle& r) const {
    return {fb::Request_AddObstacle,
            fb::CreateAddObstacle(b, write_obstacle(b, r.obstacle)).Union()};
  }
  Written operator()(const algo::MoveObstacle& r) const {
    const fb::Pose2 pose = to_wire(r.pose_W);
    return {fb::Request_MoveObstacle, fb::CreateMoveObstacle(b, r.id, &pose).Union()};
  }
  Written operator()(const algo::RemoveObstacle& r) const {
    return {fb::Request_RemoveObstacle, fb::CreateRemoveObstacle(b, r.id).Union()};
  }
  Written operator()(const algo::Joystick& r) const {
    return {fb::Request_Joystick, fb::CreateJoystick(b, r.forward, r.turn).Union()};
  }
  Written operator()(const algo::Stop& r) const {
    return {fb::Request_Stop, fb::CreateStop(b, r.engaged).Union()};
  }
  Written operator()(const algo::SetParameter& r) const {
    const std::string_view name = algo::info(r.parameter).name;
    const auto text = b.CreateString(name.data(), name.size());
    return {fb::Request_SetParameter, fb::CreateSetParameter(b, text, r.value).Union()};
  }
};

algo::SetParameter read_parameter(const fb::SetParameter& r) {
  const std::string name = r.name() == nullptr ? "" : r.name()->str();
  const auto parameter = algo::find_parameter(name);
  if (!parameter) throw WireError("The frame sets an unknown parameter '" + name + "'.");
  return {*parameter, r.value()};
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
    case fb::Request_ClearGoal:
      return algo::ClearGoal{};
    case fb::Request_AddObstacle:
      return algo::AddObstacle{read_obstacle(box.request_as_AddObstacle()->obstacle())};
    case fb::Request_MoveObstacle: {
      const auto* move = box.request_as_MoveObstacle();
      if (move->pose() == nullptr) throw WireError("A move in the frame lacks its pose.");
      return algo::MoveObstacle{move->id(), from_wire(*move->pose())};
    }
    case fb::Request_RemoveObstacle:
      return algo::RemoveObstacle{box.request_as_RemoveObstacle()->id()};
    case fb::Request_Joystick: {
      const auto* stick = box.request_as_Joystick();
      return algo::Joystick{stick->forward(), stick->turn()};
    }
    case fb::Request_Stop:
      return algo::Stop{box.request_as_Stop()->engaged()};
    case fb::Request_SetParameter:
      return read_parameter(*box.request_as_SetParameter());
    default:
      throw WireError("The frame has a request of an unknown kind.");
  }
}

Offset<fb::LaserScan> write_scan(Builder& b, const algo::LaserScan& scan) {
  std::uint16_t* samples = nullptr;
  const auto ranges = b.CreateUninitializedVector(scan.size(), &samples);
  algo::beams_to_wire(scan, {samples, scan.size()});
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
    algo::beam_from_wire(scan, i, in.ranges()->Get(static_cast<flatbuffers::uoffset_t>(i)));
  }
}

template <typename Wire, typename List>
Offset<flatbuffers::Vector<const Wire*>> write_structs(Builder& b, const List& list) {
  if (list.empty()) return 0;
  // Not CreateUninitializedVectorOfStructs(), which takes a struct's size for its alignment.
  return b.CreateVectorOfStructs<Wire>(list.size(),
                                       [&](std::size_t i, Wire* out) { *out = to_wire(list[i]); });
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

Offset<flatbuffers::Vector<const fb::Vec2f*>> write_path(Builder& b,
                                                         const algo::Recycled<algo::Vec2>& path) {
  if (path.empty()) return 0;
  fb::Vec2f* out = nullptr;
  const auto vector = b.CreateUninitializedVectorOfStructs(path.size(), &out);
  for (const algo::Vec2& p : path) *out++ = to_float(p);
  return vector;
}

Offset<fb::Grid> write_grid(Builder& b, const algo::GridLayer& grid) {
  if (grid.cells.empty()) return 0;
  const auto cells = b.CreateVector(grid.cells);
  const fb::Vec2f corner = to_float(grid.corner_W);
  return fb::CreateGrid(b, &corner, static_cast<float>(grid.cell), grid.columns, cells);
}

template <typename T>
void check_enum(T value, T max, const char* what) {
  if (value > max) throw WireError(std::string("The frame has an unknown ") + what + ".");
}

void read_observation(const fb::Frame& f, algo::Observation& o) {
  o.clear_sensors();
  o.stamp = f.stamp();
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
  if (const auto* e = f.encoders()) {
    o.encoders = {f.encoders_stamp().value_or(o.stamp), e->left(), e->right()};
  }
}

std::optional<algo::Nearest> read_nearest(const fb::Nearest* n) {
  if (n == nullptr) return std::nullopt;
  return algo::Nearest{n->beam(), from_wire(n->point()), n->distance()};
}

void read_grid(const fb::Grid& wire, algo::GridLayer& grid) {
  if (wire.corner() == nullptr || wire.cells() == nullptr || wire.columns() == 0 ||
      wire.cells()->size() % wire.columns() != 0) {
    throw WireError("The grid in the frame lacks a corner or a part of a row.");
  }
  grid.corner_W = from_wire(*wire.corner());
  grid.cell = wire.cell();
  grid.columns = wire.columns();
  grid.rows = wire.cells()->size() / wire.columns();
  grid.cells.assign(wire.cells()->begin(), wire.cells()->end());
}

/// What a controller without a strip weighed.
void read_weighing(const fb::Frame& f, algo::ControlOutput& out) {
  if (f.plan() != nullptr) {
    check_alignment(*f.plan());
    for (const fb::Vec2f* p : *f.plan()) out.plan_W.push_back(from_wire(*p));
  }
  if (f.candidates() != nullptr) {
    check_alignment(*f.candidates());
    for (const fb::Candidate* c : *f.candidates()) {
      out.candidates.push_back(
          {{c->v(), c->omega()}, c->horizon(), c->cost(), c->allowed(), c->chosen()});
    }
  }
  if (f.histogram() != nullptr) {
    out.histogram.assign(f.histogram()->begin(), f.histogram()->end());
  }
  out.histogram_threshold = f.histogram_threshold();
  if (f.grid() != nullptr) read_grid(*f.grid(), out.grid);
  if (f.tracks() != nullptr) {
    check_alignment(*f.tracks());
    for (const fb::Track* k : *f.tracks()) {
      out.tracks.push_back(
          {from_wire(k->position()), from_wire(k->velocity()), k->radius(), 0, k->unseen()});
    }
  }
}

void read_output(const fb::Frame& f, algo::Telemetry& t) {
  algo::ControlOutput& out = t.output;
  out = {};
  if (f.strip() != nullptr) {
    check_alignment(*f.strip());
    for (const fb::Vec2f* p : *f.strip()) out.strip.push_back({from_wire(*p), {0, 0}, {0, 0}});
  }
  if (const auto* forces = f.forces()) {
    out.internal_W = from_wire(forces->internal());
    out.external_left_W = from_wire(forces->external_left());
    out.external_right_W = from_wire(forces->external_right());
    out.elastic_W = out.internal_W + out.external_left_W + out.external_right_W;
    if (const auto* push = f.side_push()) out.elastic_W += from_wire(*push);
  }
  if (out.strip.size() > 1) {
    algo::Node& pass = out.strip[1];
    out.pass_W = pass.position_W;
    pass.internal_W = out.internal_W;
    pass.external_W = out.elastic_W - out.internal_W;
  }
  const std::int8_t side = f.decision()->side();
  out.side = static_cast<algo::Side>(side > 0 ? 1 : (side < 0 ? -1 : 0));
  out.side_since = f.side_since();
  read_weighing(f, out);
  t.scene.fresh = !t.observation.scans.empty();
  t.scene.left = read_nearest(f.left());
  t.scene.right = read_nearest(f.right());
}

struct FrameWriter {
  fb::FrameBuilder frame;
  const algo::Telemetry& t;

  void sensors();
  void decision();
  void stamps();
};

// Structs live inside the table: the locals only have to outlive their add_ call.
void FrameWriter::sensors() {
  const algo::Observation& o = t.observation;
  const fb::Odometry odometry(to_wire(o.odometry.pose), to_wire(o.odometry.twist));
  frame.add_odometry(&odometry);
  if (o.gyro) {
    const fb::YawGyro gyro(o.gyro->rate);
    frame.add_gyro(&gyro);
  }
  if (o.inclinometer) {
    const fb::Inclinometer inclinometer(o.inclinometer->roll, o.inclinometer->pitch);
    frame.add_inclinometer(&inclinometer);
  }
  if (o.encoders) {
    const fb::Encoders encoders(o.encoders->left, o.encoders->right);
    frame.add_encoders(&encoders);
  }
  if (t.ground_truth) {
    const algo::GroundTruth& g = *t.ground_truth;
    const fb::GroundTruth truth(
        to_float(g.pose), static_cast<float>(g.obstacle_distance), static_cast<float>(g.clearance));
    frame.add_truth(&truth);
    frame.add_collided(g.collided);
  }
}

void FrameWriter::decision() {
  const algo::ControlOutput& out = t.output;
  const fb::Twist2 command = to_wire(t.command.base);
  frame.add_command(&command);
  const fb::Decision decision(static_cast<float>(t.clearance),
                              static_cast<fb::Hold>(t.hold),
                              static_cast<fb::Mission>(t.mission),
                              static_cast<fb::Behaviour>(t.behaviour),
                              static_cast<std::int8_t>(out.side));
  frame.add_decision(&decision);
  frame.add_halt(static_cast<fb::Halt>(t.observation.halt));
  if (t.goal) {
    const fb::Vec2f goal = to_float(t.goal->position_W);
    frame.add_goal(&goal);
    if (t.goal->heading) frame.add_goal_heading(static_cast<float>(*t.goal->heading));
  }
  if (!out.strip.empty()) {
    const fb::Forces forces(
        to_float(out.internal_W), to_float(out.external_left_W), to_float(out.external_right_W));
    frame.add_forces(&forces);
    const algo::Vec2 push =
        out.elastic_W - out.internal_W - out.external_left_W - out.external_right_W;
    const fb::Vec2f side_push = to_float(push);
    if (push != algo::Vec2{0, 0}) frame.add_side_push(&side_push);
  }
  if (out.side != algo::Side::None) frame.add_side_since(out.side_since);
  if (t.scene.left) {
    const fb::Nearest left = to_wire(*t.scene.left);
    frame.add_left(&left);
  }
  if (t.scene.right) {
    const fb::Nearest right = to_wire(*t.scene.right);
    frame.add_right(&right);
  }
  if (t.hold == algo::Hold::StaleScan && t.scene.scan.size() > 0) {
    frame.add_newest_scan(t.scene.scan.stamp);
  }
}

/// Only those that are not the frame's own.
void FrameWriter::stamps() {
  const algo::Observation& o = t.observation;
  if (o.odometry.stamp != o.stamp) frame.add_odometry_stamp(o.odometry.stamp);
  if (o.encoders && o.encoders->stamp != o.stamp) frame.add_encoders_stamp(o.encoders->stamp);
  if (o.gyro && o.gyro->stamp != o.stamp) frame.add_gyro_stamp(o.gyro->stamp);
  if (o.inclinometer && o.inclinometer->stamp != o.stamp) {
    frame.add_inclinometer_stamp(o.inclinometer->stamp);
  }
}

/// Beams in 180 degrees, 0 where they do not go ccw or do not tell.
std::uint32_t half_turn(const fb::LaserScan& scan) {
  constexpr double kFinest = 1e-4;  // [rad]
  if (!(scan.angle_increment() >= kFinest)) return 0;
  return static_cast<std::uint32_t>(std::lround(std::numbers::pi / scan.angle_increment()));
}

}  // namespace

std::span<const std::byte> FrameEncoder::encode(const algo::Telemetry& t) {
  Builder& b = builder_;
  b.Clear();
  const algo::Observation& o = t.observation;

  // Tables and vectors first: FlatBuffers writes from the leaves to the root.
  scans_.clear();
  for (const algo::LaserScan& scan : o.scans) scans_.push_back(write_scan(b, scan));
  const auto scans = scans_.empty() ? 0 : b.CreateVector(scans_);
  const auto sonar = write_structs<fb::RangeReading>(b, o.sonar);
  const auto infrared = write_structs<fb::RangeReading>(b, o.infrared);
  const auto bumpers = write_structs<fb::Bumper>(b, o.bumpers);
  const auto requests = write_requests(b, t.requests);
  const auto strip = write_structs<fb::Vec2f>(b, t.output.strip);
  const auto goals_ahead = write_structs<fb::Vec2f>(b, t.goals_ahead);
  const auto plan = write_path(b, t.output.plan_W);
  const auto candidates = write_structs<fb::Candidate>(b, t.output.candidates);
  const auto histogram = t.output.histogram.empty() ? 0 : b.CreateVector(t.output.histogram);
  const auto grid = write_grid(b, t.output.grid);
  const auto tracks = write_structs<fb::Track>(b, t.output.tracks);
  const bool own_words =
      t.output.manner != algo::Manner::None && t.behaviour == algo::BehaviourId::Avoid;
  const algo::Explanation words = own_words ? algo::explain(t) : algo::Explanation{};
  const auto what = own_words ? b.CreateString(words.what) : 0;
  const auto why = own_words ? b.CreateString(words.why) : 0;

  FrameWriter writer{fb::FrameBuilder(b), t};
  fb::FrameBuilder& frame = writer.frame;
  frame.add_tick(t.tick);
  frame.add_stamp(o.stamp);
  if (!o.scans.empty()) frame.add_scans(scans);
  if (!o.sonar.empty()) frame.add_sonar(sonar);
  if (!o.infrared.empty()) frame.add_infrared(infrared);
  if (!o.bumpers.empty()) frame.add_bumpers(bumpers);
  if (!t.requests.empty()) frame.add_requests(requests);
  if (!t.output.strip.empty()) frame.add_strip(strip);
  writer.sensors();
  writer.decision();
  writer.stamps();
  if (own_words) {
    frame.add_what(what);
    frame.add_why(why);
  }
  if (!t.goals_ahead.empty()) frame.add_goals_ahead(goals_ahead);
  if (!t.output.plan_W.empty()) frame.add_plan(plan);
  if (!t.output.candidates.empty()) frame.add_candidates(candidates);
  if (!t.output.histogram.empty()) {
    frame.add_histogram(histogram);
    frame.add_histogram_threshold(static_cast<float>(t.output.histogram_threshold));
  }
  if (!t.output.grid.cells.empty()) frame.add_grid(grid);
  if (!t.output.tracks.empty()) frame.add_tracks(tracks);
  b.Finish(frame.Finish());

  find_windows();
  return std::as_bytes(std::span(b.GetBufferPointer(), b.GetSize()));
}

void FrameEncoder::find_windows() {
  const std::uint8_t* bytes = builder_.GetBufferPointer();
  const fb::Frame* frame = fb::GetFrame(bytes);
  windows_.clear();
  const auto add = [&](const std::uint8_t* data,
                       std::uint32_t count,
                       db::Window::Kind kind,
                       std::uint32_t stride,
                       std::uint32_t per_half_turn) {
    windows_.push_back(
        {static_cast<std::uint32_t>(data - bytes), count, kind, stride, per_half_turn});
  };
  if (const auto* scans = frame->scans()) {
    for (const fb::LaserScan* scan : *scans) {
      add(scan->ranges()->Data(),
          scan->ranges()->size(),
          db::Window::Kind::Samples,
          1,
          half_turn(*scan));
    }
  }
  if (const auto* strip = frame->strip()) {
    constexpr auto kFloats = static_cast<std::uint32_t>(sizeof(fb::Vec2f) / sizeof(float));
    add(strip->Data(), strip->size() * kFloats, db::Window::Kind::Floats, kFloats, 0);
  }
  std::sort(windows_.begin(), windows_.end(), [](const auto& a, const auto& c) {
    return a.offset < c.offset;
  });
}

void decode_frame(std::span<const std::byte> bytes, algo::Telemetry& t) {
  // FlatBuffers reads doubles in place; a frame from the middle of a message may lie anywhere.
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
  if (f.odometry() == nullptr || f.command() == nullptr || f.decision() == nullptr) {
    throw WireError("The frame lacks its odometry, command or decision.");
  }
  const fb::Decision& decision = *f.decision();
  check_enum(decision.hold(), fb::Hold_MAX, "hold");
  check_enum(decision.mission(), fb::Mission_MAX, "mission");
  check_enum(decision.behaviour(), fb::Behaviour_MAX, "behaviour");

  t.tick = f.tick();
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
                      .collided = f.collided()};
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
  t.command = {from_wire(*f.command())};
  t.hold = static_cast<algo::Hold>(decision.hold());
  t.mission = static_cast<algo::Mission>(decision.mission());
  t.behaviour = static_cast<algo::BehaviourId>(decision.behaviour());
  t.clearance = decision.clearance();
}

}  // namespace server
