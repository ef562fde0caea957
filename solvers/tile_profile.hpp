// The textbook active-column skyline with 8 x 8 tiles in place of scalars: column J of tiles is stored from its
// first tile top[J] down to the diagonal.  A tile is 64 contiguous doubles, so that inner loops run over
// vectors of 8.
//
// Tiles are stored by the elimination index k: term [k * 8 + i] of tile (K, J) belongs to k in K and i in J.
// That is U row by row, and L transposed; so one set of kernels serves U, L and the factor of L D L^T.
#pragma once

#include <vector>

#include "solvers/aligned_array.hpp"
#include "solvers/assembled_matrix.hpp"
#include "solvers/equation_graph.hpp"
#include "solvers/tile_kernels.hpp"

namespace sage {

struct TileProfile {
  int equations = 0;
  int tiles = 0;                     // tile columns
  std::vector<int> order;            // position in the elimination -> equation
  std::vector<int> position;         // equation -> position
  std::vector<int> top;              // first tile of every tile column; the diagonal tile is top <= J
  std::vector<std::int64_t> offset;  // tile (K, J), K < J, begins at term offset[J] + (K - top[J]) * 64
  IndexLists right;                  // tile row K -> columns J > K that hold a tile (K, J)
  std::int64_t terms() const { return offset.back(); }  // off-diagonal terms of one triangle

  int height(int J) const { return J - top[J]; }
  std::int64_t tile(int K, int J) const { return shape().tile(K, J); }
  ProfileShape shape() const {
    return {tiles, top.data(), offset.data(), right.start.data(), right.item.data()};
  }
};

// Numbers the equations and lays out the tiles.
TileProfile make_tile_profile(const EquationGraph& graph);

// Floating-point operations of L U, or of L D L^T, by whole tiles.
double factor_operations(const TileProfile& profile, bool symmetric);

// Where the terms of an assembled matrix go, sorted by tile column, so that a column is filled just before use.
struct TileScatter {
  std::vector<int> start{0};  // tile column J takes entries start[J] .. start[J + 1] - 1
  std::vector<int> source;    // index into the values
  std::vector<int>
      target;  // offset into the upper tiles, the lower tiles or the diagonal tiles, one after the other
};

// Targets are: upper tiles at 0, diagonal tiles at terms(), lower tiles behind them (unsymmetric matrices
// only). Throws std::length_error where a target exceeds 2^31 - 1.
TileScatter make_tile_scatter(const TileProfile& profile, const AssembledMatrix& matrix);

}  // namespace sage
