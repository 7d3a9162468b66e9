// server/emulate/robot_toml.hpp: the file by which `serve --robot` drives the emulated devices.
#pragma once

#include <filesystem>
#include <string>

#include "server/emulate/emulation.hpp"

namespace server::emulate {

/// The robot's file (docs/hardware.md) of the devices of `options`: hull, wheels and mounts of the
/// scenario's robot, gear and encoders of the emulated base. `library` opens the emulated card.
std::string robot_toml(const EmulationOptions& options, const std::filesystem::path& library);

/// Writes it, unless `file` exists and is somebody else's. Returns whether it was written. Throws
/// std::runtime_error with a sentence.
bool write_robot_toml(const EmulationOptions& options,
                      const std::filesystem::path& library,
                      const std::filesystem::path& file);

}  // namespace server::emulate
