// server/experiment/sweep/rows.hpp: the runs of an experiment by number, their figures side by
// side: 100,000 runs take some 30 MB.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "server/experiment/trial.hpp"

namespace server::sweep {

/// Of a run that has not ended, only has() may be asked. Threads may set different runs at the same
/// time.
class Rows {
 public:
  Rows() = default;
  /// `size` runs, none of which has ended.
  explicit Rows(std::size_t size);

  /// The figures of a run, in order: the columns of judges().
  static const std::vector<std::string_view>& columns();

  std::size_t size() const { return marks_.size(); }
  bool has(std::size_t run) const { return is(run, kEnded); }
  algo::Outcome outcome(std::size_t run) const { return outcomes_[run]; }
  const std::string& reason(std::size_t run) const { return reasons_[run]; }
  bool broken(std::size_t run) const { return is(run, kBroken); }
  /// True if the program died twice while the run was under way. The run is broken too.
  bool killed_twice(std::size_t run) const { return is(run, kKilledTwice); }
  /// Coarse; empty unless Plan::keeps_track().
  const std::vector<algo::Vec2>& track_W(std::size_t run) const { return tracks_[run]; }
  /// NaN if it is not known, or no figure of columns().
  double figure(std::size_t run, std::string_view column) const;
  /// All of the run but its ticks. Without figures if it broke before it had any.
  experiment::Row row(std::size_t run) const;

  /// Throws std::out_of_range if the row has a figure that is not in columns().
  void set(std::size_t run, const experiment::Row& row);
  void set_killed_twice(std::size_t run);
  void erase(std::size_t run);

 private:
  static constexpr std::uint8_t kEnded = 1;
  static constexpr std::uint8_t kBroken = 2;
  static constexpr std::uint8_t kMeasured = 4;  // has figures
  static constexpr std::uint8_t kKilledTwice = 8;
  bool is(std::size_t run, std::uint8_t mark) const { return (marks_[run] & mark) != 0; }

  std::vector<std::uint8_t> marks_{};
  std::vector<algo::Outcome> outcomes_{};
  std::vector<std::string> reasons_{};
  std::vector<std::vector<algo::Vec2>> tracks_{};  // empty of most runs
  std::vector<double> figures_{};  // run after run, in the order of columns(); NaN: not known
};

}  // namespace server::sweep
