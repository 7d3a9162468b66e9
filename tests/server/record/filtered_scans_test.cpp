// tests/server/record/filtered_scans_test.cpp: the scans recomputed from a stored run equal those
// of its controller, beam for beam.
#include "server/record/filtered_scans.hpp"

#include <cstddef>
#include <map>
#include <memory>
#include <vector>

#include "tests/db/store_files.hpp"
#include <gtest/gtest.h>

#include "algo/filter/filter.hpp"
#include "algo/pipeline/pipeline.hpp"
#include "db/run_store.hpp"
#include "server/record/run_json.hpp"
#include "server/run/run_spec.hpp"
#include "server/run/scenario_library.hpp"

namespace server {
namespace {

using Message = std::vector<std::byte>;

Message message(std::span<const std::byte> bytes) {
  return {bytes.begin(), bytes.end()};
}

class FilteredScansTest : public test::StoreFiles {
 protected:
  static constexpr std::uint64_t kTicks = 400;

  /// Drives `scenario` with filter changes; keeps the scans of its controller.
  void drive(const char* scenario) {
    const RunSpec spec = make_spec(ScenarioLibrary({}, {}).load(scenario), {});
    const std::unique_ptr<algo::Robot> robot = make_robot(spec);
    algo::Pipeline pipeline(pipeline_config(spec), robot->spec());
    db::RunStore store(path);
    run = store.begin_run(new_run(spec, robot->spec()));
    FrameEncoder encoder;
    FrameEncoder alone;
    algo::Telemetry t;
    robot->reset(t.observation);
    pipeline.reset(t.observation.odometry.pose);
    for (const algo::Request& request : first_requests(spec)) t.requests.push_back(request);
    while (t.tick + 1 < kTicks) {
      const std::uint64_t coming = t.tick + 1;
      const double half_width = coming == 100 ? 8 : 3;
      if (coming == 100 || coming == 230) {
        t.requests.push_back(algo::SetParameter{&algo::kFilterHalfWidth, half_width});
      }
      pipeline.tick(t);
      seen.push_back(t.scene.fresh ? message(alone.encode(t.scene.scan)) : Message{});
      for (std::size_t i = 0; t.scene.fresh && i < t.scene.scan.size(); ++i) {
        const algo::LaserScan& raw = t.observation.scans[0];
        entered += t.scene.scan.ranges[i] < raw.ranges[i] - 0.5 ? 1U : 0U;
      }
      const auto bytes = encoder.encode(t);
      store.append_tick(run, t.tick, t.observation.stamp, bytes, encoder.windows());
      t.requests.clear();
      robot->step(t.command, t.observation);
    }
    store.commit();
  }

  std::map<std::uint64_t, Message> read(FilteredScans& scans, std::uint64_t from, std::size_t n) {
    db::RunReader reader(path);
    std::map<std::uint64_t, Message> out;
    scans.read(reader, from, n, [&](std::uint64_t tick, std::span<const std::byte> scan) {
      out[tick] = message(scan);
    });
    return out;
  }
  FilteredScans scans_of_run() {
    db::RunReader reader(path);
    return FilteredScans(*reader.get(run));
  }
  void expect_seen(const std::map<std::uint64_t, Message>& found, std::uint64_t from) {
    std::uint64_t tick = from;
    for (const auto& [at, scan] : found) {
      ASSERT_EQ(at, tick++);
      ASSERT_EQ(scan, seen[at]) << "tick " << at;
    }
  }

  db::RunId run = 0;
  std::vector<Message> seen{};  // by tick
  std::size_t entered = 0;      // beams much nearer than the laser's
};

TEST_F(FilteredScansTest, AreTheScansOfTheController) {
  drive("sensors");
  EXPECT_GT(entered, 0U) << "sonar and infrared entered nothing: the test says little";
  FilteredScans scans = scans_of_run();
  const auto found = read(scans, 0, kTicks);
  EXPECT_EQ(found.size(), seen.size());
  expect_seen(found, 0);
}

TEST_F(FilteredScansTest, CanStartAnywhereAndSeekForwardOrBack) {
  drive("sensors");
  FilteredScans scans = scans_of_run();
  for (const std::uint64_t from : {231U, 281U, 300U, 90U, 99U, 229U, 0U}) {
    const auto found = read(scans, from, 50);
    ASSERT_EQ(found.size(), 50U);
    expect_seen(found, from);
  }
}

TEST_F(FilteredScansTest, ATickWithoutAScanHasAnEmptyMessage) {
  drive("sensors");
  std::size_t without = 0;
  for (const Message& scan : seen) without += scan.empty() ? 1U : 0U;
  EXPECT_GT(without, 0U);
  EXPECT_LT(without, seen.size() / 2);
}

}  // namespace
}  // namespace server
