// What a repair leaves failing, no single operation by hand heals, nor does another repair.
#include <algorithm>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh/document/damage.h"
#include "mesh/model/adjacency.h"
#include "mesh/model/topology_change.h"
#include "tests/mesh/document/document_fixture.h"

namespace prismesh::mesh::document {
namespace {

using testing::IsEmpty;

constexpr int kSheetColumns = 24, kSheetRows = 16;

int node_id(int i, int j) { return 1 + i + j * (kSheetColumns + 1); }

/// A sheet of quads of about 5 mm with a bead along it as an LS-DYNA deck; a shaping edit, both by chance.
struct ShapedSheet {
  std::string deck = "*KEYWORD\n*NODE\n";
  std::string edit;

  explicit ShapedSheet(unsigned seed) {
    std::mt19937 random(seed);
    // Not std::uniform_real_distribution, which differs between libraries.
    const auto within = [&](double low, double high) { return low + (high - low) * static_cast<double>(random() % 10000) / 9999; };
    const double height = within(4, 10), foot = within(20, 30), flank = within(4, 10), top = within(10, 20), unevenness = within(0, 1.2);
    char line[128];
    for (int j = 0; j <= kSheetRows; ++j)
      for (int i = 0; i <= kSheetColumns; ++i) {
        const bool is_inside = i > 0 && j > 0 && i < kSheetColumns && j < kSheetRows;
        const double x = 5.0 * i + (is_inside ? within(-unevenness, unevenness) : 0), y = 5.0 * j;
        const double from_middle = std::abs(y - foot - flank - top / 2) - top / 2;
        const double z = height * std::clamp(1 - from_middle / flank, 0.0, 1.0);
        std::snprintf(line, sizeof line, "%8d%16.6f%16.6f%16.6f\n", node_id(i, j), x, y, z);
        deck += line;
      }
    deck += "*ELEMENT_SHELL\n";
    for (int j = 0; j < kSheetRows; ++j)
      for (int i = 0; i < kSheetColumns; ++i) {
        std::snprintf(line, sizeof line, "%8d%8d%8d%8d%8d%8d\n", 1 + i + j * kSheetColumns, 1, node_id(i, j), node_id(i + 1, j),
                      node_id(i + 1, j + 1), node_id(i, j + 1));
        deck += line;
      }
    deck +=
        "*PART\nsheet\n         1         1         1\n*SECTION_SHELL\n         1         2\n       1.0       1.0       1.0       1.0\n"
        "*MAT_ELASTIC\n         1  7.85E-09    210000       0.3\n*END\n";
    const int kind = static_cast<int>(random() % 4);
    const int i0 = static_cast<int>(random() % 12), j0 = static_cast<int>(random() % 6);
    const int i1 = i0 + 7 + static_cast<int>(random() % 5), j1 = j0 + 6 + static_cast<int>(random() % 4);
    std::string on;
    const int last_row = kind == 2 ? kSheetRows : j1, first_row = kind == 2 ? 0 : j0, last = kind == 2 ? kSheetColumns : i1;
    for (int j = first_row; j <= last_row; ++j)
      on += (on.empty() ? "" : ",") + std::to_string(node_id(i0, j)) + "-" + std::to_string(node_id(last, j));
    const char* profiles[] = {"root", "smooth", "sphere", "linear"};
    const std::string falloff = std::string(R"(,"falloff":{"profile":")") + profiles[random() % 4] + "\"}}";
    const double size = within(0.6, 1.4);
    if (kind == 2) {  // the end of the sheet is pulled away
      std::snprintf(line, sizeof line, R"("by":[%.3f,0,0])", 30 * size);
      edit = R"({"edit":"translate","on":")" + on + "\"," + line + falloff;
    } else if (kind == 3) {
      std::snprintf(line, sizeof line, R"("degrees":%.3f)", 40 * size);
      const int middle = node_id((i0 + i1) / 2, (j0 + j1) / 2);
      std::string point = "[" + std::to_string(5 * (i0 + i1) / 2) + "," + std::to_string(5 * (j0 + j1) / 2) + ",0]";
      edit = R"({"edit":"rotate","on":")" + on + R"(","grab":)" + std::to_string(middle) + R"(,"point":)" + point + R"(,"axis":[0,0,1],)" +
             line + falloff;
    } else {
      std::snprintf(line, sizeof line, R"("distance":%.3f)", (kind == 0 ? 1 : -1) * 12 * size);
      edit = R"({"edit":"lift","on":")" + on + "\"," + line + falloff;
    }
  }
};

