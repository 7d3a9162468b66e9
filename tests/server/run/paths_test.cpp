// tests/server/run/paths_test.cpp: the file names that visitors see.
#include "server/run/paths.hpp"

#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace server {
namespace {

TEST(Paths, AFileIsNamedWithoutItsFolder) {
  for (const auto& [said, told] : std::vector<std::pair<std::string, std::string>>{
           {"The run store /home/ann/.local/state/tautline/runs.db is damaged.",
            "The run store runs.db is damaged."},
           {"/etc/robots/pioneer.toml:12: 'baud' is unknown.",
            "pioneer.toml:12: 'baud' is unknown."},
           {"Cannot write '/data/tautline/scenarios/a.json.new'.", "Cannot write 'a.json.new'."},
           {"filesystem error: cannot rename: No such file [/a/b] [/a/c]",
            "filesystem error: cannot rename: No such file [b] [c]"},
           {"Its folder /srv/runs/ is full.", "Its folder runs is full."},
           {"The line /dev/ttyUSB0 is silent.", "The line /dev/ttyUSB0 is silent."},
           {"Location: /api/v1/runs/7", "Location: /api/v1/runs/7"},
           {"0.5 m/s and 1/2", "0.5 m/s and 1/2"},
           {"obstacles/0: radius", "obstacles/0: radius"},
           {"a / b", "a / b"},
           {"", ""}}) {
    EXPECT_EQ(without_folders(said), told);
  }
}

}  // namespace
}  // namespace server
