// server/serve/path_trail.cpp: adds and thins poses, and keeps their text.
#include "server/serve/path_trail.hpp"

#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "server/serve/scene_json.hpp"

namespace server {

void PathTrail::add(const algo::Pose2& pose_W) {
  const bool known = std::isfinite(pose_W.x + pose_W.y + pose_W.heading);  // as JSON needs
  if (!known) return;
  if (!poses_.empty() && (pose_W.position() - poses_.back().position()).norm() <= spacing_) return;
  if (poses_.size() == kMost) thin();
  poses_.push_back(pose_W);
  write(pose_W);
  ++changes_;
}

void PathTrail::thin() {
  for (std::size_t i = 0; 2 * i < poses_.size(); ++i) poses_[i] = poses_[2 * i];
  poses_.resize((poses_.size() + 1) / 2);
  spacing_ *= 2;
  text_.clear();
  for (const algo::Pose2& pose : poses_) write(pose);
}

void PathTrail::write(const algo::Pose2& pose) {
  if (!text_.empty()) text_ += ',';
  fmt::format_to(std::back_inserter(text_),
                 R"({{"position":{{"x":{},"y":{},"z":0}},)"
                 R"("orientation":{{"x":0,"y":0,"z":{},"w":{}}}}})",
                 pose.x,
                 pose.y,
                 std::sin(pose.heading / 2),
                 std::cos(pose.heading / 2));
}

std::string PathTrail::message(double stamp) const {
  std::string out = R"({"frame_id":"map","poses":[)";
  out.reserve(text_.size() + 128);
  out.append(text_).append(R"(],"timestamp":)").append(time_text(stamp)).append("}");
  return out;
}

}  // namespace server
