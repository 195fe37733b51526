// Decks as text in a folder of the test's own.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "mesh/deck/data/deck.h"
#include "mesh/deck/open.h"

namespace prismesh::mesh::deck {

/// A folder that goes when the test does.
class DeckFolder {
 public:
  DeckFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "prismesh-deck-XXXXXX").string();
    path_ = ::mkdtemp(name.data());
  }
  DeckFolder(const DeckFolder&) = delete;
  DeckFolder& operator=(const DeckFolder&) = delete;
  ~DeckFolder() {
    std::error_code ignored;
    std::filesystem::permissions(path_, std::filesystem::perms::owner_all, ignored);
    std::filesystem::remove_all(path_, ignored);
  }

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(std::string_view name) const { return path_ / name; }

  std::filesystem::path write(std::string_view name, std::string_view text) const {
    const std::filesystem::path file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << text;
    return file;
  }
  /// Writes "deck.k" and opens it.
  Result<OpenedDeck> open(std::string_view text) const { return deck::open(write("deck.k", text)); }

 private:
  std::filesystem::path path_;
};

inline std::string content(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The warning of a kind; count 0 if there is none.
inline Warning warning(const Deck& deck, std::string_view kind) {
  for (const Warning& warning : deck.warnings)
    if (warning.kind == kind) return warning;
  Warning none;
  none.count = 0;
  return none;
}

inline Vec3 position_of(const Model& model, std::int64_t id) {
  const NodeIndex node = model.find_node(id);
  EXPECT_TRUE(node.valid()) << "node " << id;
  return node.valid() ? model.position(node) : Vec3(-1e300, -1e300, -1e300);
}

inline std::array<std::int64_t, 4> corners_of(const Model& model, std::int64_t shell_id) {
  const ShellIndex shell = model.find_shell(shell_id);
  EXPECT_TRUE(shell.valid()) << "shell " << shell_id;
  std::array<std::int64_t, 4> ids{};
  if (shell.valid())
    for (std::size_t i = 0; i < 4; ++i) ids[i] = model.node_ids[model.shell(shell).node[i].value];
  return ids;
}

/// `model` with a node elsewhere.
inline Model with_node_at(const Model& model, std::int64_t id, const Vec3& position) {
  Model out = model;
  out.positions.set(model.find_node(id).value, position);
  return out;
}

#define ASSERT_OPENED(opened) ASSERT_TRUE(opened) << (opened).error().text()

}  // namespace prismesh::mesh::deck
