// tests/server/serve/stop_test.cpp: Stop is answered without waiting.
#include <optional>
#include <string>

#include "tests/server/serve/app_fixture.hpp"
#include <gtest/gtest.h>

#include "algo/gate.hpp"
#include "server/serve/session.hpp"

namespace server {
namespace {

using net::test::eventually;

class StopTest : public AppTest {
 protected:
  json control(const char* action) const {
    const net::test::Answer answer =
        ask("POST", "/session/control", json({{"action", action}}).dump());
    EXPECT_EQ(answer.status, 200) << answer.body;
    return json::parse(answer.body, nullptr, false);
  }
};

/// Without poll() no event of the control thread arrives: so the answer needs no tick.
TEST(Stop, IsAnsweredInTheCallThatMakesIt) {
  Scheduler scheduler;
  Session session({.scheduler = scheduler, .frames = std::make_shared<FrameRoom>(1024)});
  session.load(make_spec(ScenarioLibrary({}, {}).load("case1"), {}));
  bool answered = false;
  session.submit(algo::Stop{true}, [&](const std::optional<std::string>& refusal) {
    EXPECT_FALSE(refusal);
    answered = true;
  });
  EXPECT_TRUE(answered);
  EXPECT_TRUE(session.state().asked.stop);
}

TEST(Stop, OvertakesRequestsThatNobodyTakes) {
  Scheduler scheduler;
  Session session({.scheduler = scheduler, .frames = std::make_shared<FrameRoom>(1024)});
  session.load(make_spec(ScenarioLibrary({}, {}).load("case1"), {}));
  while (session.submit(algo::Joystick{1, 0}, {})) {
  }
  session.submit(algo::Stop{true}, {});
  EXPECT_TRUE(eventually([&] {
    session.poll();
    return session.newest() && session.newest()->telemetry.hold == algo::holds::kStopped;
  }));
  EXPECT_TRUE(session.state().asked.stop);
}

TEST(Stop, IsNotUndoneByAReleaseOnItsWay) {
  Scheduler scheduler;
  Session session({.scheduler = scheduler, .frames = std::make_shared<FrameRoom>(1024)});
  session.load(make_spec(ScenarioLibrary({}, {}).load("case1"), {}));
  session.submit(algo::Stop{true}, {});
  std::optional<bool> released;
  session.submit(algo::Stop{false},
                 [&](const std::optional<std::string>& refusal) { released = !refusal; });
  session.submit(algo::Stop{true}, {});
  EXPECT_TRUE(eventually([&] {
    session.poll();
    return released.has_value() && session.newest() != nullptr;
  }));
  EXPECT_TRUE(session.state().asked.stop);
  const std::uint64_t tick = session.newest()->telemetry.tick;
  EXPECT_TRUE(eventually([&] {
    session.poll();
    return session.newest()->telemetry.tick > tick + 2;
  }));
  EXPECT_EQ(session.newest()->telemetry.hold, algo::holds::kStopped);
}

TEST_F(StopTest, TellsCommandedFromStanding) {
  ASSERT_TRUE(eventually([&] { return get("/session")["command"]["v"] > 0.02; }));
  EXPECT_EQ(control("stop")["stop"], "commanded");
  EXPECT_TRUE(eventually([&] { return control("stop")["stop"] == "standing"; }));
  EXPECT_FALSE(control("release").contains("stop"));
}

}  // namespace
}  // namespace server