Document open_sheet(const Folder& folder, const ShapedSheet& sheet) {
  put_content(folder / "sheet.k", sheet.deck);
  OpenOptions options;
  options.length_unit = LengthUnit::mm;
  options.target_size = 5.0;
  return open(folder / "sheet.k", options).value();
}

std::string by_hand(const char* operation, const std::vector<std::string>& at) {
  std::string names;
  for (const std::string& each : at) names += (names.empty() ? "\"" : ",\"") + each + "\"";
  return std::string(R"({"edit":")") + operation + R"(","at":[)" + names + "]}";
}

/// What can be done by hand at a shell.
std::vector<std::string> single_operations(const Model& model, ShellIndex shell) {
  const auto name = [&](ShellIndex s) { return "shell:" + std::to_string(model.shell_ids[s.value]); };
  const ShellNodes nodes = model.shell(shell);
  const std::string self = name(shell);
  std::vector<std::string> edits{by_hand("split", {self})};
  for (int c = 0; c < nodes.corners(); ++c) {
    const NodeIndex a = nodes.node[static_cast<std::size_t>(c)], b = nodes.node[static_cast<std::size_t>((c + 1) % nodes.corners())];
    edits.push_back(
        by_hand("collapse", {"node:" + std::to_string(model.node_ids[a.value]), "node:" + std::to_string(model.node_ids[b.value])}));
    for (const ShellIndex other : model.adjacency->shells_of(model.adjacency->find_edge(a, b))) {
      if (other == shell) continue;
      for (const char* operation : {"split", "merge", "swap"}) edits.push_back(by_hand(operation, {self, name(other)}));
    }
  }
  return edits;
}

ShellSet failing_of(const Generation& generation) {
  ShellSet shells;
  for (std::size_t s = 0; s < generation.model.shell_count(); ++s)
    if (!generation.model.is_removed(ShellIndex(s)) && generation.quality[s].fail != 0) shells.push_back(ShellIndex(s));
  return shells;
}

/// The operations by hand after which a failing shell passes and none newly fails.
std::vector<std::string> healing_operations(const Document& document) {
  std::vector<std::string> healing;
  const Generation& now = document.current();
  const ShellSet damaged = damaged_shells(document), failing = failing_of(now);
  for (const ShellIndex shell : failing) {
    if (!std::binary_search(damaged.begin(), damaged.end(), shell)) continue;
    for (const std::string& json : single_operations(now.model, shell)) {
      const Result<Prepared> tried = prepare(document, edit_of(json));
      if (!tried) continue;
      const ShellSet left = failing_of(*tried->next);
      if (left.size() < failing.size() && std::includes(failing.begin(), failing.end(), left.begin(), left.end())) healing.push_back(json);
    }
  }
  return healing;
}

void expect_second_repair_changes_nothing(Document& document) {
  const Generation once = document.current();
  const EditReport report = must_apply(document, R"({"edit":"repair"})");
  const Generation& twice = document.current();
  EXPECT_EQ(once.counts, twice.counts);
  EXPECT_EQ(report.nodes_moved + report.elements_added + report.elements_removed, 0U);
  EXPECT_THAT(moved_nodes(once.model, twice.model), IsEmpty());
  EXPECT_TRUE(changes_between(once.model, twice.model).empty());
}

TEST(RepairByHand, heals_nothing_that_a_repair_left_nor_does_another_repair) {
  const Folder folder;
  for (const unsigned seed : {2U, 30U}) {
    SCOPED_TRACE(seed);
    Document document = open_sheet(folder, ShapedSheet(seed));
    must_apply(document, ShapedSheet(seed).edit);
    const EditReport report = must_apply(document, R"({"edit":"repair"})");
    EXPECT_GT(report.before.fail, report.after.fail);
    EXPECT_THAT(healing_operations(document), IsEmpty());
    expect_second_repair_changes_nothing(document);
  }
}

}  // namespace
}  // namespace prismesh::mesh::document
