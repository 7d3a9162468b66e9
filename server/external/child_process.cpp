// server/external/child_process.cpp: posix_spawn, a socket pair and a pipe.
#include "server/external/child_process.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <string_view>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "server/external/peer.hpp"

namespace server::external {
namespace {

using std::chrono::milliseconds;

constexpr int kChildSocket = 3;
constexpr std::size_t kTail = 2000;  // bytes kept of what it prints
constexpr milliseconds kForEnd{500};
constexpr milliseconds kForTerm{1000};

[[noreturn]] void fail(const std::string& command, int error) {
  throw ControllerError(
      fmt::format("The command '{}' cannot be started: {}.", command, std::strerror(error)));
}

/// This process's environment and the number of the socket.
std::vector<std::string> child_environment() {
  std::vector<std::string> out;
  const std::string own = fmt::format("{}=", kSocketVariable);
  for (char** each = environ; *each != nullptr; ++each) {
    if (!std::string_view(*each).starts_with(own)) out.emplace_back(*each);
  }
  out.push_back(fmt::format("{}{}", own, kChildSocket));
  return out;
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> out;
  out.reserve(texts.size() + 1);
  for (std::string& text : texts) out.push_back(text.data());
  out.push_back(nullptr);
  return out;
}

/// Actions and attributes of the child, freed with this object.
struct SpawnPlan {
  posix_spawn_file_actions_t actions{};
  posix_spawnattr_t attributes{};

  SpawnPlan(int socket, int output) {
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, output, STDERR_FILENO);
    posix_spawn_file_actions_adddup2(&actions, socket, kChildSocket);
    posix_spawnattr_init(&attributes);
    sigset_t none;
    sigemptyset(&none);
    sigset_t usual;
    sigemptyset(&usual);
    for (const int each : {SIGINT, SIGTERM, SIGPIPE, SIGHUP}) sigaddset(&usual, each);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setsigdefault(&attributes, &usual);
    posix_spawnattr_setpgroup(&attributes, 0);
    posix_spawnattr_setflags(
        &attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  }
  ~SpawnPlan() {
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
  }
  SpawnPlan(const SpawnPlan&) = delete;
  SpawnPlan& operator=(const SpawnPlan&) = delete;
};

}  // namespace

ChildProcess::ChildProcess(const std::string& command) {
  std::array<int, 2> sockets{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, sockets.data()) != 0) fail(command, errno);
  socket_ = Descriptor(sockets[0]);
  const Descriptor child_socket(sockets[1]);
  std::array<int, 2> pipes{};
  if (pipe2(pipes.data(), O_CLOEXEC) != 0) fail(command, errno);
  output_ = Descriptor(pipes[0]);
  const Descriptor child_output(pipes[1]);
  // Not on the child's ends, which expect to block.
  fcntl(socket_.number(), F_SETFL, O_NONBLOCK);
  fcntl(output_.number(), F_SETFL, O_NONBLOCK);

  std::vector<std::string> arguments{"sh", "-c", command};
  std::vector<std::string> environment = child_environment();
  const SpawnPlan plan(child_socket.number(), child_output.number());
  const int error = posix_spawn(&process_,
                                "/bin/sh",
                                &plan.actions,
                                &plan.attributes,
                                pointers(arguments).data(),
                                pointers(environment).data());
  if (error == 0) return;
  process_ = -1;
  fail(command, error);
}

ChildProcess::~ChildProcess() {
  socket_.close();
  ask_to_end();
  if (wait_for_end(kForTerm)) return;
  kill(-process_, SIGKILL);
  waitpid(process_, &status_, 0);
}

void ChildProcess::ask_to_end() {
  if (process_ > 0) kill(-process_, SIGTERM);
}

Aside ChildProcess::aside() {
  return {output_.number(), [this] { read_output(); }};
}

void ChildProcess::read_output() {
  std::array<char, 4096> part{};
  while (true) {
    const ssize_t got = ::read(output_.number(), part.data(), part.size());
    if (got < 0 && errno == EINTR) continue;
    if (got == 0) output_.close();  // nothing prints any more
    if (got <= 0) return;
    tail_.append(part.data(), static_cast<std::size_t>(got));
    if (tail_.size() > kTail) tail_.erase(0, tail_.size() - kTail);
  }
}

std::string ChildProcess::last_words() {
  if (output_) read_output();
  std::string text = tail_;
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.pop_back();
  return text;
}

std::string ChildProcess::how_it_ended() {
  if (!wait_for_end(kForEnd)) return "closed its socket";
  if (WIFSIGNALED(status_)) return fmt::format("was ended by signal {}", WTERMSIG(status_));
  return fmt::format("ended with status {}", WEXITSTATUS(status_));
}

bool ChildProcess::wait_for_end(milliseconds patience) {
  constexpr milliseconds kStep{2};
  for (milliseconds waited{0}; process_ > 0; waited += kStep) {
    const pid_t ended = waitpid(process_, &status_, WNOHANG);
    if (ended == process_ || (ended < 0 && errno != EINTR)) process_ = -1;
    if (process_ < 0) return true;
    if (waited >= patience) return false;
    if (output_) read_output();  // a full pipe would keep it from ending
    std::this_thread::sleep_for(kStep);
  }
  return true;
}

}  // namespace server::external
