// server/lab/reproduce/filter_scenes.hpp: the scans of the filter study: the three scenes of
// chapter 3 of the thesis, test signals, and whole recordings.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace server {

/// Values of one scan as the thesis prints them: millimetres, beam 0 to the right.
struct ScanValues {
  std::vector<double> mm{};
  std::vector<std::uint8_t> valid{};  // 0 where the device sent an error code
};

struct Spike {
  std::size_t beam = 0;
  double mm = 0;  // the scanner's wrong value
};

/// A scan of 360 values with known truth.
struct FilterScene {
  std::string name{};   // name of its picture file
  std::string title{};  // for people
  int half_width = 0;   // the thesis' N for this scene
  std::vector<Spike> spikes{};
  std::vector<double> truth_mm{};   // exact, not rounded
  std::vector<double> before_mm{};  // with the scanner's noise, its rounding, and the spikes
};

/// (i) one obstacle, N = 1, spikes at beams 186, 264, 266, 272, 292; (ii) two obstacles, N = 2;
/// (iii) the same with a spike at beam 220. Nong 2008, chapter 3, Figs. 8-10.
///
/// Our choice where the thesis gives no value: a robot before a wall 4 m ahead between walls 2 m to
/// either side, cylinders for obstacles, noise of 5 mm (1 sigma) rounded to whole millimetres, far
/// spikes at 8000 mm and the one on the obstacle at 200 mm.
std::vector<FilterScene> chapter_3_scenes();

/// The reference layout of the prototype: 3000 mm everywhere, 1500 mm at beams 150..210, no noise,
/// spikes as in scene (i).
FilterScene flat_scene();

/// Scans of one recording.
struct Recording {
  std::string name{};
  double step_mm = 1;  // [mm] the device's own step
  std::vector<ScanValues> scans{};
  bool simulated = false;
};

/// Every *.log of a folder, sorted by name. Throws std::runtime_error with a sentence if the folder
/// holds none, or one cannot be read.
std::vector<Recording> read_recordings(const std::filesystem::path& folder);

/// Stands in for a real recording: 200 scans of our scanner model with all its faults, moving past
/// four obstacles. 1 % of the beams are too far and 1 % too near.
Recording simulated_recording();

}  // namespace server
