// How long reading a deck of many nodes takes.  Beside it: the same nodes read by a Fortran program, if there
// is one.
//   deck_read [nodes] [fortran program]
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>

#include "sage/deck/read_deck.hpp"

namespace {

// Processor time: other work on the machine does not count.
double now() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

// A deck whose nodes all have cards of their own, with coordinates of many digits.
void write_deck(const std::string& path, int nodes) {
  std::ofstream file(path);
  file << "Many nodes\nm       kN      kPa\n";
  file << fmt::format("{:5d}{:5d}{:5d}{:5d}{:5d}{:5d}{:5d}\n", 1, 0, std::min(nodes, 99999), 0, 0, 0, 0);
  for (int i = 1; i <= std::min(nodes, 99999); ++i)
    file << fmt::format("{:5d}{:5d}{:5d}{:10.5f}{:10.4f}{:10s}\n", i, 0, 0, 0.01234 * i, -0.0567 * i, "");
  file << "END\n";
}

}  // namespace

int main(int argc, char** argv) {
  const int nodes = argc > 1 ? std::atoi(argv[1]) : 99999;  // five columns hold no more
  const std::string path = (std::filesystem::temp_directory_path() / "sage_bench_deck.dat").string();
  write_deck(path, nodes);
  const auto bytes = std::filesystem::file_size(path);
  const auto layout_start = now();
  const sage::Layout layout = sage::load_layout("sage1");
  const double layout_time = now() - layout_start;
  double best = 1e9, sum = 0.0;
  for (int run = 0; run < 10; ++run) {
    const auto start = now();
    const sage::Deck deck = sage::read_deck(path, layout);
    best = std::min(best, now() - start);
    for (const sage::CardView& node : deck.all("node")) sum += node.real("x") + node.real("y");
  }
  fmt::print("layout sage1: {:.2f} ms\n", 1e3 * layout_time);
  fmt::print("{} nodes, {:.1f} MB: {:.1f} ms, {:.0f} MB/s, {:.1f} million fields/s (sum {:.6g})\n", nodes,
             1e-6 * static_cast<double>(bytes), 1e3 * best, 1e-6 * static_cast<double>(bytes) / best,
             6e-6 * nodes / best, sum / 10);
  const int failed = argc > 2 ? std::system((std::string(argv[2]) + " " + path).c_str()) : 0;
  std::filesystem::remove(path);
  return failed == 0 ? 0 : 1;
}
