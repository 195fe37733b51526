// Repairs where the deck can't hold some of what would help: that is left as it is and named, the rest is repaired all the same.
#include <algorithm>
#include <cstdio>
#include <set>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh/deck/save.h"
#include "mesh/document/unwritable.h"
#include "mesh/model/topology_change.h"
#include "tests/mesh/document/document_fixture.h"
#include "tests/mesh/document/restructuring.h"

namespace prismesh::mesh::document {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

constexpr int kUnevenColumns = 14, kUnevenRows = 8, kOddColumns = 7;

int sheet_node(int i, int j) { return 1 + i + j * (kUnevenColumns + 1); }

/// A sheet of quads of 5 mm. Those of the left half have thicknesses at some corners only, so what they are divided into can't be written.
std::string half_odd_sheet() {
  std::string nodes, odd, plain;
  char line[128];
  for (int j = 0; j <= kUnevenRows; ++j)
    for (int i = 0; i <= kUnevenColumns; ++i) {
      std::snprintf(line, sizeof line, "%8d%16.6f%16.6f%16.6f\n", sheet_node(i, j), 5.0 * i, 5.0 * j, 0.0);
      nodes += line;
    }
  for (int j = 0; j < kUnevenRows; ++j)
    for (int i = 0; i < kUnevenColumns; ++i) {
      std::snprintf(line, sizeof line, "%8d%8d%8d%8d%8d%8d\n", 1 + i + j * kUnevenColumns, 1, sheet_node(i, j), sheet_node(i + 1, j),
                    sheet_node(i + 1, j + 1), sheet_node(i, j + 1));
      (i < kOddColumns ? odd : plain) += line;
      if (i < kOddColumns) odd += "             1.5             0.0             0.0             1.2\n";
    }
  return "*KEYWORD\n*NODE\n" + nodes + "*ELEMENT_SHELL_THICKNESS\n" + odd + "*ELEMENT_SHELL\n" + plain +
         "*PART\npanel\n         1         1         1\n*SECTION_SHELL\n         1         2\n       1.5       1.5       1.5       1.5\n"
         "*MAT_ELASTIC\n         1  7.85E-09    210000       0.3\n*END\n";
}

Document open_half_odd(const std::filesystem::path& path) {
  put_content(path, half_odd_sheet());
  OpenOptions options;
  options.length_unit = LengthUnit::mm;
  options.target_size = 5.0;
  return open(path, options).value();
}

/// A node pulled out of the sheet: the quads about it are warped, which dividing them cures.
std::string dent(int node) { return R"({"edit":"translate","by":[1,1,4],"on":")" + std::to_string(node) + R"("})"; }

TEST(Unwritable, repairs_elsewhere_and_names_what_it_left) {
  const Folder folder;
  Document document = open_half_odd(folder / "a.k");
  must_apply(document, dent(sheet_node(3, 4)));
  must_apply(document, dent(sheet_node(11, 4)));
  const Model before = document.current().model;
  const EditReport report = must_apply(document, R"({"edit":"repair"})");
  EXPECT_LT(report.after.fail, report.before.fail);
  EXPECT_GT(report.after.fail, 0u) << "the left dent stays";
  EXPECT_GT(report.elements_added, 0u);
  EXPECT_THAT(report.notes, Contains(HasSubstr("since the deck can't be written otherwise")));
  for (const std::string& note : report.notes) EXPECT_THAT(note, Not(HasSubstr("nothing was written")));
  const Model& model = document.current().model;
  for (std::size_t s = 0; s < before.shell_count(); ++s) {
    if (static_cast<int>(s) % kUnevenColumns >= kOddColumns) continue;
    EXPECT_FALSE(model.is_removed(ShellIndex(s)));
  }
  ASSERT_TRUE(model.topology_change);
  for (std::size_t s = model.topology_change->deck_shells; s < model.shell_count(); ++s) {
    const ShellIndex parent = model.topology_change->shell_parents[s - model.topology_change->deck_shells];
    EXPECT_GE((model.shell_ids[parent.value] - 1) % kUnevenColumns, kOddColumns) << "a piece of what can't be divided";
  }
  const Result<deck::SaveReport> saved = save(document, folder / "b.k");
  ASSERT_TRUE(saved) << saved.error().text();
  EXPECT_EQ(saved->shells_added, report.elements_added);
}

TEST(Unwritable, what_cannot_be_written_anywhere_is_left_and_nothing_is_done) {
  const Folder folder;
  Document document = open_half_odd(folder / "a.k");
  must_apply(document, dent(sheet_node(3, 4)));
  const EditReport report = must_apply(document, R"({"edit":"repair"})");
  EXPECT_EQ(report.elements_added, 0u);
  EXPECT_EQ(report.elements_removed, 0u);
  EXPECT_LE(report.after.fail, report.before.fail);
  EXPECT_THAT(report.notes, Contains(HasSubstr("can't be changed: ")));
  const Result<deck::SaveReport> saved = save(document, folder / "b.k");
  EXPECT_TRUE(saved) << saved.error().text();
}

TEST(Unwritable, a_repair_that_is_stopped_before_it_can_be_written_says_so_and_changes_nothing) {
  const Folder folder;
  Document document = open_half_odd(folder / "a.k");
  must_apply(document, dent(sheet_node(3, 4)));
  std::size_t calls = 0, refused = 0, kept = 0;
  ASSERT_TRUE(prepare(document, edit_of(R"({"edit":"repair"})"), [&](double) { return ++calls > 0; }));
  for (std::size_t stop = 1; stop < calls; stop *= 2) {
    std::size_t asked = 0;
    const Progress keeping{[&](double) { return asked++ < stop; }, [] { return true; }};
    const Result<Prepared> prepared = prepare(document, edit_of(R"({"edit":"repair"})"), keeping);
    if (prepared) {
      ++kept;
      continue;
    }
    ++refused;
    EXPECT_THAT(prepared.error().text(),
                HasSubstr("the repair was stopped, and nothing of it is kept: the deck can't hold what it had reached"));
    EXPECT_FALSE(is_cancelled(prepared.error()));
  }
  EXPECT_GT(refused, 0u);
  EXPECT_GT(kept, 0u) << "before anything was divided";
}

TEST(Unwritable, the_search_finds_each_place_has_a_progress_and_stops_when_told) {
  const Folder folder;
  Document document = open_half_odd(folder / "a.k");
  must_apply(document, R"({"edit":"translate","by":[0.125,0,0.25],"on":"all","falloff":{"profile":"constant"}})");
  const Model& model = document.current().model;
  // Quads two apart share no node: each is a place of its own, and those of the left half can't be written.
  Change change{model, {}};
  std::set<ShellIndex> wanted;
  for (int j = 0; j < kUnevenRows; j += 2)
    for (int i = 0; i < kUnevenColumns; i += 2) {
      const ShellIndex shell = model.find_shell(1 + i + j * kUnevenColumns);
      change.split(shell);
      if (i < kOddColumns) wanted.insert(shell);
    }
  Frozen frozen;
  std::vector<double> told;
  const auto listen = [&](double fraction) {
    told.push_back(fraction);
    return true;
  };
  const Result<std::size_t> found = find_unwritable(document, model, change.want, frozen, listen);
  ASSERT_TRUE(found) << found.error().text();
  EXPECT_EQ(*found, wanted.size());
  std::set<ShellIndex> named;
  for (const auto& [shell, why] : frozen.shells) named.insert(shell);
  EXPECT_EQ(named, wanted);
  ASSERT_GT(told.size(), wanted.size());
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_LE(told.back(), 1);
  for (std::size_t stop = 0; stop < told.size(); stop += 5) {
    Frozen half;
    std::size_t calls = 0;
    const Result<std::size_t> stopped = find_unwritable(document, model, change.want, half, [&](double) { return calls++ < stop; });
    ASSERT_FALSE(stopped) << "told to stop at " << stop;
    EXPECT_EQ(stopped.error().message, "cancelled");
    EXPECT_EQ(calls, stop + 1) << "asked no more";
  }
}

TEST(Unwritable, of_connected_shells_only_those_at_fault_are_held_back) {
  const Folder folder;
  const Document document = open_half_odd(folder / "a.k");
  const Model& model = document.current().model;
  // Neighbours in a row: the first two are of the left half.
  Change change{model, {}};
  std::set<ShellIndex> all, odd;
  for (int i = kOddColumns - 2; i < kOddColumns + 3; ++i) {
    const ShellIndex shell = model.find_shell(1 + i);
    change.split(shell);
    all.insert(shell);
    if (i < kOddColumns) odd.insert(shell);
  }
  constexpr std::uint8_t kAll = repair::kKeepsNodes | repair::kIndivisible | repair::kLasting | repair::kNoTriangle;
  Frozen frozen;
  const auto held = [&](std::uint8_t rules) {
    std::set<ShellIndex> shells;
    for (const auto& [shell, what] : frozen.shells)
      if (what.rules == rules) shells.insert(shell);
    return shells;
  };
  EXPECT_EQ(find_unwritable(document, model, change.finish(), frozen).value(), odd.size());
  EXPECT_EQ(held(repair::kNoTriangle), odd) << "no more than what was done to them is forbidden";
  EXPECT_EQ(frozen.shells.size(), odd.size());
  for (const auto& [shell, what] : frozen.shells) EXPECT_THAT(what.why, Not(HasSubstr("nothing was written")));
  EXPECT_EQ(notes_of(frozen).size(), 1u);
  EXPECT_EQ(find_unwritable(document, model, change.finish(), frozen).value(), odd.size());
  EXPECT_EQ(held(kAll), odd) << "found again, they stay as they are";
  EXPECT_EQ(find_unwritable(document, model, change.finish(), frozen).value(), 1u);
  EXPECT_EQ(held(kAll), all) << "a third search holds whole groups back";
  EXPECT_THAT(notes_of(frozen), testing::ElementsAre(HasSubstr("5 elements left as they are")));
}

TEST(Unwritable, what_only_all_together_prevents_saving_is_found_as_well) {
  const Folder folder;
  // The set lists two shells far apart: one of them may go, but not both.
  std::string text = sheet_deck(8, 6);
  const std::string two = "*SET_SHELL_LIST\n         2\n         1         2\n";
  text.replace(text.find(two), two.size(), "*SET_SHELL_LIST\n         2\n         1        48\n");
  const Document document = open_text(folder / "a.k", text);
  const Model& model = document.current().model;
  Change change{model, {}};
  change.want.removed_shells = {model.find_shell(1), model.find_shell(48)};
  Frozen frozen;
  EXPECT_EQ(find_unwritable(document, model, change.finish(), frozen).value(), 1u);
  ASSERT_EQ(frozen.shells.size(), 1u);
  EXPECT_EQ(frozen.shells.begin()->first, model.find_shell(48));
}

TEST(Unwritable, a_repair_stops_wherever_it_is_told_and_its_progress_never_goes_back) {
  const Folder folder;
  Document document = open_half_odd(folder / "a.k");
  must_apply(document, dent(sheet_node(3, 4)));
  const Edit repair = parse_edit(R"({"edit":"repair"})").value();
  std::vector<double> told;
  const auto listen = [&](double fraction) {
    told.push_back(fraction);
    return true;
  };
  ASSERT_TRUE(prepare(document, repair, listen));
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  for (const std::size_t stop : {std::size_t{0}, told.size() / 2}) {
    std::size_t calls = 0;
    const Result<Prepared> stopped = prepare(document, repair, [&](double) { return calls++ < stop; });
    ASSERT_FALSE(stopped) << "told to stop at " << stop;
    EXPECT_EQ(stopped.error().message, "cancelled");
  }
}

}  // namespace
}  // namespace prismesh::mesh::document
