// tests/server/run/scenario_library_test.cpp: a saved scenario can be loaded again, with its map.
#include "server/run/scenario_library.hpp"

#include <filesystem>

#include "tests/server/map_room.hpp"
#include "tests/temporary_folder.hpp"
#include <gtest/gtest.h>

#include "server/run/map_file.hpp"
#include "server/run/run_spec.hpp"

namespace server {
namespace {

namespace fs = std::filesystem;

TEST(ScenarioLibrary, KeepsACopyOfTheMapBesideASavedScenario) {
  const tests::TemporaryFolder folder;
  const ScenarioLibrary library(folder.path() / "own", {});
  sim::Scenario scenario = map_room::poor_wheels_in_a_room();
  scenario.name = "mine";
  {
    const tests::TemporaryFolder elsewhere;
    algo::OccupancyMap cells(0.05);
    cells.mark_wall(cells.centre({3, 4}));
    cells.mark_free(cells.centre({3, 5}));
    write_map(cells, elsewhere.path() / "room.yaml");
    scenario.map = (elsewhere.path() / "room.yaml").string();
    EXPECT_EQ(library.save(scenario).map, "mine.map.yaml");
  }
  const RunSpec spec = make_spec(library.load("mine"), {});
  ASSERT_NE(spec.map, nullptr);
  EXPECT_EQ(spec.map->walls.walls().size(), 1U);
  // Saved from there under another name, it has a copy of its own.
  sim::Scenario second = library.load("mine");
  second.name = "second";
  library.save(second);
  library.remove("mine");
  EXPECT_NE(make_spec(library.load("second"), {}).map, nullptr);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path() / "own"), {}), 3);
}

}  // namespace
}  // namespace server
