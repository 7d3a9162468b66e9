// server/external/socket_peer.cpp: the dialogue, and a sentence for each way in which it fails.
#include "server/external/socket_peer.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace server::external {
namespace {

constexpr double kStartLimit = 60;  // [s] least time for a process to say hello

}  // namespace

SocketPeer::SocketPeer(Settings settings,
                       Descriptor socket,
                       std::unique_ptr<ChildProcess> process,
                       Texts& texts,
                       const std::stop_token& stop)
    : settings_(std::move(settings)),
      socket_(std::move(socket)),
      process_(std::move(process)),
      texts_(texts),
      stop_(stop) {
  shake_hands();
}

SocketPeer::~SocketPeer() = default;

void SocketPeer::shake_hands() {
  const double limit = settings_.answer_limit;
  const bool starts = process_ && limit > 0;  // it loads its libraries first
  receive(starts ? std::max(limit, kStartLimit) : limit);
  Hello hello;
  try {
    hello = read_hello(socket_.message());
  } catch (const ControllerError& e) {
    fail(e.what());
  }
  if (hello.version != kProtocol) {
    refuse(fmt::format("It speaks version {} of controller.fbs; this program speaks {}.",
                       hello.version,
                       kProtocol));
  }
  if (hello.token != settings_.token) refuse("It does not know the token.");
  send(writer_.welcome(settings_.name));
}

/// Tells the controller, too.
void SocketPeer::refuse(const std::string& why) {
  socket_.send(writer_.end(why), {.deadline = MessageSocket::Clock::now()});
  fail(why);
}

Patience SocketPeer::patience(double limit) {
  using Clock = MessageSocket::Clock;
  Patience out{.stop = stop_};
  if (process_) out.aside = process_->aside();
  if (limit > 0) {
    const std::chrono::duration<double> most(limit);
    out.deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(most);
  }
  return out;
}

void SocketPeer::begin(const Begin& run) {
  stop_ = run.run.stop;
  parameters_ = run.parameters;
  at_ = "at the beginning of the run";
  send(writer_.begin(run));
}

void SocketPeer::answer(const Question& question,
                        algo::ControlOutput& out,
                        algo::Explanation& words) {
  at_.clear();
  fmt::format_to(std::back_inserter(at_), "at tick {}", question.tick);
  send(writer_.question(question, parameters_));
  receive(settings_.answer_limit);
  try {
    read_answer(socket_.message(), question.tick, texts_, out, words);
  } catch (const ControllerError& e) {
    fail(e.what());
  }
}

void SocketPeer::say_end(const std::string& reason) {
  socket_.send(writer_.end(reason), {.deadline = MessageSocket::Clock::now()});
  if (process_) process_->ask_to_end();
}

void SocketPeer::send(std::span<const std::byte> message) {
  const double limit = settings_.answer_limit;
  const auto result = socket_.send(message, patience(limit));
  if (result != MessageSocket::Result::Done) fail(result, limit);
}

void SocketPeer::receive(double limit) {
  const auto result = socket_.receive(kMostBytes, patience(limit));
  if (result != MessageSocket::Result::Done) fail(result, limit);
}

void SocketPeer::fail(MessageSocket::Result result, double limit) {
  switch (result) {
    case MessageSocket::Result::Late:
      fail(fmt::format("It did not answer within {:g} s.", limit));
    case MessageSocket::Result::Stopped:
      fail("The run was to end.");
    case MessageSocket::Result::TooLarge:
      fail(fmt::format("It sent a message of more than {} bytes.", kMostBytes));
    default:
      fail(fmt::format("It {}.", process_ ? process_->how_it_ended() : "closed the connection"));
  }
}

/// "The controller 'mine' failed at tick 12. It ended with status 1. Its last lines:\n..."
void SocketPeer::fail(const std::string& what) {
  std::string sentence =
      fmt::format("The controller '{}' failed {}. {}", settings_.name, at_, what);
  const std::string last = process_ ? process_->last_words() : "";
  if (!last.empty()) sentence += " Its last lines:\n" + last;
  throw ControllerError(sentence);
}

}  // namespace server::external
