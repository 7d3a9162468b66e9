// server/cli/doctor_notes.cpp: the check of a port.
#include "server/cli/doctor_notes.hpp"

#include <chrono>
#include <cmath>
#include <stdexcept>
#include <thread>

#include <fmt/format.h>

#include "drivers/serial_port.hpp"

namespace server::doctor {

void pause(const DoctorOptions& options) {
  constexpr double kLook = 0.02;  // [s]
  if (options.interrupted()) throw std::runtime_error("Interrupted: the checks are not complete.");
  std::this_thread::sleep_for(std::chrono::duration<double>(kLook));
}

bool look_at_port(const std::string& path, unsigned baud, Notes& notes) {
  try {
    const drivers::SerialPort port(path, baud);
    if (port.baud() == 0) {
      notes.well(fmt::format("{} answers; its box knows its own rate.", path));
      return true;
    }
    const double off = std::abs(static_cast<double>(port.baud()) - baud) / baud;
    if (off > 0.03) {
      notes.note(fmt::format("{} makes {} bit/s of {}.", path, port.baud(), baud),
                 "Take an adapter that makes this rate, or a lower `rate` in the file.");
    } else {
      notes.well(fmt::format("{} opens, and can do {} bit/s.", path, baud));
    }
    return true;
  } catch (const drivers::LineError& error) {
    notes.bad(error.what(),
              "`ls -l /dev/serial/by-id` shows what is plugged in; `fuser " + path +
                  "` shows which program has it.");
    return false;
  }
}

}  // namespace server::doctor
