// server/lab/reproduce/reach_world.hpp: random worlds in which a hand shall get to a pose among
// things.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "algo/arm/mobile_arm.hpp"

namespace server::reproduce {

enum class ReachScene : std::uint8_t { Table, Shelf, Posts, Beam };
inline constexpr std::array kReachScenes{
    ReachScene::Table, ReachScene::Shelf, ReachScene::Posts, ReachScene::Beam};
std::string_view words(ReachScene scene);

/// The robot starts at the origin with its arm folded.
struct ReachWorld {
  std::vector<algo::Solid> solids{};
  algo::Pose3 hand_W = algo::Pose3::Identity();  // its goal, 3 to 4 m ahead
};
/// The scene, turned at random, and two posts on the way to it. The same for the same seed.
ReachWorld random_world(ReachScene scene, std::uint64_t seed);

}  // namespace server::reproduce
