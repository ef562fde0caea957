#include "sage/analysis/skips/four_abreast.hpp"

#include <algorithm>

namespace sage {

void find_fours(GroupData& data) {
  data.four_elements = nullptr;
  data.four_law = nullptr;
  const Element& element = *data.group->element;
  const auto* const solid = std::get_if<const SolidLaw*>(&data.law);
  if (solid == nullptr || data.constant || data.wants_context || !data.dof_list.empty()) return;
  const auto* const law = dynamic_cast<const FourPointLaw<4>*>(*solid);
  if (element.traits().large_strain) data.four_law = law;
  if (!four_may_go_together(element.traits())) return;
  const auto* const elements = dynamic_cast<const FourElements*>(&element);
  if (elements == nullptr || law == nullptr) return;
  data.four_elements = elements;
  data.four_law = law;
}

void prepare_four_abreast(const Mesh& mesh, GroupData& data) {
  if (!data.geometry_four_abreast.empty()) return;
  const Group& group = *data.group;
  const auto size = static_cast<std::size_t>(data.four_elements->four_geometry_size());
  const int fours = (group.elements() + kAbreast - 1) / kAbreast;
  data.geometry_four_abreast.resize(size * static_cast<std::size_t>(fours * kAbreast));
  data.constant_four_abreast.assign(fours, 0);
  std::vector<double> geometry(static_cast<std::size_t>(group.element->traits().geometry_size()));
  Eigen::Matrix2Xd x;
  for (int e = 0; e < fours * kAbreast; ++e) {
    element_coordinates(mesh, group, std::min(e, group.elements() - 1), x);
    group.element->geometry(x, geometry);
    const auto four = static_cast<std::size_t>(e / kAbreast), place = static_cast<std::size_t>(e % kAbreast);
    data.four_elements->place_among_four(geometry,
                                         data.geometry_four_abreast.data() + four * kAbreast * size + place);
  }
}

PassFourAbreast::PassFourAbreast(GroupData& data, const Eigen::VectorXd& du) : data_(&data), du_(&du) {
  const ElementTraits& traits = data.group->element->traits();
  geometry_size_ = static_cast<std::size_t>(data.four_elements->four_geometry_size());
  dofs_ = data.dofs();
  points_ = static_cast<std::size_t>(traits.points);
  stresses_ = points_ * static_cast<std::size_t>(traits.law_size);
  history_ = points_ * static_cast<std::size_t>(data.state.history_size());
}

Outcome PassFourAbreast::evaluate(int first, double* f, double* K, bool& changed) const {
  const PointStates& committed = data_->state.committed;
  PointStates& trial = data_->state.trial;
  Four du[kMostDofsOfFour];
  std::array<const int*, kAbreast> nodes;
  FourElementsIn in;
  FourElementsOut out;
  in.geometry = data_->geometry_four_abreast.data() + static_cast<std::size_t>(first) * geometry_size_;
  in.du = reinterpret_cast<const double*>(du);
  in.law = data_->four_law;
  in.history = static_cast<std::size_t>(data_->state.history_size());
#pragma GCC unroll 4
  for (std::size_t l = 0; l < kAbreast; ++l) {
    const int element = std::min(first + static_cast<int>(l), data_->group->elements() - 1);
    const auto e = static_cast<std::size_t>(element), place = e - static_cast<std::size_t>(first);
    nodes[l] = data_->group->nodes_of(element);
    in.sigma0[l] = committed.sigma.data() + e * stresses_;
    in.eps0[l] = committed.eps.data() + e * stresses_;
    in.h0[l] = committed.h.data() + e * history_;
    out.sigma1[l] = trial.sigma.data() + e * stresses_;
    out.eps1[l] = trial.eps.data() + e * stresses_;
    out.h1[l] = trial.h.data() + e * history_;
    out.status[l] = trial.status.data() + e * points_;
    out.f[l] = f + place * dofs_;
    out.K[l] = K != nullptr ? K + place * dofs_ * dofs_ : nullptr;
  }
  for (std::size_t i = 0; i < dofs_; i += 2) {
    const auto at = [&](std::size_t l) { return du_->data() + DofMap::displacement(nodes[l][i / 2]); };
    load_pairs_of_four(at(0), at(1), at(2), at(3), du[i], du[i + 1]);
  }
  char& constant = data_->constant_four_abreast[first / kAbreast];
  const bool kept = K != nullptr && data_->keeps_matrices();
  out.changed = changed;
  out.constant = kept && constant != 0;
  const Outcome outcome = data_->four_elements->evaluate_four(in, out);
  changed = out.changed;
  if (kept) constant = outcome == Outcome::ok && out.constant ? 1 : 0;
  return outcome;
}

}  // namespace sage
