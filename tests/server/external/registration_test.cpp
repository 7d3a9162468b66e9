// tests/server/external/registration_test.cpp: the texts of --controller and --think-time.
#include "server/external/registration.hpp"

#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/external/peer.hpp"

namespace server::external {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(Registration, TellsACommandFromAName) {
  EXPECT_FALSE(is_command("modified"));
  EXPECT_TRUE(is_command("python3 mine.py"));
  EXPECT_TRUE(is_command("./mine"));
  EXPECT_TRUE(is_command("mine=drive"));
}

TEST(Registration, ReadsNameAndCommand) {
  const Registration named = registration_from_text("mine=python3 a.py --gain=2");
  EXPECT_EQ(named.name, "mine");
  EXPECT_EQ(named.command, "python3 a.py --gain=2");
  const Registration unnamed = registration_from_text("GAIN=2 python3 a.py");
  EXPECT_EQ(unnamed.name, "external");
  EXPECT_EQ(unnamed.command, "GAIN=2 python3 a.py");
}

TEST(Registration, RefusesWhatCannotBe) {
  using Error = std::invalid_argument;
  EXPECT_THAT([] { registration_from_text("mine= "); },
              ThrowsMessage<Error>(HasSubstr("has no command")));
  EXPECT_THAT([] { registration_from_text("vff=./a"); },
              ThrowsMessage<Error>(HasSubstr("'vff' is a built-in controller")));
  EXPECT_THAT(
      [] {
        catalogue_with({{.name = "a", .command = "x"}, {.name = "a", .command = "y"}});
      },
      ThrowsMessage<Error>(HasSubstr("two controllers are called 'a'")));
  EXPECT_THAT([] { catalogue_with({{.name = "a", .command = "/no/such.so"}}); },
              ThrowsMessage<ControllerError>(HasSubstr("cannot be loaded")));
}

TEST(Registration, ReadsThinkTimes) {
  EXPECT_EQ(think_time_from_text("pause").kind, ThinkTime::Kind::Pause);
  EXPECT_EQ(think_time_from_text("measured").kind, ThinkTime::Kind::Measured);
  EXPECT_EQ(think_time_from_text("12").ticks, 12U);
  for (const char* text : {"", "soon", "-1", "1001", "3s"}) {
    EXPECT_THROW(think_time_from_text(text), std::invalid_argument) << text;
  }
}

TEST(Registration, StandsBesideTheBuiltInOnes) {
  const auto catalogue = catalogue_with({{.name = "mine", .command = "true"}});
  EXPECT_TRUE(catalogue.at("mine").outside);
  EXPECT_FALSE(catalogue.at("modified").outside);
}

}  // namespace
}  // namespace server::external
