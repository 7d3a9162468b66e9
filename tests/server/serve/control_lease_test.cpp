// tests/server/serve/control_lease_test.cpp: the controls from hand to hand; the clock is an
// argument.
#include "server/serve/control_lease.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace server {
namespace {

using std::chrono::seconds;
using testing::HasSubstr;

const ControlLease::Time kStart{seconds(1000)};
const Party kAnn{1, "Ann", net::Role::Operator};
const Party kBob{2, "Bob", net::Role::Operator};
const Party kEve{3, "Eve", net::Role::Admin};
const Party kScript{Party::kNoClient, "10.0.0.7", net::Role::Operator};

TEST(ControlLeaseTest, AFreeOneStopsNobody) {
  const ControlLease lease;
  EXPECT_FALSE(lease.refusal(kAnn));
  EXPECT_FALSE(lease.refusal(kScript));
}

TEST(ControlLeaseTest, OnlyTheHolderControls) {
  ControlLease lease;
  EXPECT_FALSE(lease.take(kAnn, false, kStart));
  EXPECT_FALSE(lease.refusal(kAnn));
  EXPECT_THAT(lease.refusal(kBob).value_or(""), HasSubstr("Ann has the controls"));
  EXPECT_TRUE(lease.refusal(kScript));
  EXPECT_THAT(lease.take(kBob, false, kStart + seconds(4)).value_or(""), HasSubstr("5 s"));
  EXPECT_TRUE(lease.holds(kAnn));
}

TEST(ControlLeaseTest, ASilentHoldersIsTakenOver) {
  ControlLease lease;
  lease.take(kAnn, false, kStart);
  lease.touch(kStart + seconds(10));
  EXPECT_TRUE(lease.take(kBob, false, kStart + seconds(14)));
  EXPECT_FALSE(lease.take(kBob, false, kStart + seconds(15)));
  EXPECT_TRUE(lease.refusal(kAnn));
}

TEST(ControlLeaseTest, OnlyAdminsForceIt) {
  ControlLease lease;
  lease.take(kAnn, false, kStart);
  EXPECT_THAT(lease.take(kBob, true, kStart).value_or(""), HasSubstr("admin"));
  EXPECT_FALSE(lease.take(kEve, true, kStart));
  EXPECT_TRUE(lease.holds(kEve));
}

TEST(ControlLeaseTest, TheHolderGivesItToOneWhoAsks) {
  ControlLease lease;
  EXPECT_THAT(lease.ask(kBob, kStart).value_or(""), HasSubstr("take them"));
  lease.take(kAnn, false, kStart);
  EXPECT_TRUE(lease.give(kBob.client, kStart));
  EXPECT_FALSE(lease.ask(kBob, kStart));
  EXPECT_FALSE(lease.ask(kBob, kStart));
  ASSERT_EQ(lease.asking().size(), 1U);
  EXPECT_FALSE(lease.give(kBob.client, kStart));
  EXPECT_TRUE(lease.holds(kBob));
  EXPECT_TRUE(lease.asking().empty());
}

TEST(ControlLeaseTest, AQuestionIsForgottenAndSoIsOneWhoLeaves) {
  ControlLease lease;
  lease.take(kAnn, false, kStart);
  lease.ask(kBob, kStart);
  lease.ask(kEve, kStart);
  EXPECT_TRUE(lease.lost(kEve.client));
  EXPECT_EQ(lease.asking().size(), 1U);
  lease.touch(kStart + seconds(29));
  EXPECT_FALSE(lease.expire(kStart + seconds(29)));
  EXPECT_TRUE(lease.expire(kStart + seconds(30)));
  EXPECT_TRUE(lease.asking().empty());
  EXPECT_TRUE(lease.holder());
}

TEST(ControlLeaseTest, ItEndsWithTheLinkAndAfterAMinuteWithoutAControl) {
  ControlLease lease;
  lease.take(kAnn, false, kStart);
  EXPECT_FALSE(lease.lost(kBob.client));
  EXPECT_TRUE(lease.lost(kAnn.client));
  EXPECT_FALSE(lease.holder());
  lease.take(kBob, false, kStart);
  EXPECT_FALSE(lease.expire(kStart + seconds(59)));
  EXPECT_TRUE(lease.expire(kStart + seconds(60)));
  EXPECT_FALSE(lease.refusal(kAnn));
}

TEST(ControlLeaseTest, APublishersEndsAfterTwoSeconds) {
  ControlLease lease;
  EXPECT_FALSE(lease.take_by_publishing(kAnn, kStart));
  EXPECT_TRUE(lease.take_by_publishing(kBob, kStart + seconds(1)));
  EXPECT_TRUE(lease.expire(kStart + seconds(2)));
  EXPECT_FALSE(lease.take_by_publishing(kBob, kStart + seconds(3)));
  // GIVEN a holder who asked for the controls in so many words THEN a pause of two seconds ends
  // nothing.
  ControlLease page;
  page.take(kAnn, false, kStart);
  page.take_by_publishing(kAnn, kStart);
  EXPECT_FALSE(page.expire(kStart + seconds(3)));
}

TEST(ControlLeaseTest, AScriptHoldsItByItsKey) {
  ControlLease lease;
  EXPECT_FALSE(lease.take(kScript, false, kStart));
  const std::string key = lease.holder()->key;
  EXPECT_GE(key.size(), 32U);
  EXPECT_FALSE(lease.refusal(kScript, key));
  EXPECT_TRUE(lease.refusal(kScript, ""));
  EXPECT_TRUE(lease.refusal(kScript, key + "0"));
  EXPECT_TRUE(lease.refusal(kAnn, key.substr(1)));
  EXPECT_FALSE(lease.lost(Party::kNoClient));
  EXPECT_TRUE(lease.holder());
}

}  // namespace
}  // namespace server
