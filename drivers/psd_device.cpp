// drivers/psd_device.cpp: passes every call to the machine, under the line's lock.
#include "drivers/psd_device.hpp"

namespace drivers::psd {

PsdDevice::PsdDevice(const std::string& port, const PsdSetup& setup)
    : machine_(setup), line_(port, machine_) {}

bool PsdDevice::take(algo::FloorRanges& ranges) {
  bool taken = false;
  line_.look([&] { taken = machine_.take(ranges); });
  return taken;
}

FloorState PsdDevice::state() {
  FloorState out;
  line_.look([&] { out = machine_.state(steady_now()); });
  return out;
}

algo::DeviceReport PsdDevice::report() {
  algo::DeviceReport out;
  line_.look([&] { out = machine_.report(steady_now()); });
  out.name = kDeviceName;
  out.port = line_.path();
  return out;
}

std::uint64_t PsdDevice::readings() {
  std::uint64_t out = 0;
  line_.look([&] { out = machine_.readings(); });
  return out;
}

}  // namespace drivers::psd
