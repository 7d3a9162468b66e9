// server/external/shared_object.cpp: dlopen, and the plain structures of the C interface.
#include "server/external/shared_object.hpp"

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include <dlfcn.h>
#include <fmt/format.h>

#include "server/external/messages.hpp"
#include "server/external/tautline_controller.h"

namespace server::external {

struct SharedObjectSource::Functions {
  void* library = nullptr;
  decltype(&tautline_controller_version) version = nullptr;
  decltype(&tautline_controller_make) make = nullptr;
  decltype(&tautline_controller_reset) reset = nullptr;
  decltype(&tautline_controller_update) update = nullptr;
  decltype(&tautline_controller_free) free = nullptr;

  Functions() = default;
  ~Functions() {
    if (library != nullptr) dlclose(library);
  }
  Functions(const Functions&) = delete;
  Functions& operator=(const Functions&) = delete;
};

namespace {

using Functions = SharedObjectSource::Functions;

tautline_pose to_plain(const algo::Pose2& p) {
  return {p.x, p.y, p.heading};
}

static_assert(algo::kArmJoints == TAUTLINE_JOINTS);

tautline_arm to_plain(const algo::ArmSpec& arm) {
  tautline_arm out{.x = arm.shoulder_R.x(),
                   .y = arm.shoulder_R.y(),
                   .z = arm.shoulder_R.z(),
                   .heading = arm.heading,
                   .upper_arm = arm.upper_arm,
                   .elbow_offset = arm.elbow_offset,
                   .forearm = arm.forearm,
                   .hand = arm.hand,
                   .limits = {},
                   .rates = {},
                   .rest = {}};
  std::ranges::copy(arm.limits, out.limits);
  std::ranges::copy(arm.rates, out.rates);
  std::ranges::copy(arm.rest, out.rest);
  return out;
}

void to_plain(const algo::Recycled<algo::RangeReading>& ring, std::vector<tautline_reading>& out) {
  out.clear();
  for (const algo::RangeReading& r : ring) {
    out.push_back(
        {to_plain(r.mount_R), r.stamp, r.range, r.range_max, static_cast<std::uint8_t>(r.status)});
  }
}

std::string_view text_of(const char* text) {
  return text == nullptr ? std::string_view() : std::string_view(text);
}

/// One controller of the object.
class SharedObjectPeer final : public Peer {
 public:
  SharedObjectPeer(const std::string& name, Texts& texts, const Functions& functions)
      : name_(name), texts_(texts), functions_(functions), self_(functions.make()) {}
  ~SharedObjectPeer() override { functions_.free(self_); }
  SharedObjectPeer(const SharedObjectPeer&) = delete;
  SharedObjectPeer& operator=(const SharedObjectPeer&) = delete;

  void begin(const Begin& begin) override;
  void answer(const Question& question,
              algo::ControlOutput& out,
              algo::Explanation& words) override;

 private:
  tautline_observation observation(const Question& question);
  void read(const tautline_command& command, algo::ControlOutput& out, algo::Explanation& words);

