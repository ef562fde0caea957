// How long reading a deck of many nodes and elements takes, and the memory for it.  Beside it: the same cards read
// by a Fortran program, if there is one.
//   deck_read [nodes a side] [fortran program]
#include <fmt/format.h>
#include <sys/resource.h>

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

// A rectangle of n x n nodes with a card each, their coordinates of many digits, and a card for every element.
void write_deck(const std::string& path, int n) {
  std::ofstream file(path);
  file << "Many nodes and elements\nm       kN      kPa\n";
  file << fmt::format("{:5d}{:5d}{:5d}{:5d}{:5d}{:5d}{:5d}\n", 1, 0, n * n, 0, 0, 0, (n - 1) * (n - 1));
  for (int i = 0; i < n * n; ++i)
    file << fmt::format("{:5d}{:5d}{:5d}{:10.5f}{:10.4f}\n", i + 1, 0, 0, 0.01234 * (i % n), -0.0567 * (i / n));
  for (int j = 0, number = 1; j + 1 < n; ++j)
    for (int i = 1; i < n; ++i, ++number)
      file << fmt::format("{:5d}{:5d}{:5d}{:5d}{:5d}{:5d}\n", number, 1, j * n + i, j * n + i + 1,
                          (j + 1) * n + i + 1, (j + 1) * n + i);
  file << "END\n";
}

long peak_kilobytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

}  // namespace

int main(int argc, char** argv) {
  const int n = argc > 1 ? std::atoi(argv[1]) : 316;  // 99 856 nodes: five columns hold few more
  const std::string path = (std::filesystem::temp_directory_path() / "sage_bench_deck.dat").string();
  write_deck(path, n);
  const auto bytes = static_cast<double>(std::filesystem::file_size(path));
  const auto layout_start = now();
  const sage::Layout layout = sage::load_layout("sage1");
  const double layout_time = now() - layout_start;
  double best = 1e9, sum = 0.0;
  long peak = 0;
  for (int run = 0; run < 10; ++run) {
    const auto start = now();
    const sage::Deck deck = sage::read_deck(path, layout);
    best = std::min(best, now() - start);
    if (run == 0) peak = peak_kilobytes();
    for (const sage::CardView& node : deck.all("node")) sum += node.real("x") + node.real("y");
  }
  const int nodes = n * n, elements = (n - 1) * (n - 1);
  fmt::print("layout sage1: {:.2f} ms\n", 1e3 * layout_time);
  fmt::print("{} nodes and {} elements, {:.1f} MB: {:.1f} ms, {:.0f} MB/s, peak {:.1f} MB (sum {:.6g})\n",
             nodes, elements, 1e-6 * bytes, 1e3 * best, 1e-6 * bytes / best, 1e-3 * static_cast<double>(peak),
             sum / 10);
  const int failed = argc > 2 ? std::system((std::string(argv[2]) + " " + path).c_str()) : 0;
  std::filesystem::remove(path);
  return failed == 0 ? 0 : 1;
}
