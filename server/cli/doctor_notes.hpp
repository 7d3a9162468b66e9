// server/cli/doctor_notes.hpp: what the doctor's checks of all devices share.
#pragma once

#include <functional>
#include <string>
#include <utility>

#include "server/cli/doctor.hpp"

namespace server::doctor {

using Found = std::function<void(const Finding&)>;

/// Waits until the next poll of a device. Throws std::runtime_error when interrupted.
void pause(const DoctorOptions& options);

/// Findings about one device.
class Notes {
 public:
  Notes(std::string device, const Found& found) : device_(std::move(device)), found_(found) {}

  void well(const std::string& sentence) { add(Finding::Verdict::Well, sentence, ""); }
  void note(const std::string& sentence, const std::string& advice = "") {
    add(Finding::Verdict::Note, sentence, advice);
  }
  void bad(const std::string& sentence, const std::string& advice) {
    add(Finding::Verdict::Bad, sentence, advice);
    all_well_ = false;
  }
  bool all_well() const { return all_well_; }

 private:
  void add(Finding::Verdict verdict, const std::string& sentence, const std::string& advice) {
    found_({verdict, device_, sentence, advice});
  }

  std::string device_;
  const Found& found_;
  bool all_well_ = true;
};

/// Checks whether the port opens, and closes it before the search for the device.
bool look_at_port(const std::string& path, unsigned baud, Notes& notes);

}  // namespace server::doctor
