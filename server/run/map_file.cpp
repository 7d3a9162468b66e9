// server/run/map_file.cpp: a description of seven keys, and grey values as walls and free cells.
#include "server/run/map_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <set>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <yaml-cpp/yaml.h>

#include "server/run/pgm_picture.hpp"
#include "server/run/text_file.hpp"

namespace server {
namespace {

constexpr double kLongestMap = 2000;             // [m] edge
constexpr double kUsualOccupied = 0.65;          // of map_server
constexpr double kUsualFree = 0.196;             // of map_server
constexpr std::array kMapCells{0.005, 1.0};      // [m] least and most
constexpr std::size_t kMostDescription = 10000;  // [bytes]
constexpr unsigned char kFreeGrey = 254;
constexpr unsigned char kWallGrey = 0;
constexpr unsigned char kUnknownGrey = 205;

/// The description of a map. Names its file and the field in every complaint.
class MapFields {
 public:
  MapFields(const std::string& text, std::string name) : name_(std::move(name)) {
    if (text.size() > kMostDescription) fail("it is too long for the description of a map.");
    try {
      fields_ = YAML::Load(text);
    } catch (const YAML::Exception& error) {
      fail(fmt::format("it is no YAML: {} in line {}.", error.msg, error.mark.line + 1));
    }
    if (!fields_.IsMap()) fail("it has no lines of \"key: value\".");
    std::set<std::string> given;
    for (const auto& field : fields_) {
      const std::string key = field.first.IsScalar() ? field.first.Scalar() : "";
      if (std::ranges::find(kKnown, key) == kKnown.end()) {
        fail(fmt::format("\"{}\" is no field of a map.", key.substr(0, 40)));
      }
      if (!given.insert(key).second) fail(fmt::format("{} is given twice.", key));
    }
  }

  [[noreturn]] void fail(const std::string& why) const {
    throw std::runtime_error(name_ + ": " + why);
  }
  bool has(const char* key) const { return fields_[key].IsDefined(); }
  std::string text(const char* key) const {
    const YAML::Node field = fields_[key];
    if (!field.IsDefined()) fail(fmt::format("{} is missing.", key));
    if (!field.IsScalar() || field.Scalar().empty()) fail(fmt::format("{} must be a word.", key));
    return field.Scalar();
  }
  double number(const char* key, double low, double high, std::optional<double> usual = {}) const {
    if (usual && !has(key)) return *usual;
    const double value = number_of(fields_[key], text(key));
    if (value >= low && value <= high) return value;
    fail(fmt::format("{} must be a number from {} to {}.", key, low, high));
  }
  bool flag(const char* key) const {
    if (!has(key)) return false;
    bool value = false;
    const std::string word = text(key);
    if (word == "0" || word == "1") return word == "1";
    if (!YAML::convert<bool>::decode(fields_[key], value)) {
      fail(fmt::format("{} must be 0 or 1.", key));
    }
    return value;
  }
  algo::Vec2 origin() const {
    if (!has("origin")) fail("origin is missing.");
    const YAML::Node list = fields_["origin"];
    if (!list.IsSequence() || list.size() < 2 || list.size() > 3) {
      fail("origin must be [x, y, yaw].");
    }
    std::array<double, 3> values{};
    for (std::size_t k = 0; k < list.size(); ++k) {
      values[k] = number_of(list[k], list[k].IsScalar() ? list[k].Scalar() : "");
      if (!(std::abs(values[k]) <= kFarthestOrigin)) fail("origin must be three numbers.");
    }
    if (std::abs(values[2]) > kMostYaw) fail("origin is turned; only a yaw of 0 can be read.");
    return {values[0], values[1]};
  }

 private:
  static constexpr std::array<std::string_view, 7> kKnown{
      "image", "mode", "resolution", "origin", "negate", "occupied_thresh", "free_thresh"};
  static constexpr double kFarthestOrigin = 1e6;  // [m]
  static constexpr double kMostYaw = 1e-9;        // [rad] that counts as none

