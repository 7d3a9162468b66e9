// tests/drivers/robot_error.hpp: the sentence that refuses a robot's file.
#pragma once

#include <string>

#include "drivers/robot_file.hpp"

namespace drivers {

/// Empty when `text` is accepted. The file is called my.toml.
inline std::string error_of(const std::string& text) {
  try {
    parse_robot(text, "my.toml");
  } catch (const RobotFileError& error) {
    return error.what();
  }
  return "";
}

}  // namespace drivers
