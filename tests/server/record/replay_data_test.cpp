// tests/server/record/replay_data_test.cpp: a real log through pipeline and database: every scan
// equals the text of the log to the millimetre, with the device's codes masked.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "tests/folders.hpp"
#include <gtest/gtest.h>

#include "db/run_reader.hpp"
#include "server/record/frame_codec.hpp"
#include "server/record/headless.hpp"
#include "server/record/run_json.hpp"
#include "server/record/verify.hpp"
#include "server/run/scenario_library.hpp"

namespace server {
namespace {

namespace fs = std::filesystem;

/// The readings of every FLASER line, parsed independently.
std::vector<std::vector<double>> read_log(const fs::path& path) {
  std::vector<std::vector<double>> scans;
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string name;
    std::size_t beams = 0;
    words >> name;
    if (name != "FLASER") continue;
    words >> beams;
    std::vector<double>& scan = scans.emplace_back(beams);
    for (double& reading : scan) words >> reading;
  }
  return scans;
}

TEST(ReplayData, FreiburgGoesThroughPipelineAndDatabaseUnchanged) {
  const fs::path log = tests::shared_data() / "laser/freiburg-079-first2000.log";
  const auto expected = read_log(log);
  ASSERT_EQ(expected.size(), 2000u);
  const fs::path folder = fs::temp_directory_path() / "tautline_replay_data_test";
  fs::remove_all(folder);
  fs::create_directories(folder);
  const std::string database = (folder / "runs.db").string();

  db::RunId run = 0;
  {
    Recorder recorder(database, recorder_options());
    const RunSpec spec = make_spec(ScenarioLibrary::from_file(log), {});
    const auto robot = make_robot(spec);
    HeadlessOptions options;
    options.record = recorder.open(new_run(spec, robot->spec()));
    run = options.record->run();
    const HeadlessResult result = run_headless(spec, *robot, options, {});
    EXPECT_EQ(result.run.outcome, algo::Outcome::EndOfLog) << result.run.reason;
    EXPECT_EQ(result.run.lost_ticks, 0u);
    recorder.flush();
  }

  db::RunReader reader(database);
  algo::Telemetry t;
  std::size_t scans = 0;
  std::size_t beams = 0;
  std::size_t masked = 0;
  std::size_t wrong = 0;
  std::optional<std::uint64_t> from = 0;
  while (from) {
    from = reader.frames(run, *from, 500, [&](std::uint64_t, std::span<const std::byte> frame) {
      decode_frame(frame, t);
      for (const algo::LaserScan& scan : t.observation.scans) {
        ASSERT_LT(scans, expected.size());
        const std::vector<double>& readings = expected[scans++];
        ASSERT_EQ(scan.size(), readings.size());
        for (std::size_t i = 0; i < readings.size(); ++i) {
          const bool code = readings[i] >= 81.8;  // the README's limit for centimetre logs
          const bool ok = scan.status[i] == algo::Beam::Ok;
          const bool same = std::abs(scan.ranges[i] - readings[i]) < 1e-9;
          if (ok == code || (ok && !same)) ++wrong;
          masked += code ? 1 : 0;
          ++beams;
        }
      }
    });
  }
  EXPECT_EQ(scans, 2000u);
  EXPECT_EQ(wrong, 0u);
  EXPECT_NEAR(static_cast<double>(masked) / static_cast<double>(beams), 0.0230, 0.0002);

  const Verification verification = verify_run(reader, run);
  EXPECT_FALSE(verification.difference) << *verification.difference;
  EXPECT_EQ(verification.ticks, 2000u);
  fs::remove_all(folder);
}

}  // namespace
}  // namespace server
