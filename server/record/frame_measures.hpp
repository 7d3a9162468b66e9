// server/record/frame_measures.hpp: the measures of a controller as columns. A frame holds their
// values only; the names come with some frames, by the number of their legend.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace server {

class FrameMeasures {
 public:
  struct Column {
    std::string name{};  // "strip.left"
    std::string unit{};  // "m"
  };

  /// Takes the legend of a frame that brings one. `frame` is a valid frame, as decode_frame() takes
  /// it, that lies at an address divisible by 8.
  void learn(std::span<const std::byte> frame);
  /// In the order of their first legend.
  const std::vector<Column>& columns() const { return columns_; }
  /// Sets one value for each column, NaN where `frame` has none or its legend is not known.
  void read(std::span<const std::byte> frame, std::vector<double>& values) const;

 private:
  std::size_t column_of(const std::string& name, const std::string& unit);

  std::vector<Column> columns_{};
  std::map<std::uint32_t, std::vector<std::size_t>> legends_{};  // columns by number of the legend
};

}  // namespace server
