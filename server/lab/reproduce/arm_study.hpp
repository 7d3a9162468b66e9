// server/lab/reproduce/arm_study.hpp: an arm carried past posts: what the elastic strip of arm and
// base clears, with the forces as the sibling thesis prints them and with ours. And a hand brought
// to a pose among things.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "algo/arm/body_follower.hpp"
#include "server/lab/reproduce/reach_study.hpp"

namespace server::reproduce {

/// The readings of the external force, in the order of every row.
struct ArmReading {
  std::string_view name{};
  std::string_view words{};
  algo::BodyStripGains gains{};
};
std::vector<ArmReading> arm_readings();

/// A strip of 21 configurations over a straight base path of 4 m, bent by a post half way.
struct BentStrip {
  std::string place{};  // of the post: "hand"
  std::string reading{};
  double before = 0;    // [m] least clearance of the straight strip,
  double after = 0;     // and of the bent one, also between its configurations
  double at_nodes = 0;  // [m] the same at the configurations alone
  double along = 0;     // [m] largest shift of the base along its path,
  double across = 0;    // and across it
  double hand = 0;      // [m] largest way of the hand from its straight path
  double returned = 0;  // [m, rad] largest entry off the straight strip once the post is gone
  int sweeps = 0;       // until the strip rested
};

/// A drive of the same way while things stand or move.
struct ArmDrive {
  std::string course{};
  std::string reading{};
  bool arrived = false;
  double seconds = 0;
  double clearance = 0;  // [m] least of all links; below 0: a contact
  double across = 0;     // [m] largest shift of the base across its path
  double hand = 0;       // [m] largest way of the hand from its straight path
  double waits = 0;      // [s]
};

/// Drives past one to three posts and beams at random.
struct ArmTrials {
  std::string kind{};
  std::string reading{};
  std::size_t drives = 0;
  std::size_t arrived = 0;
  std::size_t touched = 0;
  std::size_t near = 0;  // nearer than the margin, without a contact
  double clearance = 0;  // [m] least of all
};

struct ArmFinding {
  std::string claim{};
  std::string figures{};
  bool holds = false;
};

struct ArmStudy {
  std::vector<BentStrip> strips{};
  std::vector<ArmDrive> drives{};
  std::vector<ArmTrials> trials{};
  ReachStudy reach{};
  std::vector<ArmFinding> findings{};
  // For the picture: the strips of a post before the forearm.
  std::array<std::vector<algo::BodyFrames>, 2> pictured{};  // as printed, ours
};

/// The same study each time, bit for bit. `drives`: random ones of each kind; `worlds`: of each
/// scene in which the hand shall get to a pose.
ArmStudy study_arm(std::size_t drives = 100, std::size_t worlds = 50);

bool all_hold(const ArmStudy& study);
std::string to_text(const ArmStudy& study);
nlohmann::json to_json(const ArmStudy& study);
std::string to_markdown(const ArmStudy& study, const std::string& pictures);
constexpr std::string_view kArmPicture = "arm-post.svg";
/// Both strips from above.
std::string draw(const ArmStudy& study);
/// The picture beside `file`, and the section in it.
void write_markdown(const ArmStudy& study, const std::filesystem::path& file);

}  // namespace server::reproduce
