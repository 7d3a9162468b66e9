// tests/hardware/trial.cpp: long trials of the drivers against emulated devices, in real time; each
// prints a table and ends with status 1 when a limit did not hold.
//
//   hardware_trial experiments FOLDER [exp1-roboteq]   against pure simulation
//   hardware_trial soak FOLDER SECONDS                 1 % of telegrams damaged
#include <string>

#include "tests/hardware/trials.hpp"
#include <fmt/format.h>

namespace server::hardware {
namespace {

int main_of(int argc, char** argv) {
  const std::string what = argc > 2 ? argv[1] : "";
  const std::string more = argc > 3 ? argv[3] : "";
  if (what == "experiments") return experiments(argv[2], more) ? 0 : 1;
  if (what == "soak" && !more.empty()) return soak(argv[2], std::stod(more)) ? 0 : 1;
  fmt::print(stderr,
             "hardware_trial experiments FOLDER [exp1-roboteq]\n"
             "hardware_trial soak FOLDER SECONDS\n");
  return 1;
}

}  // namespace
}  // namespace server::hardware

int main(int argc, char** argv) {
  try {
    return server::hardware::main_of(argc, argv);
  } catch (const std::exception& e) {
    fmt::print(stderr, "hardware_trial: {}\n", e.what());
    return 1;
  }
}
