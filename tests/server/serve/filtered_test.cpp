// tests/server/serve/filtered_test.cpp: the filtered scan live and of the stored run are the same
// beam for beam, with sonar, infrared and a filter that changes.
#include <set>
#include <string>
#include <utility>

#include "tests/server/serve/app_fixture.hpp"
#include "tests/server/serve/viewer.hpp"
#include <gtest/gtest.h>

namespace server {
namespace {

using net::test::Answer;
using net::test::eventually;

class FilteredTest : public AppTest {
 protected:
  /// All messages of GET /runs/{id}/filtered; and how many are empty.
  std::pair<std::set<std::string>, std::size_t> stored(const std::string& run) const {
    std::pair<std::set<std::string>, std::size_t> out;
    for (std::string from = "0"; !from.empty();) {
      const Answer page = ask("GET", "/runs/" + run + "/filtered?limit=150&from=" + from);
      EXPECT_EQ(page.status, 200) << page.body;
      for (std::size_t at = 0; at + 4 <= page.body.size();) {
        std::uint32_t size = 0;
        for (std::size_t i = 0; i < 4; ++i) {
          size |= std::uint32_t{static_cast<unsigned char>(page.body[at + i])} << (8 * i);
        }
        if (size == 0) ++out.second;
        if (size > 0) out.first.insert(page.body.substr(at + 4, size));
        at += 4 + size;
      }
      const auto next = page.headers.find("X-Next-Tick");
      from = next == page.headers.end() ? "" : next->second;
    }
    return out;
  }
};

TEST_F(FilteredTest, LiveAndStoredAreTheSame) {
  ASSERT_EQ(post("/session/control", {{"action", "load"}, {"scenario", "sensors"}}), 200);
  Viewer viewer(port_);
  ASSERT_TRUE(viewer.channels.contains("/tautline/filtered"));
  viewer.subscribe("/tautline/filtered");
  std::vector<std::string> live = viewer.messages(30);
  ASSERT_EQ(live.size(), 30U);
  ASSERT_EQ(ask("PATCH", "/session/parameters", R"({"filter_half_width":8})").status, 200);
  for (std::string& more : viewer.messages(30)) live.push_back(std::move(more));
  ASSERT_EQ(live.size(), 60U);

  const std::string run = get("/session")["run"]["id"].dump();
  const auto holds_all = [&] {
    const auto& [scans, empty] = stored(run);
    return empty > 0 && std::ranges::all_of(live, [&, &found = scans](const std::string& scan) {
             return found.contains(scan);
           });
  };
  EXPECT_TRUE(eventually(holds_all));
  EXPECT_EQ(ask("GET", "/runs/99999/filtered").status, 404);
}

}  // namespace
}  // namespace server