  /// NaN for other words than numbers.
  static double number_of(const YAML::Node& field, const std::string& word) {
    double value = 0;
    const bool good = !word.empty() && YAML::convert<double>::decode(field, value);
    return good ? value : std::nan("");
  }

  std::string name_;
  YAML::Node fields_{};
};

enum class MapCell : std::uint8_t { Unknown, Free, Wall };

/// The cells of a map as one rectangle, by rows from the lower left corner.
struct Raster {
  explicit Raster(const algo::OccupancyMap& map) {
    const auto tiles = map.tiles();
    if (tiles.empty()) return;
    constexpr int kSide = algo::OccupancyMap::kTileSide;
    constexpr std::size_t kEdge = kSide;
    algo::OccupancyMap::Index low = tiles.front();
    algo::OccupancyMap::Index high = tiles.front();
    for (const auto& tile : tiles) {
      low = {std::min(low.i, tile.i), std::min(low.j, tile.j)};
      high = {std::max(high.i, tile.i), std::max(high.j, tile.j)};
    }
    width = static_cast<std::size_t>(high.i - low.i + 1) * kEdge;
    height = static_cast<std::size_t>(high.j - low.j + 1) * kEdge;
    corner_M = map.cell_edge() * kSide * algo::Vec2(low.i, low.j);
    cells.resize(width * height, MapCell::Unknown);
    map.each_cell([&](const auto& cell, const auto& tally) {
      if (!tally.known()) return;
      const auto row = static_cast<std::size_t>(cell.j - low.j * kSide);
      const auto column = static_cast<std::size_t>(cell.i - low.i * kSide);
      cells[row * width + column] = tally.occupied() ? MapCell::Wall : MapCell::Free;
    });
  }

  std::size_t width = 0, height = 0;
  algo::Vec2 corner_M{0, 0};
  std::vector<MapCell> cells{};
};

/// The free cells that touch a wall.
struct FreeBeside {
  FreeBeside(const algo::OccupancyMap& map, const algo::OccupancyMap::Index& wall) {
    for (int dj = -1; dj <= 1; ++dj) {
      for (int di = -1; di <= 1; ++di) {
        const auto beside = map.at({wall.i + di, wall.j + dj});
        if (!beside.known() || beside.occupied()) continue;
        ++cells;
        sum += algo::Vec2(di, dj);
      }
    }
  }
  /// Towards them; unknown if they lie on both sides.
  algo::Facing facing() const {
    if (2 * sum.norm() < cells) return {};
    return {sum.normalized(), false};
  }

