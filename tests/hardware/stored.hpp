// tests/hardware/stored.hpp: compares the stored run of the drivers with the emulators' record.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "tests/hardware/bench.hpp"

#include "algo/types.hpp"

namespace server::hardware {

struct StoredScan {
  double stamp = 0;  // [s] run clock
  std::vector<std::uint16_t> beams{};
};
struct StoredCommand {
  double stamp = 0;  // [s] run clock, of its tick
  double omega = 0;  // [rad/s]
};
struct StoredRun {
  std::vector<StoredScan> scans{};
  std::vector<StoredCommand> commands{};
};
/// The newest run of `database`.
StoredRun read_stored(const std::filesystem::path& database);

/// How many of `stored` are among `sent`, in this order; all without an error.
std::size_t found_in_order(const std::vector<StoredScan>& stored,
                           const std::vector<SentLine>& sent);

/// [s] Mean delay from the tick that decides a turn until the base receives it: the shift at which
/// the commands of both records agree best. `track` [m].
double command_delay(const StoredRun& run, const Truth& truth, double track);

}  // namespace server::hardware
