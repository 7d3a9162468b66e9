// server/lab/crowd/people_file.cpp: the lines of a recording, person by person.
#include "server/lab/crowd/people_file.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace server::crowd {
namespace {

constexpr double kFarthest = 1e4;   // [m] of a place from the origin
constexpr double kLastFrame = 1e9;  // of a recording
constexpr const char* kBlank = " \t\r,";
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";  // of some editors, in UTF-8

[[noreturn]] void refuse_line(const std::string& name, std::size_t line, const std::string& why) {
  throw std::runtime_error(fmt::format("{}, line {}: {}", name, line, why));
}

std::vector<std::string> words_of(const std::string& line) {
  std::vector<std::string> words;
  for (std::size_t at = line.find_first_not_of(kBlank); at != std::string::npos;) {
    const std::size_t end = line.find_first_of(kBlank, at);
    words.push_back(line.substr(at, end - at));
    at = line.find_first_not_of(kBlank, end);
  }
  return words;
}

/// The number that is the whole of `word`, within +-`most`.
std::optional<double> number_of(const std::string& word, double most) {
  double value = 0;
  const char* const end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, value);
  if (error != std::errc() || stop != end || !(std::abs(value) <= most)) return std::nullopt;
  return value;
}

/// Somebody's place, and the line that tells it.
struct PeopleLine {
  algo::ObstaclePath::Key key{};
  std::size_t number = 0;
};

/// The places of person `id` in order of time. A line that says the same again counts once; throws
/// if two lines differ.
std::vector<algo::ObstaclePath::Key> ordered(std::vector<PeopleLine> lines,
                                             const std::string& id,
                                             const std::string& name) {
  std::ranges::stable_sort(lines, {}, [](const PeopleLine& line) { return line.key.time; });
  std::vector<algo::ObstaclePath::Key> keys;
  std::size_t last = 0;  // the number of the line before
  for (const PeopleLine& line : lines) {
    if (!keys.empty() && keys.back().time == line.key.time) {
      if (keys.back().position_W == line.key.position_W) continue;
      refuse_line(name,
                  line.number,
                  fmt::format("person {} is at another place in frame {} than in line {}",
                              id,
                              frame_at(line.key.time),
                              last));
    }
    keys.push_back(line.key);
    last = line.number;
  }
  return keys;
}

void measure(Recording& recording) {
  recording.from = recording.walkers.front().from();
  recording.until = recording.from;
  recording.low = recording.high = recording.walkers.front().keys.front().position_W;
  for (const Walker& walker : recording.walkers) {
    recording.from = std::min(recording.from, walker.from());
    recording.until = std::max(recording.until, walker.until());
    for (const auto& key : walker.keys) {
      recording.low = recording.low.cwiseMin(key.position_W);
      recording.high = recording.high.cwiseMax(key.position_W);
    }
  }
}

}  // namespace

algo::Vec2 Walker::at(double time) const {
  const auto next = std::ranges::upper_bound(keys, time, {}, &algo::ObstaclePath::Key::time);
  if (next == keys.end()) return keys.back().position_W;
  if (next == keys.begin()) return next->position_W;
  const auto& last = *std::prev(next);
  const double share = (time - last.time) / (next->time - last.time);
  return last.position_W + share * (next->position_W - last.position_W);
}

std::string frame_at(double time) {
  return fmt::format("{:.10g}", time / kFrameTime);
}

Recording read_people(std::istream& lines, const std::string& name) {
  Recording recording{.name = name};
  std::map<std::string, std::size_t> index;
  std::vector<std::vector<PeopleLine>> places;  // of each walker
  std::size_t number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (number == 1 && line.starts_with(kByteOrderMark)) line.erase(0, kByteOrderMark.size());
    const std::vector<std::string> words = words_of(line);
    if (words.empty()) continue;
    if (words.size() != 4) {
      refuse_line(name, number, fmt::format("{} words instead of 'frame id x y'", words.size()));
    }
    const auto frame = number_of(words[0], kLastFrame);
    if (!frame) refuse_line(name, number, "'" + words[0] + "' is no number of a frame");
    const auto x = number_of(words[2], kFarthest);
    const auto y = number_of(words[3], kFarthest);
    if (!x || !y) {
      refuse_line(name, number, fmt::format("'{} {}' is no place in metres", words[2], words[3]));
    }
    const auto [known, is_new] = index.try_emplace(words[1], recording.walkers.size());
    if (is_new) {
      recording.walkers.push_back({.id = words[1]});
      places.emplace_back();
    }
    places[known->second].push_back({{*frame * kFrameTime, {*x, *y}}, number});
  }
  if (recording.walkers.empty()) throw std::runtime_error(name + " holds nobody");
  for (std::size_t i = 0; i < places.size(); ++i) {
    Walker& walker = recording.walkers[i];
    walker.keys = ordered(std::move(places[i]), walker.id, name);
  }
  measure(recording);
  return recording;
}

Recording read_people(const std::filesystem::path& file) {
  std::ifstream lines(file);
  if (!lines || std::filesystem::is_directory(file)) {
    throw std::runtime_error(file.string() + " cannot be read");
  }
  Recording recording = read_people(lines, file.string());
  recording.name = file.stem().string();
  return recording;
}

}  // namespace server::crowd
