// Documents of small models made by hand, and what tests ask of them.
#pragma once

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "mesh/document/document.h"
#include "mesh/document/edit_json.h"
#include "mesh/document/edit_report.h"
#include "mesh/document/generation.h"
#include "mesh/document/open.h"
#include "mesh/document/prepare.h"
#include "mesh/document/save.h"
#include "mesh/document/selection.h"
#include "tests/support/make_model.h"

namespace prismesh::mesh::document {

/// A document of a model, as if it stood in a deck whose content is `content`.
inline Document make_document(Model model, std::size_t history_bytes = std::size_t{1} << 30, std::uint64_t content = 7) {
  auto deck = std::make_shared<deck::Deck>();
  deck->content = {content, 0};
  OpenOptions options;
  options.target_size = 5.0;  // of all parts
  options.length_unit = LengthUnit::mm;
  options.history_bytes = history_bytes;
  return open("model.k", {deck, std::move(model)}, options).value();
}

/// A sheet of columns x rows quads of 5 mm in the plane z = 0; ids as make_grid gives them.
inline Document make_sheet(int columns, int rows) {
  return make_document(test::make_grid(columns, rows, [](int i, int j) { return Vec3(5.0 * i, 5.0 * j, 0.0); }));
}

/// Two 4 x 4 sheets side by side, parts 1 and 2, sharing the nodes at x = 20; a beam (part 3) and a solid (part 4) hang on them.
inline Model make_assembly() {
  std::vector<test::NodeSpec> nodes;
  std::vector<test::ShellSpec> shells;
  for (int j = 0; j <= 4; ++j)
    for (int i = 0; i <= 8; ++i) nodes.push_back({100 + i + 10 * j, Vec3(5.0 * i, 5.0 * j, 0)});
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 8; ++i) {
      const std::int64_t corner = 100 + i + 10 * j;
      shells.push_back({1 + i + 8 * j, i < 4 ? 1 : 2, {corner, corner + 1, corner + 11, corner + 10}});
    }
  nodes.push_back({900, Vec3(0, 0, 50)});
  for (int k = 0; k < 7; ++k) nodes.push_back({910 + k, Vec3(50 + k, k % 3, 10 + k % 2)});
  const std::vector<test::ElementSpec> elements{{ElementClass::beam, 9, 3, {100, 900}},
                                                {ElementClass::solid, 1, 4, {148, 910, 911, 912, 913, 914, 915, 916}}};
  return test::make_model(nodes, shells, elements);
}

inline Edit edit_of(const std::string& json) {
  const Result<Edit> edit = parse_edit(json);
  if (!edit) ADD_FAILURE() << json << ": " << edit.error().text();
  return edit.value_or(Edit(Undo{}));
}

/// document::apply, by a name that std::apply (found for a variant) doesn't share.
inline Result<EditReport> try_apply(Document& document, const Edit& edit) { return apply(document, edit); }

inline EditReport must_apply(Document& document, const std::string& json) {
  Result<EditReport> report = try_apply(document, edit_of(json));
  if (!report) ADD_FAILURE() << json << ": " << report.error().text();
  return report.value_or(EditReport{});
}

/// The words of the refusal; empty if it was applied.
inline std::string refusal(Document& document, const std::string& json) {
  const Result<EditReport> report = try_apply(document, edit_of(json));
  return report ? "" : report.error().text();
}

inline std::vector<std::int64_t> selected_ids(const Document& document) {
  std::vector<std::int64_t> ids;
  for (const NodeIndex node : selected_nodes(document.current())) ids.push_back(document.current().model.node_ids[node.value]);
  return ids;
}

/// Where the node with this id is now.
inline Vec3 place_of(const Document& document, std::int64_t id) {
  const Model& model = document.current().model;
  return model.position(model.find_node(id));
}

template <class T>
bool same_bytes(const ChunkedArray<T>& a, const ChunkedArray<T>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (std::memcmp(&a[i], &b[i], sizeof(T)) != 0) return false;
  return true;
}

/// Bit for bit the same state, names and numbers included.
inline void expect_same(const Generation& a, const Generation& b) {
  EXPECT_TRUE(same_bytes(a.model.positions, b.model.positions));
  EXPECT_TRUE(same_bytes(a.node_marks, b.node_marks));
  EXPECT_TRUE(same_bytes(a.shell_marks, b.shell_marks));
  EXPECT_TRUE(same_bytes(a.quality, b.quality));
  EXPECT_EQ(*a.parts, *b.parts);
  EXPECT_EQ(a.selection_kind, b.selection_kind);
  EXPECT_EQ(a.selected_nodes, b.selected_nodes);
  EXPECT_EQ(a.selected_shells, b.selected_shells);
  EXPECT_EQ(a.counts, b.counts);
  EXPECT_EQ(a.number, b.number);
  EXPECT_EQ(a.made_by, b.made_by);
}

inline void expect_same(const Document& a, const Document& b) {
  ASSERT_EQ(a.generations.size(), b.generations.size());
  EXPECT_EQ(a.cursor, b.cursor);
  EXPECT_EQ(a.next_number, b.next_number);
  for (std::size_t i = 0; i < a.generations.size(); ++i) expect_same(*a.generations[i], *b.generations[i]);
}

/// A folder of its own that goes with the test.
class Folder {
 public:
  Folder() {
    // In memory where there is such a folder: the journal's tests write thousands of files.
    const std::filesystem::path memory = "/dev/shm";
    const bool in_memory = ::access(memory.c_str(), W_OK) == 0;
    std::string name = ((in_memory ? memory : std::filesystem::temp_directory_path()) / "prismesh-document-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) std::abort();
    path_ = name;
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

inline std::string content_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

inline void put_content(const std::filesystem::path& path, const std::string& text) {
  std::ofstream out(path, std::ios::binary | std::ios::trunc);
  out << text;
}

}  // namespace prismesh::mesh::document
