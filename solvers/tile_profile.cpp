#include "solvers/tile_profile.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "solvers/profile_numbering.hpp"

namespace sage {

namespace {

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

void find_tops(const EquationGraph& graph, TileProfile& profile) {
  profile.top.resize(at(profile.tiles));
  for (int J = 0; J < profile.tiles; ++J) profile.top[at(J)] = J;
  std::vector<int> first(at(graph.members.count()));
  for (int g = 0; g < graph.members.count(); ++g) {
    first[at(g)] = profile.equations;
    for (const int equation : graph.members.of(g))
      first[at(g)] = std::min(first[at(g)], profile.position[at(equation)]);
  }
  for (int p = 0; p < profile.equations; ++p) {
    const int group = graph.group_of[at(profile.order[at(p)])];
    int least = std::min(p, first[at(group)]);
    for (const int other : graph.neighbours.of(group)) least = std::min(least, first[at(other)]);
    int& top = profile.top[at(p / kTile)];
    top = std::min(top, least / kTile);
  }
}

void list_rows(TileProfile& profile) {
  IndexLists& right = profile.right;
  right.start.assign(at(profile.tiles) + 1, 0);
  for (int J = 0; J < profile.tiles; ++J)
    for (int K = profile.top[at(J)]; K < J; ++K) ++right.start[at(K) + 1];
  for (std::size_t K = 1; K < right.start.size(); ++K) right.start[K] += right.start[K - 1];
  right.item.resize(at(right.start.back()));
  std::vector<int> end(right.start.begin(), right.start.end() - 1);
  for (int J = 0; J < profile.tiles; ++J)
    for (int K = profile.top[at(J)]; K < J; ++K) right.item[at(end[at(K)]++)] = J;
}

}  // namespace

TileProfile make_tile_profile(const EquationGraph& graph) {
  TileProfile profile;
  profile.equations = static_cast<int>(graph.group_of.size());
  profile.tiles = (profile.equations + kTile - 1) / kTile;
  profile.order = expand(graph, best_profile_numbering(graph));
  delay_pressures(graph, profile.order);
  profile.position.resize(profile.order.size());
  for (std::size_t p = 0; p < profile.order.size(); ++p)
    profile.position[at(profile.order[p])] = static_cast<int>(p);
  find_tops(graph, profile);
  profile.offset.assign(1, 0);
  for (int J = 0; J < profile.tiles; ++J)
    profile.offset.push_back(profile.offset.back() + static_cast<std::int64_t>(profile.height(J)) * kTileTerms);
  list_rows(profile);
  return profile;
}

TileScatter make_tile_scatter(const TileProfile& profile, const AssembledMatrix& matrix) {
  const std::int64_t diagonal = profile.terms();
  const std::int64_t lower = diagonal + static_cast<std::int64_t>(profile.tiles) * kTileTerms;
  if (lower + diagonal > std::numeric_limits<int>::max())
    throw std::length_error("the profile has more than 2^31 terms: choose a sparse solver");
  TileScatter scatter;
  scatter.start.assign(at(profile.tiles) + 1, 0);
  const auto visit = [&](auto&& use) {
    for (int column = 0; column < profile.equations; ++column)
      for (int k = matrix.column_start()[at(column)]; k < matrix.column_start()[at(column) + 1]; ++k)
        use(k, profile.position[at(matrix.row()[at(k)])], profile.position[at(column)]);
  };
  visit([&](int, int i, int j) { ++scatter.start[at(std::max(i, j) / kTile) + 1]; });
  for (std::size_t J = 1; J < scatter.start.size(); ++J) scatter.start[J] += scatter.start[J - 1];
  scatter.source.resize(matrix.row().size());
  scatter.target.resize(matrix.row().size());
  std::vector<int> end(scatter.start.begin(), scatter.start.end() - 1);
  visit([&](int k, int i, int j) {
    const int I = i / kTile, J = j / kTile;
    const auto slot = at(end[at(std::max(I, J))]++);
    std::int64_t target = diagonal + J * kTileTerms + (i % kTile) * kTile + j % kTile;
    if (I < J || (I > J && matrix.symmetric()))
      target = I < J ? profile.tile(I, J) + (i % kTile) * kTile + j % kTile
                     : profile.tile(J, I) + (j % kTile) * kTile + i % kTile;
    else if (I > J)
      target = lower + profile.tile(J, I) + (j % kTile) * kTile + i % kTile;
    else if (matrix.symmetric())  // the upper triangle of a diagonal tile
      target =
          diagonal + J * kTileTerms + std::min(i % kTile, j % kTile) * kTile + std::max(i % kTile, j % kTile);
    scatter.source[slot] = k;
    scatter.target[slot] = static_cast<int>(target);
  });
  return scatter;
}

double factor_operations(const TileProfile& profile, bool symmetric) {
  constexpr double kProduct = 2.0 * kTile * kTileTerms;  // of two tiles
  double arm = 0.0, diagonal = 0.0;                      // products of tiles above the diagonal, and on it
  for (int J = 0; J < profile.tiles; ++J) {
    for (int K = profile.top[at(J)]; K < J; ++K)
      arm += K - std::max(profile.top[at(K)], profile.top[at(J)]) + 0.5;
    diagonal += profile.height(J) + 1.0 / 3.0;
  }
  return kProduct * ((symmetric ? 1.0 : 2.0) * arm + diagonal);
}

}  // namespace sage
