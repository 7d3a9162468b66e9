// server/serve/layers_json.hpp: the layers of a tick as foxglove.SceneUpdate, drawn by kind.
#pragma once

#include <string>

#include "algo/telemetry.hpp"

namespace server {

/// One entity a layer, whose id is the layer's name. An entity goes by itself when no further tick
/// brings its layer: after half a second, a grid after six.
std::string layers_json(const algo::Telemetry& t);

}  // namespace server
