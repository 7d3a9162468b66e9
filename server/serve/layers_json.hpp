// server/serve/layers_json.hpp: the layers of a tick as foxglove.SceneUpdate, drawn by kind.
#pragma once

#include <string>

#include "algo/telemetry.hpp"

namespace server {

/// One entity per layer, with the layer's name as id. An entity expires by itself if no further
/// tick brings its layer: after half a second, a grid after six.
std::string layers_json(const algo::Telemetry& t);

}  // namespace server
