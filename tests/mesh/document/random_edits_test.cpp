// Any edits by chance on a sheet in each of the four formats: undone, the deck is saved byte for byte as it was; done again, as it was
// saved before; and read again it is the same model.
#include <array>
#include <cstdio>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "mesh/deck/save.h"
#include "mesh/model/adjacency.h"
#include "mesh/model/topology_change.h"
#include "tests/mesh/document/document_fixture.h"
#include "tests/support/seed.h"

namespace prismesh::mesh::document {
namespace {

constexpr int kColumns = 10, kRows = 8;
constexpr int kBatches = 4, kStepsEach = 8;
constexpr double kSize = 5;

int node_at(int i, int j) { return 1 + i + j * (kColumns + 1); }

std::string line_of(const char* format, auto... values) {
  std::array<char, 256> line{};
  std::snprintf(line.data(), line.size(), format, values...);
  return line.data();
}

/// What `node` and `shell` write of a sheet that is bent a little: of all nodes, of the shells of its left half, of those of its right
/// half.
template <class Node, class Shell>
std::array<std::string, 3> sheet(const Node& node, const Shell& shell) {
  std::array<std::string, 3> text;
  for (int j = 0; j <= kRows; ++j)
    for (int i = 0; i <= kColumns; ++i) text[0] += node(node_at(i, j), kSize * i, kSize * j, 0.03125 * i * i);
  for (int j = 0; j < kRows; ++j)
    for (int i = 0; i < kColumns; ++i)
      text[2 * i < kColumns ? 1 : 2] +=
          shell(1 + i + j * kColumns, node_at(i, j), node_at(i + 1, j), node_at(i + 1, j + 1), node_at(i, j + 1));
  return text;
}

std::string lsdyna_text() {
  const auto text = sheet([](int id, double x, double y, double z) { return line_of("%8d%16.6f%16.6f%16.6f\n", id, x, y, z); },
                          [](int id, int a, int b, int c, int d) {
                            return line_of("%8d%8d%8d%8d%8d%8d\n", id, id % kColumns == 0 || id % kColumns > 5 ? 2 : 1, a, b, c, d);
                          });
  std::string right;
  for (std::size_t at = 0; at < text[2].size(); at = text[2].find('\n', at) + 1)
    right += text[2].substr(at, text[2].find('\n', at) + 1 - at) +
             "             1.0             1.5             2.0             1.5            30.0\n";
  return "*KEYWORD\n*NODE\n" + text[0] + "*ELEMENT_SHELL\n" + text[1] + "*ELEMENT_SHELL_THICKNESS_BETA\n" + right +
         "*SET_NODE_LIST\n         1\n        14        15        16        25        26        27\n*SET_SHELL_LIST_GENERATE\n         2\n "
         "       21        39\n"
         "*SET_SEGMENT\n         3\n        14        15        26        25\n*INITIAL_STRESS_SHELL\n        22         1         1\n"
         "       0.0       1.0       2.0       3.0       0.0       0.0       0.0       0.0\n*BOUNDARY_SPC_NODE\n         1         0       "
         "  1         1         1\n"
         "         2         0         1         1         1\n*DATABASE_HISTORY_SHELL\n        45\n*PART\nleft\n         1         1       "
         "  1\n*PART\nright\n"
         "         2         1         1\n*SECTION_SHELL\n         1         2\n       1.5       1.5       1.5       1.5\n*MAT_ELASTIC\n"
         "         1  7.85E-09    210000       0.3\n*END\n";
}

std::string nastran_text() {
  const auto text =
      sheet([](int id, double x, double y, double z) { return line_of("GRID    %8d        %8.5f%8.5f%8.5f\n", id, x, y, z); },
            [](int id, int a, int b, int c, int d) { return line_of("CQUAD4  %8d       7%8d%8d%8d%8d    30.0\n", id, a, b, c, d); });
  return "SOL 101\nCEND\nBEGIN BULK\n" + text[0] + text[1] + text[2] +
         "SPC1           3  123456       1       2       3       4\nSET1           5      14      15      16      25      26      27\n"
         "PLOAD4         9      22     1.5\nPSHELL         7       1     1.5\nMAT1           1  2.1+5             0.3 7.85-9\nENDDATA\n";
}

std::string radioss_text() {
  const auto text = sheet([](int id, double x, double y, double z) { return line_of("%10d%20.6f%20.6f%20.6f\n", id, x, y, z); },
                          [](int id, int a, int b, int c, int d) { return line_of("%10d%10d%10d%10d%10d\n", id, a, b, c, d); });
  return "#RADIOSS STARTER\n/BEGIN\nsheet\n      2022         0\n                  kg                  mm                  ms\n"
         "                  kg                  mm                  ms\n/NODE\n" +
         text[0] + "/SHELL/1\n" + text[1] + "/SHELL/2\n" + text[2] +
         "/GRNOD/NODE/3\nsome\n        14        15        16        25        26        27\n/SURF/SEG/4\nface\n         1        14       "
         " 15        26        25\n"
         "/PART/1\nleft\n         1         1         0\n/PART/2\nright\n         1         1         0\n/END\n";
}

std::string abaqus_text() {
  const auto text = sheet([](int id, double x, double y, double z) { return line_of("%d, %.6f, %.6f, %.6f\n", id, x, y, z); },
                          [](int id, int a, int b, int c, int d) { return line_of("%d, %d, %d, %d, %d\n", id, a, b, c, d); });
  return "*HEADING\nsheet\n*NODE\n" + text[0] + "*ELEMENT, TYPE=S4R, ELSET=LEFT\n" + text[1] + "*ELEMENT, TYPE=S4R, ELSET=RIGHT\n" +
         text[2] +
         "*NSET, NSET=SOME\n14, 15, 16, 25, 26, 27\n*ELSET, ELSET=FEW\n22, 23, 24\n*SHELL SECTION, ELSET=LEFT, MATERIAL=STEEL\n1.5,\n"
         "*SHELL SECTION, ELSET=RIGHT, MATERIAL=STEEL\n1.5,\n*MATERIAL, NAME=STEEL\n*ELASTIC\n210000., 0.3\n*DENSITY\n7.85e-9,\n";
}

struct Sheet {
  const char* file;
  std::string (*text)();
  double digits;  ///< how far a coordinate may be from what was meant
};

Document open_sheet(const std::filesystem::path& path) {
  OpenOptions options;
  options.length_unit = LengthUnit::mm;
  options.target_size = kSize;
  return open(path, options).value();
}

std::string saved_text(const Document& document, const std::filesystem::path& target) {
  const Result<deck::SaveReport> saved = save(document, target);
  EXPECT_TRUE(saved) << saved.error().text();
  return saved ? content_of(target) : "";
}

/// An edit that a user might ask for; whether it can be done is another matter.
std::string any_edit(const Document& document, std::mt19937& random) {
  const Model& model = document.current().model;
  ShellIndex shell(random() % model.shell_count());
  while (model.is_removed(shell)) shell = ShellIndex(random() % model.shell_count());
  const ShellNodes& nodes = model.shell(shell);
  const std::size_t first = random() % static_cast<std::size_t>(nodes.corners());
  const NodeIndex a = nodes.node[first], b = nodes.node[(first + 1) % static_cast<std::size_t>(nodes.corners())];
  const auto shell_name = [&](ShellIndex s) { return "\"shell:" + std::to_string(model.shell_ids[s.value]) + '"'; };
  const auto node_id = [&](NodeIndex n) { return std::to_string(model.node_ids[n.value]); };
  std::string both = shell_name(shell);
  const auto at_edge = model.adjacency->shells_of(model.adjacency->find_edge(a, b));
  if (at_edge.size() == 2) both = shell_name(at_edge[0]) + "," + shell_name(at_edge[1]);
  switch (random() % 10) {
    case 0:
    case 1: return R"({"edit":"split","at":[)" + shell_name(shell) + "]}";
    case 2: return R"({"edit":"split","at":[)" + both + "]}";
    case 3:
    case 4: return R"({"edit":"collapse","at":["node:)" + node_id(a) + R"(","node:)" + node_id(b) + "\"]}";
    case 5: return R"({"edit":"swap","at":[)" + both + "]}";
    case 6: return R"({"edit":"merge","at":[)" + both + "]}";
    case 7: return R"({"edit":"lift","distance":0.75,"on":")" + node_id(a) + "," + node_id(b) + "\"}";
    case 8: return R"({"edit":"relax","scope":"damaged"})";
    default: return R"({"edit":"repair","scope":"failed"})";
  }
}

