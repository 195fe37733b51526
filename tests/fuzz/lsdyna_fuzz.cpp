// Any bytes as a deck: opening never crashes or hangs; what opens is saved byte for byte; and after moving nodes the saved
// deck opens again with the same entities and the new positions.
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "mesh/deck/deck.h"

namespace {

namespace fs = std::filesystem;
using prismesh::mesh::Model;
using prismesh::mesh::Vec3;
namespace deck = prismesh::mesh::deck;

#define REQUIRE(condition) \
  if (!(condition)) std::abort()

/// A folder of this process, removed at its end.
struct Folder {
  fs::path path = fs::temp_directory_path() / ("prismesh-fuzz-" + std::to_string(::getpid()));
  Folder() { fs::create_directories(path / "out"); }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
};

std::string content(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Every free node moves in x, stays in y, and is stretched in z.
Model moved(const Model& model) {
  Model out = model;
  for (std::size_t i = 0; i < model.node_count(); ++i) {
    const Vec3& from = model.positions[i];
    const Vec3 to(from.x() + 1.0 / 3, from.y(), from.z() * 1.7);
    if (model.node_holds[i] == 0 && to.allFinite()) out.positions.set(i, to);
  }
  return out;
}

bool near(double a, double b) { return std::abs(a - b) <= 1e-7 * std::max(std::abs(a), std::abs(b)); }

void require_same(const Model& wanted, const Model& found) {
  REQUIRE(wanted.node_count() == found.node_count());
  REQUIRE(wanted.shell_count() == found.shell_count());
  for (std::size_t i = 0; i < wanted.node_count(); ++i) {
    REQUIRE(wanted.node_ids[i] == found.node_ids[i]);
    for (int axis = 0; axis < 3; ++axis) REQUIRE(near(wanted.positions[i][axis], found.positions[i][axis]));
  }
  for (std::size_t i = 0; i < wanted.shell_count(); ++i) REQUIRE(wanted.shell_nodes[i] == found.shell_nodes[i]);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Folder folder;
  const fs::path path = folder.path / "deck.k";
  const fs::path out = folder.path / "out" / "deck.k";
  const std::string text(reinterpret_cast<const char*>(data), size);
  std::ofstream(path, std::ios::binary) << text;
  const auto opened = deck::open(path);
  if (!opened) return 0;
  const bool alone = opened->deck->files.size() == 1;
  if (alone) {
    REQUIRE(deck::save(*opened->deck, opened->model, opened->model, out));
    REQUIRE(content(out) == text);
    const Model wanted = moved(opened->model);
    REQUIRE(deck::save(*opened->deck, opened->model, wanted, out));
    const auto again = deck::open(out);
    REQUIRE(again);
    require_same(wanted, again->model);
  }
  return 0;
}
