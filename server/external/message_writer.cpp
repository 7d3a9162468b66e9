// server/external/message_writer.cpp: one function per message.
#include "controller_generated.h"

#include "server/external/messages.hpp"

namespace server::external {
namespace {

namespace fb = tautline::external;
using Builder = flatbuffers::FlatBufferBuilder;
template <typename T>
using Offset = flatbuffers::Offset<T>;

fb::Pose2 to_wire(const algo::Pose2& p) {
  return {p.x, p.y, p.heading};
}
fb::Twist2 to_wire(const algo::Twist2& t) {
  return {t.v, t.omega};
}
fb::RangeReading to_wire(const algo::RangeReading& r) {
  return {to_wire(r.mount_R), r.stamp, r.range, r.range_max, static_cast<fb::BeamStatus>(r.status)};
}

Offset<flatbuffers::String> write_text(Builder& b, std::string_view text) {
  return b.CreateString(text.data(), text.size());
}

Offset<flatbuffers::Vector<double>> write_joints(Builder& b, const algo::JointValues& values) {
  return b.CreateVector(values.data(), values.size());
}

Offset<fb::Arm> write_arm(Builder& b, const std::optional<algo::ArmSpec>& arm) {
  if (!arm) return 0;
  const algo::Vec3& at = arm->shoulder_R;
  const fb::Place shoulder(at.x(), at.y(), at.z(), arm->heading);
  const auto limits = write_joints(b, arm->limits);
  const auto rates = write_joints(b, arm->rates);
  const auto rest = write_joints(b, arm->rest);
  return fb::CreateArm(b,
                       &shoulder,
                       arm->upper_arm,
                       arm->elbow_offset,
                       arm->forearm,
                       arm->hand,
                       limits,
                       rates,
                       rest);
}

Offset<fb::Robot> write_robot(Builder& b, const algo::RobotSpec& robot) {
  const auto name = write_text(b, robot.name);
  const auto arm = write_arm(b, robot.arm);
  return fb::CreateRobot(b,
                         name,
                         robot.radius,
                         robot.half_length,
                         robot.half_width,
                         robot.half_track,
                         robot.period,
                         robot.max_v,
                         robot.max_omega,
                         robot.max_acceleration,
                         robot.max_angular_acceleration,
                         robot.command_delay,
                         robot.has_laser,
                         arm);
}

Offset<flatbuffers::Vector<const fb::RangeReading*>> write_ring(
    Builder& b, const algo::Recycled<algo::RangeReading>& ring) {
  if (ring.empty()) return 0;
  return b.CreateVectorOfStructs<fb::RangeReading>(
      ring.size(), [&](std::size_t i, fb::RangeReading* out) { *out = to_wire(ring[i]); });
}

MessageWriter::Bytes finished(Builder& b, fb::Body type, Offset<void> body) {
  fb::FinishSizePrefixedMessageBuffer(b, fb::CreateMessage(b, type, body));
  return std::as_bytes(std::span(b.GetBufferPointer(), b.GetSize()));
}

}  // namespace

MessageWriter::Bytes MessageWriter::welcome(std::string_view controller) {
  builder_.Clear();
  const auto name = write_text(builder_, controller);
  const auto program = write_text(builder_, "Tautline");
  const auto body = fb::CreateWelcome(builder_, kProtocol, name, program);
  return finished(builder_, fb::Body_Welcome, body.Union());
}

MessageWriter::Bytes MessageWriter::begin(const Begin& run) {
  builder_.Clear();
  std::vector<Offset<flatbuffers::String>> names;
  for (const algo::ParameterInfo* each : run.parameters) {
    names.push_back(write_text(builder_, each->key()));
  }
  const fb::Pose2 start = to_wire(run.start_W);
  const auto scenario = write_text(builder_, run.run.scenario);
  const auto robot = write_robot(builder_, run.robot);
  const auto parameters = builder_.CreateVector(names);
  const auto body = fb::CreateReset(builder_, scenario, run.run.seed, &start, robot, parameters);
  return finished(builder_, fb::Body_Reset, body.Union());
}

MessageWriter::Bytes MessageWriter::question(const Question& question,
                                             algo::ParameterList parameters) {
  Builder& b = builder_;
  b.Clear();
  const algo::ControlInput& in = question.in;
  const algo::LaserScan& scan = in.scene->scan;
  values_.clear();
  for (const algo::ParameterInfo* each : parameters) {
    values_.push_back(question.parameters[*each]);
  }
  const auto ranges = b.CreateVector(scan.ranges);
  const auto status =
      b.CreateVector(reinterpret_cast<const std::uint8_t*>(scan.status.data()), scan.size());
  const auto values = b.CreateVector(values_);
  const auto sonar = write_ring(b, in.observation->sonar);
  const auto infrared = write_ring(b, in.observation->infrared);
  const auto& joints = in.observation->joints;
  const auto positions = joints ? write_joints(b, joints->position) : 0;
  const auto turns = joints ? write_joints(b, joints->rate) : 0;
  const fb::Now now(question.tick, in.stamp, to_wire(in.odometry.pose), to_wire(in.odometry.twist));
  const fb::ScanShape shape(scan.stamp,
                            to_wire(scan.mount_R),
                            scan.angle_min,
                            scan.angle_increment,
                            scan.range_max,
                            in.scene->fresh);
  fb::ObservationBuilder body(b);
  body.add_now(&now);
  if (in.goal) {
    const fb::Goal goal(in.goal->position_W.x(),
                        in.goal->position_W.y(),
                        in.goal->heading.value_or(0),
                        in.goal->heading.has_value());
    body.add_goal(&goal);
  }
  body.add_scan(&shape);
  body.add_ranges(ranges);
  body.add_status(status.o);
  body.add_parameters(values);
  body.add_sonar(sonar);
  body.add_infrared(infrared);
  body.add_joints(positions);
  body.add_joint_rates(turns);
  return finished(b, fb::Body_Observation, body.Finish().Union());
}

MessageWriter::Bytes MessageWriter::end(std::string_view reason) {
  builder_.Clear();
  const auto body = fb::CreateEnd(builder_, write_text(builder_, reason));
  return finished(builder_, fb::Body_End, body.Union());
}

}  // namespace server::external