struct ById {
  std::map<std::int64_t, Vec3> nodes;
  std::map<std::int64_t, std::pair<std::array<std::int64_t, 4>, std::int64_t>> shells;  ///< corners and part
};
ById by_id(const Model& model) {
  ById out;
  for (std::size_t n = 0; n < model.node_count(); ++n)
    if (!model.is_removed(NodeIndex(n))) out.nodes[model.node_ids[n]] = model.positions[n];
  for (std::size_t s = 0; s < model.shell_count(); ++s) {
    if (model.is_removed(ShellIndex(s))) continue;
    auto& [corners, part] = out.shells[model.shell_ids[s]];
    for (std::size_t c = 0; c < 4; ++c) corners[c] = model.node_ids[model.shell_nodes[s].node[c].value];
    part = (*model.parts)[model.shell_parts[s].value].id;
  }
  return out;
}

void expect_read_again(const Document& document, const std::filesystem::path& file, double digits) {
  const Document again = open_sheet(file);
  const ById meant = by_id(document.current().model), read = by_id(again.current().model);
  EXPECT_EQ(meant.shells, read.shells);
  ASSERT_EQ(meant.nodes.size(), read.nodes.size());
  for (const auto& [id, at] : meant.nodes) {
    ASSERT_TRUE(read.nodes.contains(id)) << "node " << id;
    EXPECT_LE((read.nodes.at(id) - at).cwiseAbs().maxCoeff(), digits) << "node " << id;
  }
}

