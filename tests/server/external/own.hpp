// tests/server/external/own.hpp: runs with a controller outside the program.
#pragma once

#include <memory>
#include <string>

#include "tests/folders.hpp"

#include "server/external/registration.hpp"
#include "server/record/headless.hpp"
#include "server/run/scenario_library.hpp"

namespace server::external {

/// The command that starts a script of this folder with docs/examples/tautline.py.
inline std::string python(const std::string& script) {
  const std::string examples = (tests::folder().parent_path() / "docs" / "examples").string();
  return "PYTHONPATH=" + examples + " python3 -B " +
         (tests::folder() / "server" / "external" / script).string();
}
inline std::string example(const std::string& script) {
  return "python3 -B " + (tests::folder().parent_path() / "docs" / "examples" / script).string();
}

inline std::shared_ptr<const algo::ControllerCatalogue> catalogue_of(Registration own) {
  return std::make_shared<const algo::ControllerCatalogue>(catalogue_with({std::move(own)}));
}

/// `scenario`, kinematic, driven by the controller "mine" of `catalogue`.
inline RunSpec spec_of(std::shared_ptr<const algo::ControllerCatalogue> catalogue,
                       const std::string& scenario = "case3",
                       std::uint64_t seed = 1) {
  RunOverrides overrides;
  overrides.controller = "mine";
  overrides.controllers = std::move(catalogue);
  overrides.physics = sim::PhysicsKind::Kinematic;
  overrides.seed = seed;
  return make_spec(ScenarioLibrary({}, {}).load(scenario), overrides);
}

inline HeadlessResult drive(const RunSpec& spec, const std::stop_token& stop = {}) {
  const auto robot = make_robot(spec);
  HeadlessOptions options;
  options.hash_frames = true;
  return run_headless(spec, *robot, options, stop);
}

}  // namespace server::external
