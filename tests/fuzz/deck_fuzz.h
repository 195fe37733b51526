// What holds of any bytes as a deck of any format: opening never crashes or hangs; what opens is saved byte for byte, file by file; and
// after moving nodes the saved deck opens again with the same entities and the new positions, and a second saving changes nothing.
#pragma once

#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <string_view>

#include <Eigen/SVD>

#include "mesh/deck/data/deck.h"
#include "mesh/deck/open.h"
#include "mesh/deck/save.h"

namespace prismesh::fuzz {

namespace fs = std::filesystem;
using mesh::Model;
using mesh::Vec3;
namespace deck = mesh::deck;

#define REQUIRE(condition)                                                             \
  if (!(condition)) {                                                                  \
    std::fprintf(stderr, "%s:%d: doesn't hold: %s\n", __FILE__, __LINE__, #condition); \
    std::abort();                                                                      \
  }

/// What follows this byte in the input is an include file of the deck: "a.inc", "b.inc", ... A deck may name itself, too.
constexpr char kNextFile = '\x1c';
constexpr std::array<const char*, 3> kIncludes = {"a.inc", "b.inc", "sub/c.inc"};

/// A folder of this process in memory where there is such a place, removed at its end.
struct Folder {
  fs::path path =
      (fs::is_directory("/dev/shm") ? fs::path("/dev/shm") : fs::temp_directory_path()) / ("prismesh-fuzz-" + std::to_string(::getpid()));
  Folder() {
    fs::create_directories(in() / "sub");
    fs::create_directories(out());
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
  fs::path in() const { return path / "in"; }
  fs::path out() const { return path / "saved" / "out"; }  ///< where no deck's includes look by chance
};

inline std::string content(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

inline void write(const fs::path& path, std::string_view text) { std::ofstream(path, std::ios::binary) << text; }

inline void remove_includes(const fs::path& folder) {
  for (const char* include : kIncludes) {
    std::error_code ignored;
    fs::remove(folder / include, ignored);
  }
}

/// The main file and those includes that the input has; those of the input before are gone.
inline void write_files(const fs::path& folder, const char* name, std::string_view input) {
  remove_includes(folder);
  std::size_t end = std::min(input.find(kNextFile), input.size());
  write(folder / name, input.substr(0, end));
  for (const char* include : kIncludes) {
    if (end == input.size()) return;
    input.remove_prefix(end + 1);
    end = std::min(input.find(kNextFile), input.size());
    write(folder / include, input.substr(0, end));
  }
}

/// Every free node moves in x, stays in y, and is stretched in z.
inline Model moved(const Model& model) {
  Model out = model;
  for (std::size_t i = 0; i < model.node_count(); ++i) {
    const Vec3& from = model.positions[i];
    const Vec3 to(from.x() + 1.0 / 3, from.y(), from.z() * 1.7);
    if (model.node_holds[i] == 0 && to.allFinite()) out.positions.set(i, to);
  }
  return out;
}

/// How far off a node may be after its card was written anew; nothing of where it is can be asked for in a system whose angles or
/// directions make much of little.
inline double allowed_distance(const deck::Deck& deck, std::size_t node, const Vec3& wanted, double accuracy) {
  const deck::Frame& frame = deck.frames[deck.run_of(mesh::NodeIndex(node)).frame];
  if (frame.is_basic()) return accuracy * std::max(wanted.norm(), 1e-300);
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(frame.to_basic.linear());
  const double condition = svd.singularValues()(0) / svd.singularValues()(2);
  if (frame.kind != deck::Frame::Kind::rectangular || !(condition < 1e3)) return std::numeric_limits<double>::infinity();
  return 4 * accuracy * condition * (wanted.norm() + frame.to_basic.translation().norm());
}

inline void require_same(const deck::Deck& deck, const Model& wanted, const Model& found, double accuracy) {
  REQUIRE(wanted.node_count() == found.node_count());
  REQUIRE(wanted.shell_count() == found.shell_count());
  for (std::size_t i = 0; i < wanted.node_count(); ++i) {
    REQUIRE(wanted.node_ids[i] == found.node_ids[i]);
    const double distance = (wanted.positions[i] - found.positions[i]).norm();
    REQUIRE(!(distance > allowed_distance(deck, i, wanted.positions[i], accuracy)));
  }
  for (std::size_t i = 0; i < wanted.shell_count(); ++i) REQUIRE(wanted.shell_nodes[i] == found.shell_nodes[i]);
}

inline void require_same_files(const deck::Deck& deck, const fs::path& folder, const fs::path& main) {
  REQUIRE(content(main) == content(deck.files.front().path));
  for (std::size_t i = 1; i < deck.files.size(); ++i) REQUIRE(content(folder / deck.files[i].relative) == content(deck.files[i].path));
}

inline void require_places(const deck::Deck& deck) {
  for (const deck::Warning& warning : deck.warnings) {
    REQUIRE(!warning.kind.empty() && !warning.message.empty() && warning.count > 0);
    REQUIRE(warning.line >= 0);
  }
}

/// `name`: the main file's, with the format's usual extension. `accuracy`: what the format's narrowest field keeps of a position, relative.
/// Does nothing with what isn't of the format.
inline void try_deck(deck::Format format, const char* name, const std::uint8_t* data, std::size_t size, double accuracy = 1e-7) {
  static const Folder folder;
  const fs::path path = folder.in() / name;
  const fs::path out = folder.out() / name;
  write_files(folder.in(), name, std::string_view(reinterpret_cast<const char*>(data), size));
  remove_includes(folder.out());  // else a missing include would be found among those saved before
  const auto opened = deck::open(path);
  if (!opened) {
    REQUIRE(!opened.error().message.empty() && !opened.error().file.empty());
    return;
  }
  require_places(*opened->deck);
  if (opened->deck->format != format) return;
  const auto saved = deck::save(*opened->deck, opened->model, opened->model, out);
  if (!saved) {  // an include outside the folder
    REQUIRE(opened->deck->files.size() > 1);
    return;
  }
  REQUIRE(saved->lines_changed == 0);
  require_same_files(*opened->deck, out.parent_path(), out);
  const Model wanted = moved(opened->model);
  const auto changed = deck::save(*opened->deck, opened->model, wanted, out);
  REQUIRE(changed);
  const auto again = deck::open(out);
  REQUIRE(again);
  require_same(*opened->deck, wanted, again->model, accuracy);
}

}  // namespace prismesh::fuzz