/// Every edge has one shell or two, and no shell has a node twice.
void expect_conforming(const Model& model) {
  for (std::size_t e = 0; e < model.adjacency->edge_count(); ++e) EXPECT_LE(model.adjacency->shells_of(EdgeIndex(e)).size(), 2u);
  for (std::size_t s = 0; s < model.shell_count(); ++s) {
    if (model.is_removed(ShellIndex(s))) continue;
    const ShellNodes& nodes = model.shell(ShellIndex(s));
    for (int i = 0; i < nodes.corners(); ++i)
      for (int k = 0; k < i; ++k) EXPECT_NE(nodes.node[static_cast<std::size_t>(i)], nodes.node[static_cast<std::size_t>(k)]);
  }
}

class RandomEdits : public ::testing::TestWithParam<Sheet> {};

TEST_P(RandomEdits, are_undone_to_the_byte_and_read_again_as_they_were_meant) {
  const Sheet& form = GetParam();
  const std::string text = form.text();
  std::size_t changed = 0;
  for (unsigned seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE(seed);
    const Folder folder;
    const std::filesystem::path source = folder / form.file, target = folder / ("out_" + std::string(form.file));
    put_content(source, text);
    Document document = open_sheet(source);
    std::mt19937 random(test::seed(seed));
    for (int batch = 0; batch < kBatches; ++batch) {
      for (int step = 0; step < kStepsEach; ++step)
        if (const Result<EditReport> done = try_apply(document, edit_of(any_edit(document, random))))
          changed += done->elements_added + done->elements_removed;
      const std::size_t steps = document.cursor;
      const std::string after = saved_text(document, target);
      expect_conforming(document.current().model);
      expect_read_again(document, target, form.digits);
      while (document.can_undo()) must_apply(document, R"({"edit":"undo"})");
      EXPECT_EQ(saved_text(document, target), text) << "undone";
      while (document.cursor < steps) must_apply(document, R"({"edit":"redo"})");
      EXPECT_EQ(saved_text(document, target), after) << "done again";
      if (HasFailure()) return;
      for (int back = static_cast<int>(random() % 3); back > 0 && document.can_undo(); --back) must_apply(document, R"({"edit":"undo"})");
    }
  }
  EXPECT_GT(changed, 20u) << "the edits by chance hardly changed the mesh";
}

INSTANTIATE_TEST_SUITE_P(Formats, RandomEdits,
                         ::testing::Values(Sheet{"sheet.k", lsdyna_text, 1e-6}, Sheet{"sheet.nas", nastran_text, 1e-4},
                                           Sheet{"sheet_0000.rad", radioss_text, 1e-9}, Sheet{"sheet.inp", abaqus_text, 1e-9}),
                         [](const auto& form) {
                           const std::string file = form.param.file;
                           return file.substr(file.find('.') + 1);
                         });

}  // namespace
}  // namespace prismesh::mesh::document
