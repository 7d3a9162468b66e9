// algo/common_layers.hpp: the descriptions of layers that several controllers show.
#pragma once

#include "algo/layer.hpp"

namespace algo::layers {

inline constexpr LayerInfo kStrip{
    .name = "strip", .label = "Strip", .kind = LayerKind::Polyline, .tone = Tone::Accent};
inline constexpr LayerInfo kStripAhead{.name = "strip.ahead",
                                       .label = "From the strip to the goal",
                                       .kind = LayerKind::Polyline,
                                       .tone = Tone::Accent,
                                       .style = LayerStyle::Dashed};
inline constexpr LayerInfo kPlan{.name = "plan",
                                 .label = "Plan",
                                 .kind = LayerKind::Polyline,
                                 .tone = Tone::Plan,
                                 .style = LayerStyle::Dashed};
// Candidate motions: those that could not stop in time, the others, and the chosen one.
inline constexpr LayerInfo kRefused{.name = "window.refused",
                                    .label = "Motions refused",
                                    .kind = LayerKind::Arcs,
                                    .frame = LayerFrame::Robot,
                                    .tone = Tone::Refused,
                                    .style = LayerStyle::Faint};
inline constexpr LayerInfo kAllowed{.name = "window.allowed",
                                    .label = "Motions weighed",
                                    .kind = LayerKind::Arcs,
                                    .frame = LayerFrame::Robot,
                                    .tone = Tone::Muted};
inline constexpr LayerInfo kChosen{.name = "window.chosen",
                                   .label = "Motion chosen",
                                   .kind = LayerKind::Arcs,
                                   .frame = LayerFrame::Robot,
                                   .tone = Tone::Accent};

}  // namespace algo::layers
