// server/external/external_controller.cpp: asks in each tick, or when the last answer has come.
#include "server/external/external_controller.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "algo/driving.hpp"
#include "algo/explain.hpp"

namespace server::external {

ExternalController::~ExternalController() {
  give_back();
}

void ExternalController::give_back() {
  if (peer_) source_->give_back(std::move(peer_), well_);
}

void ExternalController::reset(const algo::Pose2& start_W) {
  give_back();
  start_W_ = start_W;
  tick_ = 0;
  words_ = {};
  wait_ = 0;
  held_.clear();
  coming_.clear();
}

void ExternalController::update(const algo::ControlInput& in,
                                const algo::Parameters& parameters,
                                algo::ControlOutput& out) {
  out.clear();
  const bool asks = algo::all_finite(in, parameters);
  if (asks && !peer_) take_peer(*in.spec);
  if (asks && think_.kind == ThinkTime::Kind::Pause) ask(in, parameters, out, words_);
  if (asks && think_.kind != ThinkTime::Kind::Pause) ask_later(in, parameters, out);
  ++tick_;
  if (!in.goal) out.clear();
  out.answered = true;
}

void ExternalController::take_peer(const algo::RobotSpec& robot) {
  well_ = false;
  peer_ = source_->take(run_.stop);
  peer_->begin({run_, start_W_, robot, parameters_});
  well_ = true;
}

void ExternalController::ask(const algo::ControlInput& in,
                             const algo::Parameters& parameters,
                             algo::ControlOutput& out,
                             algo::Explanation& words) {
  out.clear();
  words.what.clear();
  words.why.clear();
  well_ = false;
  peer_->answer({tick_, in, parameters}, out, words);
  if (out.joint_rates && !in.spec->arm) {
    throw ControllerError("The controller commands joints, and this robot has no arm.");
  }
  well_ = true;
}

/// While one answer is under way, the controller sees no observation, as on a real robot.
void ExternalController::ask_later(const algo::ControlInput& in,
                                   const algo::Parameters& parameters,
                                   algo::ControlOutput& out) {
  if (wait_ > 0) --wait_;
  if (wait_ == 0) {
    std::swap(held_, coming_);
    std::swap(words_, coming_words_);
    const auto begin = std::chrono::steady_clock::now();
    ask(in, parameters, coming_, coming_words_);
    wait_ = delay(std::chrono::steady_clock::now() - begin, in.spec->period);
    if (wait_ == 0) {
      held_ = coming_;
      words_ = coming_words_;
    }
  }
  out = held_;
}

std::uint32_t ExternalController::delay(std::chrono::duration<double> thought,
                                        double period) const {
  if (think_.kind == ThinkTime::Kind::Fixed) return think_.ticks;
  constexpr double kMost = 1e6;  // ticks
  return period > 0 ? static_cast<std::uint32_t>(std::min(thought.count() / period, kMost)) : 0;
}

void ExternalController::explain(const algo::Telemetry& t, algo::Explanation& words) const {
  words = words_;
  if (words.what.empty()) algo::say_driving(t, words);
}

}  // namespace server::external
