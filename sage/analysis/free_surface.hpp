// The free surface of water in soil that falls dry above it (laws that are eased: PointContext::easing).
#pragma once

#include <span>
#include <vector>

#include "sage/analysis/group_data.hpp"

namespace sage {

bool has_free_surface(const GroupData& data);

// Where the pressure head passes through 0 along edges of elements, each edge once; sorted by x, then y.
// active: one flag per group.  u: all unknowns.
std::vector<Vector2> free_surface(const Model& model, const std::vector<char>& active,
                                  std::span<const GroupData> groups, const DofMap& dof_map,
                                  const Eigen::VectorXd& u);

// How far an answer is from that of a sharp surface.  0 where there is none.
struct FreeSurfaceBlur {
  double half_dry = 0.0;  // volume of soil between wet and dry, over that of wet soil
  double dry_flow = 0.0;  // part of the flow (volume times velocity) that goes through soil that is all but dry
};
FreeSurfaceBlur free_surface_blur(const Model& model, std::span<const GroupData> groups);

}  // namespace sage
