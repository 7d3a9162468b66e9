// drivers/device_report.hpp: a device as people see it.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace drivers {

struct DeviceReport {
  std::string name{};  // "front laser", "base"
  std::string port{};
  bool well = false;
  std::string sentence{};              // how it is, or what is wrong and what to do
  std::vector<std::string> remarks{};  // what is not as it was asked for
  std::vector<std::pair<std::string, std::string>> facts{};  // "rate", "500000 bit/s"
};

}  // namespace drivers
