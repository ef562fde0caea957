// Lines of equal head and stream lines over a picture of the head, and the free surface.
#pragma once

#include "sage/draw/scenery.hpp"

namespace sage {

// Name of the picture: that of the head with its flow net.
inline constexpr std::string_view kFlowNet = "flow_net";

// Appends the lines to a picture, and gives the line that explains them.
std::string draw_flow_net(std::string& out, Scenery& scenery, int drops);

}  // namespace sage