  const std::string& name_;
  Texts& texts_;
  const Functions& functions_;
  void* self_;
  algo::ParameterList parameters_{};
  std::vector<double> values_{};
  std::vector<tautline_reading> sonar_{};
  std::vector<tautline_reading> infrared_{};
};

void SharedObjectPeer::begin(const Begin& begin) {
  parameters_ = begin.parameters;
  std::vector<std::string> names;
  for (const algo::ParameterInfo* each : parameters_) names.emplace_back(each->key());
  std::vector<const char*> pointers;
  names.reserve(parameters_.size());
  pointers.reserve(parameters_.size());
  for (const std::string& each : names) pointers.push_back(each.c_str());
  const algo::RobotSpec& robot = begin.robot;
  const tautline_arm arm = robot.arm ? to_plain(*robot.arm) : tautline_arm{};
  const tautline_run run{.scenario = begin.run.scenario.c_str(),
                         .seed = begin.run.seed,
                         .start = to_plain(begin.start_W),
                         .radius = robot.radius,
                         .half_length = robot.half_length,
                         .half_width = robot.half_width,
                         .half_track = robot.half_track,
                         .period = robot.period,
                         .max_v = robot.max_v,
                         .max_omega = robot.max_omega,
                         .max_acceleration = robot.max_acceleration,
                         .max_angular_acceleration = robot.max_angular_acceleration,
                         .command_delay = robot.command_delay,
                         .has_laser = robot.has_laser ? 1 : 0,
                         .parameter_count = static_cast<std::uint32_t>(pointers.size()),
                         .parameter_names = pointers.data(),
                         .arm = robot.arm ? &arm : nullptr};
  functions_.reset(self_, &run);
}

tautline_observation SharedObjectPeer::observation(const Question& question) {
  const algo::ControlInput& in = question.in;
  const algo::LaserScan& scan = in.scene->scan;
  values_.clear();
  for (const algo::ParameterInfo* each : parameters_) {
    values_.push_back(question.parameters[*each]);
  }
  to_plain(in.observation->sonar, sonar_);
  to_plain(in.observation->infrared, infrared_);
  tautline_observation seen{};
  seen.tick = question.tick;
  seen.stamp = in.stamp;
  seen.pose = to_plain(in.odometry.pose);
  seen.twist = {in.odometry.twist.v, in.odometry.twist.omega};
  if (in.goal) {
    seen.has_goal = 1;
    seen.has_goal_heading = in.goal->heading ? 1 : 0;
    seen.goal = {in.goal->position_W.x(), in.goal->position_W.y(), in.goal->heading.value_or(0)};
  }
  seen.scan_fresh = in.scene->fresh ? 1 : 0;
  seen.scan_stamp = scan.stamp;
  seen.mount = to_plain(scan.mount_R);
  seen.angle_min = scan.angle_min;
  seen.angle_increment = scan.angle_increment;
  seen.range_max = scan.range_max;
  seen.beams = static_cast<std::uint32_t>(scan.size());
  seen.ranges = scan.ranges.data();
  seen.status = reinterpret_cast<const std::uint8_t*>(scan.status.data());
  seen.parameters = values_.data();
  seen.sonar_count = static_cast<std::uint32_t>(sonar_.size());
  seen.infrared_count = static_cast<std::uint32_t>(infrared_.size());
  seen.sonar = sonar_.data();
  seen.infrared = infrared_.data();
  if (const auto& joints = in.observation->joints) {
    seen.joints = joints->position.data();
    seen.joint_rates = joints->rate.data();
  }
  return seen;
}

void SharedObjectPeer::answer(const Question& question,
                              algo::ControlOutput& out,
                              algo::Explanation& words) {
  const tautline_observation seen = observation(question);
  tautline_command command{};
  const int result = functions_.update(self_, &seen, &command);
  const auto fail = [&](const std::string& what) {
    throw ControllerError(
        fmt::format("The controller '{}' failed at tick {}. {}", name_, question.tick, what));
  };
  if (result != 0) fail(fmt::format("It gave up: {}", text_of(command.why)));
  out.twist = {command.twist.v, command.twist.omega};
  if (command.turns_joints != 0)
    std::ranges::copy(command.joint_rates, out.joint_rates.emplace().begin());
  if (command.layer_count > kMostLayers || command.measure_count > kMostMeasures) {
    fail(fmt::format("It may show {} layers and {} measures at most.", kMostLayers, kMostMeasures));
  }
  try {
    check_speeds(out);
    read(command, out, words);
  } catch (const ControllerError& e) {
    fail(e.what());
  }
}

void SharedObjectPeer::read(const tautline_command& command,
                            algo::ControlOutput& out,
                            algo::Explanation& words) {
  out.waits = command.waits != 0;
  out.state = command.state;
  words.what = text_of(command.what).substr(0, kMostLetters);
  words.why = text_of(command.why).substr(0, kMostLetters);
  for (std::uint32_t i = 0; i < command.layer_count; ++i) {
    const tautline_layer& in = command.layers[i];
    if (in.kind > static_cast<std::uint8_t>(algo::LayerKind::Arcs) || in.frame > 1 ||
        in.tone > static_cast<std::uint8_t>(algo::Tone::Good) ||
        in.style > static_cast<std::uint8_t>(algo::LayerStyle::Faint)) {
      throw ControllerError("It showed a layer of an unknown kind, frame, tone or style.");
    }
    algo::Layer& layer =
        add_layer(out.layers,
                  {.name = texts_.keep(text_of(in.name)), .label = texts_.keep(text_of(in.name))});
    layer.kind = static_cast<algo::LayerKind>(in.kind);
    layer.frame = static_cast<algo::LayerFrame>(in.frame);
    layer.tone = static_cast<algo::Tone>(in.tone);
    layer.style = static_cast<algo::LayerStyle>(in.style);
    const std::size_t count = std::min<std::size_t>(in.value_count, kMostValues);
    layer.values.assign(in.values, in.values + count);
  }
  for (std::uint32_t i = 0; i < command.measure_count; ++i) {
    const tautline_measure& in = command.measures[i];
    out.measures.push_back(
        {texts_.keep(text_of(in.name)), texts_.keep(text_of(in.unit)), in.value});
  }
}

template <typename Function>
void find(const Functions& functions, const char* symbol, const std::string& path, Function& out) {
  out = reinterpret_cast<Function>(dlsym(functions.library, symbol));
  if (out == nullptr) {
    throw ControllerError(fmt::format("{} lacks the function {}.", path, symbol));
  }
}

}  // namespace

SharedObjectSource::SharedObjectSource(std::string name, const std::string& path)
    : name_(std::move(name)), functions_(std::make_unique<Functions>()) {
  Functions& f = *functions_;
  f.library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (f.library == nullptr) {
    throw ControllerError(fmt::format("The controller cannot be loaded: {}.", dlerror()));
  }
  find(f, "tautline_controller_version", path, f.version);
  find(f, "tautline_controller_make", path, f.make);
  find(f, "tautline_controller_reset", path, f.reset);
  find(f, "tautline_controller_update", path, f.update);
  find(f, "tautline_controller_free", path, f.free);
  if (const std::uint32_t version = f.version(); version != TAUTLINE_CONTROLLER_VERSION) {
    throw ControllerError(
        fmt::format("{} is of version {} of tautline_controller.h; this program "
                    "needs {}.",
                    path,
                    version,
                    TAUTLINE_CONTROLLER_VERSION));
  }
}

SharedObjectSource::~SharedObjectSource() = default;

std::unique_ptr<Peer> SharedObjectSource::take(const std::stop_token& /*stop*/) {
  return std::make_unique<SharedObjectPeer>(name_, texts_, *functions_);
}

void SharedObjectSource::give_back(std::unique_ptr<Peer> peer, bool /*well*/) {
  peer.reset();
}

}  // namespace server::external
