// tests/server/cli/parsed.hpp: a command of the program, parsed and run within a test.
#pragma once

#include <algorithm>
#include <exception>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <gtest/gtest.h>

#include "server/cli/options.hpp"

namespace tests {

struct Parsed {
  int status = -1;        // of the command; -1: it did not run to its end
  std::string refusal{};  // the sentence that refuses the arguments, or empty
};

/// The first of the arguments is the command. Its output is dropped.
inline Parsed parsed(void (*add)(server::Command, int&), std::vector<std::string> arguments) {
  CLI::App app;
  Parsed out;
  add(server::Command(app), out.status);
  std::ranges::reverse(arguments);  // CLI11 takes them from the end
  testing::internal::CaptureStdout();
  try {
    app.parse(arguments);
  } catch (const std::exception& e) {
    out.refusal = e.what();
  }
  testing::internal::GetCapturedStdout();
  return out;
}

}  // namespace tests
