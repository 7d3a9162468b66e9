// tests/server/run/map_file_test.cpp: maps of map_server, good and bad.
#include "server/run/map_file.hpp"

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "tests/folders.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "server/run/text_file.hpp"

namespace server {
namespace {

namespace fs = std::filesystem;
using algo::OccupancyMap;

class MapFile : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  std::string complaint(const std::string& yaml, const std::string& pgm) const {
    write("bad.pgm", pgm);
    try {
      read_map(write("bad.yaml", yaml));
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }
  fs::path folder_ = fs::temp_directory_path() / ("tautline_locate_" + std::to_string(::getpid()));
};

TEST_F(MapFile, WallsFreeAndUnknownCellsLieWhereTheOriginPutsThem) {
  write("three.pgm", "P2\n# a comment\n3 2\n255\n254 0 205\n0 254 254\n");
  const OccupancyMap map = read_map(
      write("three.yaml", "image: three.pgm\nresolution: 0.5\norigin: [-1.0, 2.0, 0.0]\n"));
  const auto at = [&](double x, double y) { return map.at(map.cell_of({x, y})); };
  EXPECT_TRUE(at(-0.75, 2.25).occupied());  // the lower row comes last
  EXPECT_TRUE(at(-0.25, 2.75).occupied());
  EXPECT_TRUE(at(-0.25, 2.25).known());
  EXPECT_FALSE(at(-0.25, 2.25).occupied());
  EXPECT_FALSE(at(0.25, 2.75).known());
}

TEST_F(MapFile, ListsAndFlagsMayBeWrittenInAnyYaml) {
  write("dark.pgm", "P2 2 1 9 9 0");
  const OccupancyMap map = read_map(write("dark.yaml",
                                          "image: \"dark.pgm\"  # of a saver\nmode: trinary\n"
                                          "resolution: 0.5\norigin:\n- 1\n- 2\n- 0.0\n"
                                          "negate: true\n"));
  EXPECT_TRUE(map.at(map.cell_of({1.25, 2.25})).occupied());
  EXPECT_TRUE(map.at(map.cell_of({1.75, 2.25})).known());
  EXPECT_FALSE(map.at(map.cell_of({1.75, 2.25})).occupied());
}

TEST_F(MapFile, ComesBackAsItWasWritten) {
  OccupancyMap map(0.05);
  for (int k = 0; k < 100; ++k) map.mark_wall({-2.975 + 0.05 * k, 1.02});
  map.mark_free({0.01, 0.01});
  write_map(map, folder_ / "again.yaml");
  const OccupancyMap again = read_map(folder_ / "again.yaml");
  std::size_t walls = 0;
  again.each_cell([&](const auto& cell, const auto& tally) {
    EXPECT_EQ(tally.occupied(), map.at(cell).occupied());
    EXPECT_EQ(tally.known(), map.at(cell).known());
    if (tally.occupied()) ++walls;
  });
  EXPECT_EQ(walls, 100U);
}

TEST_F(MapFile, ComesBackFromANameThatYamlWouldReadOtherwise) {
  OccupancyMap map(0.05);
  map.mark_wall({0.5, 0.5});
  for (const char* name :
       {"a #1.yaml", "c: d.yaml", "'e\".yaml", "- f.yaml", "[g].yaml", "plain"}) {
    write_map(map, folder_ / name);
    EXPECT_EQ(read_map(folder_ / name).tiles().size(), 1U) << name;
  }
}

TEST_F(MapFile, IsNotWrittenOverItsOwnPicture) {
  OccupancyMap map(0.05);
  map.mark_wall({0.5, 0.5});
  EXPECT_THROW(write_map(map, folder_ / "x.pgm"), std::runtime_error);
  EXPECT_FALSE(fs::exists(folder_ / "x.pgm"));
}

TEST_F(MapFile, OnlyTheFacesOfThickWallsAreSeen) {
  OccupancyMap map(0.05);
  for (int j = 0; j < 10; ++j) {
    for (int i = 0; i < 20; ++i) {
      if (j < 6) {
        map.mark_wall(map.centre({i, j}));
      } else {
        map.mark_free(map.centre({i, j}));
      }
    }
  }
  EXPECT_EQ(seen_walls(map).walls().size(), 20U);
  OccupancyMap bare(0.05);
  for (int i = 0; i < 20; ++i) bare.mark_wall(bare.centre({i, 0}));
  EXPECT_EQ(seen_walls(bare).walls().size(), 20U);
}

/// Two rows of cells with free space on both sides.
TEST_F(MapFile, TheTwoFacesOfAThinWallFaceApart) {
  OccupancyMap map(0.05);
  for (int i = 0; i < 40; ++i) {
    for (const int j : {0, 1}) map.mark_wall(map.centre({i, j}));
    for (const int j : {-2, -1, 2, 3}) map.mark_free(map.centre({i, j}));
  }
  const algo::Submap walls = seen_walls(map);
  ASSERT_EQ(walls.walls().size(), 80U);
  const algo::Facing up{{0, 1}, true};
  const algo::Facing down{{0, -1}, true};
  const algo::Vec2 upper = map.centre({20, 1});
  const algo::Vec2 lower = map.centre({20, 0});
  EXPECT_TRUE(walls.wall_within(upper, up, 0.01));
  EXPECT_FALSE(walls.wall_within(upper, down, 0.01));
  EXPECT_TRUE(walls.wall_within(lower, down, 0.01));
  EXPECT_FALSE(walls.wall_within(lower, up, 0.01));
}

TEST_F(MapFile, BadFilesAreRefusedWithASentence) {
  const std::string good = "image: bad.pgm\nresolution: 0.5\norigin: [0, 0, 0]\n";
  const std::string picture = "P2\n1 1\n255\n0\n";
  EXPECT_EQ(complaint(good, picture), "");
  EXPECT_THAT(complaint("image: bad.pgm\norigin: [0, 0, 0]\n", picture),
              testing::HasSubstr("resolution is missing"));
  const std::string origin = "image: bad.pgm\norigin: [0, 0, 0]\n";
  EXPECT_THAT(complaint(origin + "resolution: -1\n", picture),
              testing::HasSubstr("bad.yaml: resolution must be a number from 0.005 to 1."));
  EXPECT_THAT(complaint(origin + "resolution: .nan\n", picture), testing::HasSubstr("a number"));
  EXPECT_THAT(complaint(good + "free_tresh: 0.2\n", picture),
              testing::HasSubstr("\"free_tresh\" is no field of a map"));
  EXPECT_THAT(complaint(good + "negate: perhaps\n", picture), testing::HasSubstr("0 or 1"));
  EXPECT_THAT(complaint(good + "mode: raw\n", picture), testing::HasSubstr("trinary and scale"));
  EXPECT_THAT(complaint(good + "free_thresh: 0.9\n", picture), testing::HasSubstr("free_thresh"));
  EXPECT_THAT(complaint("[1, 2", picture), testing::HasSubstr("no YAML"));
  EXPECT_THAT(complaint("image", picture), testing::HasSubstr("key: value"));
  EXPECT_THAT(complaint("image: bad.pgm\nresolution: 1\norigin: [0, 0, 0.3]\n", picture),
              testing::HasSubstr("turned"));
  EXPECT_THAT(complaint("image: bad.pgm\nresolution: 1\norigin: 3\n", picture),
              testing::HasSubstr("[x, y, yaw]"));
  EXPECT_THAT(complaint(good, "P6\n1 1\n255\n0\n"), testing::HasSubstr("neither P2 nor P5"));
  EXPECT_THAT(complaint(good, "P2\n3 3\n255\n0\n"), testing::HasSubstr("ends too early"));
  EXPECT_THAT(complaint(good, "P2\n1 1\n255\nx\n"), testing::HasSubstr("whole number"));
  EXPECT_THAT(complaint(good, "P2\n1 1\n255\n256\n"), testing::HasSubstr("up to 255"));
  EXPECT_THAT(complaint(good, "P5\n99999 99999\n255\n"), testing::HasSubstr("64 million pixels"));
  EXPECT_THAT(complaint(good, "P2\n1 1\n255\n254\n"), testing::HasSubstr("shows no wall"));
  EXPECT_THAT(complaint("image: .\nresolution: 1\norigin: [0, 0, 0]\n", picture),
              testing::AllOf(testing::StartsWith("bad.yaml: image: "),
                             testing::EndsWith(": is a folder, not a file")));
  EXPECT_THROW(read_map(folder_ / "none.yaml"), std::runtime_error);
}

/// Of each line of tests/maps/table.json, which the page's tests read too: a description, a
/// picture, and words of the refusal; none: it shows the room of the first one.
TEST(MapFiles, ShowOneRoomOrAreRefusedInTheWordsOfTheTable) {
  const fs::path folder = tests::folder() / "maps";
  const auto shown = [&](const nlohmann::json& line) -> std::string {
    const auto picture = [&](const std::string&) { return read_text(folder / line.at(1)); };
    try {
      return map_document(map_from(read_text(folder / line.at(0)), "map.yaml", picture), "");
    } catch (const std::runtime_error& error) {
      return error.what();
    }
  };
  const auto table = nlohmann::json::parse(read_text(folder / "table.json"));
  const std::string room = shown(table.at(0));
  EXPECT_THAT(room, testing::HasSubstr("cells"));
  for (const auto& line : table) {
    const std::string says = line.at(2);
    if (says.empty()) {
      EXPECT_EQ(shown(line), room) << line;
    } else {
      EXPECT_THAT(shown(line), testing::HasSubstr(says)) << line;
    }
  }
}

}  // namespace
}  // namespace server
