// server/lab/reproduce/filter_scenes.hpp: the scans the filter study looks at: the three scenes of
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
  std::vector<std::uint8_t> valid{};  // 0 where the device wrote a code
};

struct Spike {
  std::size_t beam = 0;
  double mm = 0;  // what the scanner wrongly says
};

/// A scan of 360 values whose truth is known.
struct FilterScene {
  std::string name{};   // of its picture file
  std::string title{};  // for people
  int half_width = 0;   // N that the thesis uses here
  std::vector<Spike> spikes{};
  std::vector<double> truth_mm{};   // exact, not rounded
  std::vector<double> before_mm{};  // with the scanner's noise and rounding, and the spikes
};

/// (i) one obstacle, N = 1, spikes at beams 186, 264, 266, 272, 292; (ii) two obstacles, N = 2;
/// (iii) the same with a spike at beam 220. Nong 2008, chapter 3, Figs. 8-10.
///
/// What the thesis leaves open is ours: a robot before a wall 4 m ahead between walls 2 m to either
/// side, cylinders for obstacles, noise of 5 mm (1 sigma) rounded to whole millimetres, far spikes
/// at 8000 mm and the one on the obstacle at 200 mm.
std::vector<FilterScene> chapter_3_scenes();

/// The reference layout of the notes' own prototype: 3000 mm everywhere, 1500 mm at beams 150..210,
/// no noise, spikes as in scene (i).
FilterScene flat_scene();

/// Scans of one recording.
struct Recording {
  std::string name{};
  double step_mm = 1;  // [mm] the device's own step
  std::vector<ScanValues> scans{};
  bool simulated = false;
};

/// Every *.log of a folder, by name. Throws std::runtime_error with a sentence when the folder
/// holds none or one does not read.
std::vector<Recording> read_recordings(const std::filesystem::path& folder);

/// For want of a real one: 200 scans of our scanner model with all its faults, moving past four
/// obstacles, 1 % of the beams each too far and too near.
Recording simulated_recording();

}  // namespace server
