// tests/server/external/listening_test.cpp: a controller connects by itself; a second one is
// refused, and so is one without the token.
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "tests/server/external/own.hpp"
#include "tests/temporary_folder.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "algo/driving.hpp"
#include "server/external/external_controller.hpp"
#include "server/external/listening_source.hpp"

namespace server::external {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// A catalogue whose "mine" takes its controllers from `source`.
std::shared_ptr<const algo::ControllerCatalogue> catalogue_from(
    const std::shared_ptr<PeerSource>& source) {
  std::vector<algo::ControllerInfo> entries = algo::builtin_controllers().entries();
  entries.push_back({.name = "mine", .outside = true, .make = [source] {
                       return std::make_unique<ExternalController>(
                           source, algo::kDrivingParameters, ThinkTime{});
                     }});
  return std::make_shared<const algo::ControllerCatalogue>(std::move(entries));
}

/// Starts the example at `address` in the background; returns its exit status.
int run_client(const std::string& address, const std::string& token = "") {
  const std::string command =
      "TAUTLINE_CONTROLLER_TOKEN='" + token + "' " + python("client.py") + " " + address;
  return WEXITSTATUS(std::system((command + " 2>/dev/null").c_str()));
}

/// What such a client prints when it is refused.
std::string complaint_of_client(const std::string& address) {
  const std::string command = python("client.py") + " " + address + " 2>&1";
  FILE* const pipe = popen(command.c_str(), "r");
  std::string text;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) text += static_cast<char>(c);
  EXPECT_NE(pclose(pipe), 0);
  return text;
}

TEST(Listening, DrivesRunAfterRunOverAUnixSocketOfMode0600) {
  const tests::TemporaryFolder folder;
  const std::string path = (folder.path() / "mine").string();
  auto source = std::make_shared<ListeningSource>(
      Registration{.name = "mine", .command = "unix:" + path}, "");
  struct stat there {};
  ASSERT_EQ(stat(path.c_str(), &there), 0);
  EXPECT_EQ(there.st_mode & 0777U, 0600U);
  std::jthread client([&] { EXPECT_EQ(run_client("unix:" + path), 0); });
  {
    const auto catalogue = catalogue_from(source);
    const HeadlessResult first = drive(spec_of(catalogue, "case1"));
    EXPECT_NE(first.run.outcome, algo::Outcome::Failed) << first.run.reason;
    EXPECT_EQ(drive(spec_of(catalogue, "case1")).telemetry_hash, first.telemetry_hash);
    // While it is connected, a second one is refused.
    EXPECT_THAT(complaint_of_client("unix:" + path),
                HasSubstr("TautlineError: Another controller is connected."));
    EXPECT_EQ(drive(spec_of(catalogue, "case1")).telemetry_hash, first.telemetry_hash);
  }
  source.reset();  // ends the client
  client.join();
  EXPECT_NE(stat(path.c_str(), &there), 0) << "the file is left";
}

TEST(Listening, TcpNeedsTheToken) {
  EXPECT_THAT([] { ListeningSource({.name = "mine", .command = "tcp:127.0.0.1:0"}, ""); },
              ThrowsMessage<ControllerError>(HasSubstr("TCP needs a token")));
  EXPECT_THAT([] { ListeningSource({.name = "mine", .command = "tcp:0.0.0.0:0"}, "x"); },
              ThrowsMessage<ControllerError>(HasSubstr("on this machine alone")));
  auto source = std::make_shared<ListeningSource>(
      Registration{.name = "mine", .command = "tcp:127.0.0.1:0"}, "secret");
  const std::string address = source->address();
  EXPECT_NE(run_client(address, "guess"), 0);
  std::jthread client([&] { EXPECT_EQ(run_client(address, "secret"), 0); });
  const HeadlessResult result = drive(spec_of(catalogue_from(source), "case1"));
  EXPECT_NE(result.run.outcome, algo::Outcome::Failed) << result.run.reason;
  source.reset();
}

TEST(Listening, SaysThatNobodyCame) {
  const tests::TemporaryFolder folder;
  const std::string address = "unix:" + (folder.path() / "mine").string();
  const auto source = std::make_shared<ListeningSource>(
      Registration{.name = "mine", .command = address, .answer_limit = 0.2}, "");
  const HeadlessResult result = drive(spec_of(catalogue_from(source)));
  EXPECT_EQ(result.run.outcome, algo::Outcome::Failed);
  EXPECT_EQ(result.run.reason,
            "The controller 'mine' did not connect to " + address + " within 0.2 s.");
}

TEST(Listening, LeavesTheFilesOfOthersAlone) {
  const tests::TemporaryFolder folder;
  const std::string address = "unix:" + (folder.path() / "mine").string();
  const ListeningSource first({.name = "mine", .command = address}, "");
  EXPECT_THAT([&] { ListeningSource({.name = "mine", .command = address}, ""); },
              ThrowsMessage<ControllerError>(HasSubstr("another program listens there")));
  EXPECT_THAT(
      [&] { ListeningSource({.name = "a", .command = "unix:" + folder.path().string()}, ""); },
      ThrowsMessage<ControllerError>(HasSubstr("is no socket")));
}

}  // namespace
}  // namespace server::external
