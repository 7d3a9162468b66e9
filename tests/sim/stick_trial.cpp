// tests/sim/stick_trial.cpp: the random stick for any time; run by hand:
// stick_trial [SECONDS a row [FIRST SEED [WORLDS]]].
#include <cstdio>
#include <cstdlib>

#include "tests/sim/stick_drive.hpp"

#include "server/lab/soak/random_world.hpp"
#include "server/run/robot_library.hpp"

namespace {

struct Row {
  double seconds = 1000;
  std::uint64_t seed = 1;
  int worlds = 40;
};

/// `seconds` in all of kWorlds and in as many random rooms.
int row(const char* robot, sim::PhysicsKind physics, const Row& about) {
  stick::Outcome sum;
  const auto take = [&](const std::string& name,
                        const sim::Scenario& scenario,
                        std::uint64_t seed,
                        double seconds) {
    const stick::Outcome one = stick::drive(scenario, seed, seconds, stick::RandomStick(seed));
    sum.contacts += one.contacts;
    sum.driven += one.driven;
    sum.backed += one.backed;
    sum.least = std::min(sum.least, one.least);
    sum.fastest_back = std::max(sum.fastest_back, one.fastest_back);
    for (const std::string& where : one.where) {
      std::printf("  %s seed %llu: %s\n",
                  name.c_str(),
                  static_cast<unsigned long long>(seed),
                  where.c_str());
    }
  };
  const double each = about.seconds / stick::kWorlds.size();
  std::uint64_t seed = about.seed;
  for (const char* name : stick::kWorlds)
    take(name, stick::world(name, robot, physics), seed++, each);
  const int in_worlds = sum.contacts;
  for (int k = 0; k < about.worlds; ++k) {
    sim::Scenario scenario =
        server::soak::random_world(about.seed + static_cast<unsigned>(k), "strip");
    scenario.robot = server::builtin_robot(robot);
    scenario.physics = physics;
    take(scenario.name,
         scenario,
         about.seed + static_cast<unsigned>(k),
         about.seconds / about.worlds);
  }
  std::printf(
      "%-10s %-9s: %.0f s in the four worlds: %d contacts, as many in random rooms: %d; "
      "%.0f m driven, %.0f m of it back, at most %.2f m/s back, least clearance %.3f m\n",
      robot,
      physics == sim::PhysicsKind::Bullet ? "bullet" : "kinematic",
      about.seconds,
      in_worlds,
      sum.contacts - in_worlds,
      sum.driven,
      sum.backed,
      sum.fastest_back,
      sum.least);
  return sum.contacts;
}

}  // namespace

int main(int argc, char** argv) {
  Row about;
  if (argc > 1) about.seconds = std::atof(argv[1]);
  if (argc > 2) about.seed = static_cast<std::uint64_t>(std::atoll(argv[2]));
  if (argc > 3) about.worlds = std::atoi(argv[3]);
  int contacts = 0;
  for (const char* robot : {"silvermate", "jackal"}) {
    for (const sim::PhysicsKind physics : {sim::PhysicsKind::Kinematic, sim::PhysicsKind::Bullet}) {
      contacts += row(robot, physics, about);
    }
  }
  return contacts == 0 ? 0 : 3;
}
