// tests/server/external/answer_reader_test.cpp: an answer is read whole or refused with a sentence.
#include <functional>
#include <limits>
#include <string>

#include "controller_generated.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/external/messages.hpp"

namespace server::external {
namespace {

namespace fb = tautline::external;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// A command as a controller would send it.
fb::CommandT plain() {
  fb::CommandT command;
  command.tick = 5;
  command.twist = std::make_unique<fb::Twist2>(0.25, -0.5);
  return command;
}

std::vector<std::byte> bytes_of(const fb::CommandT& command) {
  flatbuffers::FlatBufferBuilder b;
  fb::FinishSizePrefixedMessageBuffer(
      b, fb::CreateMessage(b, fb::Body_Command, fb::CreateCommand(b, &command).Union()));
  const auto all = std::as_bytes(std::span(b.GetBufferPointer(), b.GetSize()));
  return {all.begin(), all.end()};
}

struct Read {
  Texts texts{};
  algo::ControlOutput out{};
  algo::Explanation words{};
};

void read(Read& into, const std::vector<std::byte>& bytes) {
  read_answer(bytes, 5, into.texts, into.out, into.words);
}

fb::LayerT line() {
  fb::LayerT layer;
  layer.name = "mine.line";
  layer.kind = fb::LayerKind_Polyline;
  layer.values = {0, 0, 1, 2};
  return layer;
}

TEST(AnswerReader, ReadsEveryField) {
  fb::CommandT command = plain();
  command.waits = true;
  command.state = 3;
  command.what = "Waiting";
  command.why = "A door is shut.";
  command.layers.push_back(std::make_unique<fb::LayerT>(line()));
  command.joint_rates = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7};
  command.measures.push_back(std::make_unique<fb::MeasureT>());
  command.measures[0]->name = "mine.cost";
  command.measures[0]->unit = "s";
  command.measures[0]->value = 4.5;
  Read got;
  read(got, bytes_of(command));
  EXPECT_EQ(got.out.twist, (algo::Twist2{0.25, -0.5}));
  EXPECT_TRUE(got.out.waits);
  EXPECT_EQ(got.out.joint_rates, (algo::JointValues{0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7}));
  EXPECT_EQ(got.out.state, 3);
  EXPECT_EQ(got.words, (algo::Explanation{"Waiting", "A door is shut."}));
  ASSERT_EQ(got.out.layers.size(), 1U);
  EXPECT_EQ(got.out.layers[0].name, "mine.line");
  EXPECT_EQ(got.out.layers[0].label, "mine.line");
  EXPECT_EQ(got.out.layers[0].kind, algo::LayerKind::Polyline);
  EXPECT_THAT(got.out.layers[0].values, ::testing::ElementsAre(0, 0, 1, 2));
  EXPECT_EQ(got.out.measure("mine.cost"), 4.5);
}

TEST(AnswerReader, RefusesWhatIsWrongWithASentence) {
  struct Case {
    const char* sentence;
    std::function<void(fb::CommandT&)> spoil;
  };
  const auto with_layer = [](const std::function<void(fb::LayerT&)>& spoil) {
    return [spoil](fb::CommandT& command) {
      command.layers.push_back(std::make_unique<fb::LayerT>(line()));
      spoil(*command.layers[0]);
    };
  };
  const std::vector<Case> cases{
      {"answered tick 6 where tick 5", [](auto& c) { c.tick = 6; }},
      {"without a twist", [](auto& c) { c.twist.reset(); }},
      {"not a finite number",
       [](auto& c) {
         c.twist = std::make_unique<fb::Twist2>(std::numeric_limits<double>::infinity(), 0);
       }},
      {"It commanded 6 joints; an arm has 7.", [](auto& c) { c.joint_rates.assign(6, 0.1); }},
      {"not a finite number",
       [](auto& c) { c.joint_rates.assign(7, std::numeric_limits<double>::quiet_NaN()); }},
      {"It gave up: no map", [](auto& c) { c.failure = "no map"; }},
      {"a sentence of 501 bytes", [](auto& c) { c.what = std::string(501, 'a'); }},
      {"33 layers; at most 32",
       [](auto& c) {
         for (int i = 0; i < 33; ++i) c.layers.push_back(std::make_unique<fb::LayerT>(line()));
       }},
      {"65 measures; at most 64",
       [](auto& c) {
         for (int i = 0; i < 65; ++i) c.measures.push_back(std::make_unique<fb::MeasureT>());
       }},
      {"a layer without a name", with_layer([](auto& l) { l.name.clear(); })},
      {"by 65 bytes", with_layer([](auto& l) { l.name = std::string(65, 'n'); })},
      {"neither 2 nor 3 axes", with_layer([](auto& l) { l.axes = 4; })},
      {"do not make whole items", with_layer([](auto& l) { l.values.push_back(1); })},
      {"unknown kind", with_layer([](auto& l) { l.kind = static_cast<fb::LayerKind>(200); })},
      {"whose cells do not fill its columns", with_layer([](auto& l) {
         l.kind = fb::LayerKind_Grid;
         l.values = {0, 0, 0.1F, 3};
         l.cells = {1, 2, 3, 4};
       })},
  };
  for (const Case& each : cases) {
    fb::CommandT command = plain();
    each.spoil(command);
    Read got;
    EXPECT_THAT([&] { read(got, bytes_of(command)); },
                ThrowsMessage<ControllerError>(HasSubstr(each.sentence)));
  }
}

TEST(AnswerReader, RefusesEveryCutMessage) {
  fb::CommandT command = plain();
  command.layers.push_back(std::make_unique<fb::LayerT>(line()));
  const std::vector<std::byte> whole = bytes_of(command);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    Read got;
    const std::vector<std::byte> cut(whole.begin(),
                                     whole.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_THROW(read(got, cut), ControllerError) << size;
  }
}

TEST(AnswerReader, RefusesAnotherMessage) {
  MessageWriter writer;
  const auto welcome = writer.welcome("mine");
  Read got;
  EXPECT_THAT(
      [&] {
        read(got, {welcome.begin(), welcome.end()});
      },
      ThrowsMessage<ControllerError>(HasSubstr("no Command")));
  EXPECT_THAT([&] { read_hello(welcome); },
              ThrowsMessage<ControllerError>(HasSubstr("did not begin with a Hello")));
}

}  // namespace
}  // namespace server::external