  int cells = 0;
  algo::Vec2 sum{0, 0};
};

}  // namespace

algo::OccupancyMap map_from(const std::string& description,
                            const std::string& name,
                            const std::function<std::string(const std::string&)>& read_picture) {
  const MapFields fields(description, name);
  const double cell = fields.number("resolution", kMapCells[0], kMapCells[1]);
  const algo::Vec2 origin_M = fields.origin();
  const bool negate = fields.flag("negate");
  const double occupied = fields.number("occupied_thresh", 0, 1, kUsualOccupied);
  const double free = fields.number("free_thresh", 0, 1, kUsualFree);
  if (free > occupied) fields.fail("free_thresh must not be above occupied_thresh.");
  const std::string mode = fields.has("mode") ? fields.text("mode") : "trinary";
  if (mode != "trinary" && mode != "scale") {
    fields.fail(fmt::format("mode \"{}\" cannot be read, only trinary and scale.", mode));
  }
  const std::string image = fields.text("image");
  const GreyPicture picture = read_pgm(read_picture(image), image);
  if (static_cast<double>(std::max(picture.width, picture.height)) * cell > kLongestMap) {
    fields.fail(fmt::format("the map is longer than {} m.", kLongestMap));
  }
  algo::OccupancyMap map(cell);
  bool any = false;
  for (std::size_t row = 0; row < picture.height; ++row) {
    for (std::size_t column = 0; column < picture.width; ++column) {
      const unsigned grey = picture.grey[row * picture.width + column];
      const double light = static_cast<double>(grey) / picture.most;
      const double dark = negate ? light : 1 - light;
      if (dark <= occupied && dark >= free) continue;
      const auto above = static_cast<double>(picture.height - 1 - row);
      const algo::Vec2 p_M =
          origin_M + cell * algo::Vec2(static_cast<double>(column) + 0.5, above + 0.5);
      if (dark > occupied) {
        map.mark_wall(p_M);
        any = true;
      } else {
        map.mark_free(p_M);
      }
    }
  }
  if (!any) fields.fail("the map shows no wall.");
  return map;
}

algo::Submap seen_walls(const algo::OccupancyMap& map) {
  algo::OccupancyMap seen(map.cell_edge());
  map.each_cell([&](const auto& cell, const auto& tally) {
    if (!tally.occupied()) return;
    const FreeBeside free(map, cell);
    if (free.cells > 0) seen.mark_wall(map.mean_W(cell, tally), free.facing());
  });
  return algo::Submap(seen.tiles().empty() ? map : seen);
}

algo::OccupancyMap read_map(const std::filesystem::path& yaml) {
  const std::string name = yaml.filename().string();
  return map_from(read_text(yaml), name, [&](const std::string& image) {
    try {
      return read_text(yaml.parent_path() / image);
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(name + ": image: " + error.what());
    }
  });
}

std::string map_document(const algo::OccupancyMap& map, const std::string& name) {
  const Raster raster(map);
  nlohmann::json runs = nlohmann::json::array();
  for (std::size_t k = 0; k < raster.cells.size();) {
    std::size_t end = k;
    while (end < raster.cells.size() && raster.cells[end] == raster.cells[k]) ++end;
    runs.push_back(static_cast<int>(raster.cells[k]));
    runs.push_back(end - k);
    k = end;
  }
  const nlohmann::json out = {{"name", name},
                              {"cell", map.cell_edge()},
                              {"x", raster.corner_M.x()},
                              {"y", raster.corner_M.y()},
                              {"columns", raster.width},
                              {"rows", raster.height},
                              {"cells", std::move(runs)}};
  return out.dump();
}

std::filesystem::path picture_beside(const std::filesystem::path& yaml) {
  std::filesystem::path picture = yaml;
  picture.replace_extension(".pgm");
  if (picture != yaml) return picture;
  throw std::runtime_error(
      yaml.string() + ": is the name of the map's picture; end that of its description in .yaml");
}

void write_map(const algo::OccupancyMap& map, const std::filesystem::path& yaml) {
  const std::filesystem::path picture = picture_beside(yaml);
  const Raster raster(map);
  if (raster.cells.empty()) {
    throw std::runtime_error("The map is empty, so there is none to write.");
  }
  constexpr std::array<char, 3> kGreys{
      static_cast<char>(kUnknownGrey), static_cast<char>(kFreeGrey), static_cast<char>(kWallGrey)};
  std::string grey;
  grey.reserve(raster.cells.size());
  for (std::size_t row = raster.height; row-- > 0;) {
    for (std::size_t k = row * raster.width; k < (row + 1) * raster.width; ++k) {
      grey.push_back(kGreys.at(static_cast<std::size_t>(raster.cells[k])));
    }
  }
  YAML::Emitter image;  // quotes a name such as "room #2.pgm"
  image << picture.filename().string();
  write_text(picture, fmt::format("P5\n{} {}\n255\n", raster.width, raster.height) + grey);
  write_text(yaml,
             fmt::format("image: {}\nresolution: {}\norigin: [{:.6f}, {:.6f}, 0]\nnegate: 0\n"
                         "occupied_thresh: {}\nfree_thresh: {}\n",
                         image.c_str(),
                         map.cell_edge(),
                         raster.corner_M.x(),
                         raster.corner_M.y(),
                         kUsualOccupied,
                         kUsualFree));
}

}  // namespace server
