// Deltas byte by byte: each check of what a delta may say, by a delta that is wrong in nothing else.
#include "mesh/document/delta.h"

#include <bit>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh/model/topology_change.h"
#include "tests/mesh/document/document_fixture.h"

namespace prismesh::mesh::document {
namespace {

std::string number_bytes(std::uint64_t value) {
  std::string bytes;
  for (; value >= 0x80; value >>= 7) bytes += static_cast<char>(value | 0x80);
  return bytes + static_cast<char>(value);
}
std::string all_numbers(const std::vector<std::uint64_t>& values) {
  std::string bytes;
  for (const std::uint64_t value : values) bytes += number_bytes(value);
  return bytes;
}
std::string real_bytes(double value) {
  const auto word = std::bit_cast<std::uint64_t>(value);
  std::string bytes;
  for (int shift = 0; shift < 64; shift += 8) bytes += static_cast<char>(word >> shift);
  return bytes;
}
std::string point_bytes(double x, double y = 0, double z = 0) { return real_bytes(x) + real_bytes(y) + real_bytes(z); }

/// More than the 63 bits that a number may have.
const std::string kEndlessNumber(10, '\xff');
const double kNan = std::numeric_limits<double>::quiet_NaN(), kInfinite = std::numeric_limits<double>::infinity();

/// The sections of a delta that changes nothing; a test writes one of them anew.
struct DeltaSections {
  std::string added_nodes = number_bytes(0), added_shells = number_bytes(0), reshaped = number_bytes(0), removed_shells = number_bytes(0),
              removed_nodes = number_bytes(0), moved = number_bytes(0), node_runs = number_bytes(0), shell_runs = number_bytes(0),
              kind = number_bytes(0), parts = number_bytes(0);
  std::string bytes() const {
    return number_bytes(2) + added_nodes + added_shells + reshaped + removed_shells + removed_nodes + moved + node_runs + shell_runs +
           kind + parts;
  }
};

std::string added_node(std::uint64_t id, int parents, std::uint64_t parent, double weight, double x) {
  std::string bytes = number_bytes(1) + number_bytes(id) + number_bytes(static_cast<std::uint64_t>(parents));
  for (int p = 0; p < parents; ++p) bytes += number_bytes(p == 0 ? parent : 1) + real_bytes(weight);
  return bytes + point_bytes(x);
}

/// A sheet of 3 x 3 quads whose last shell and that shell's own corner are gone: shell 8 of 9, node 15 of 16.
Generation sheet_with_a_hole() {
  Generation generation = make_sheet(3, 3).current();
  remove_shell(generation.model, ShellIndex(std::size_t{8}));
  remove_node(generation.model, NodeIndex(std::size_t{15}));
  return generation;
}

TEST(Delta, what_fits_is_taken_and_each_thing_that_does_not_is_refused) {
  struct Case {
    std::string DeltaSections::*section;
    std::string good;
    std::vector<std::pair<std::string, std::string>> bad;  ///< what, bytes
  };
  const Case cases[] = {
      {&DeltaSections::added_nodes,
       added_node(100, 2, 0, 0.5, 1),
       {{"no id", added_node(0, 2, 0, 0.5, 1)},
        {"an id that is taken", added_node(15, 2, 0, 0.5, 1)},
        {"no parents", added_node(100, 0, 0, 0.5, 1) + std::string(35, '\0')},
        {"five parents", added_node(100, 5, 0, 0.5, 1)},
        {"a parent that isn't there", added_node(100, 2, 16, 0.5, 1)},
        {"a parent that is gone", added_node(100, 2, 15, 0.5, 1)},
        {"no weight", added_node(100, 2, 0, 0, 1)},
        {"too much weight", added_node(100, 2, 0, 1.5, 1)},
        {"a weight that is no number", added_node(100, 2, 0, kNan, 1)},
        {"an endless place", added_node(100, 2, 0, 0.5, kInfinite)},
        {"a place that is no number", added_node(100, 2, 0, 0.5, kNan)},
        {"an endless id", number_bytes(1) + kEndlessNumber + std::string(35, '\0')}}},
      {&DeltaSections::added_shells,
       all_numbers({1, 100, 0, 0, 1, 5, 4}),
       {{"no id", all_numbers({1, 0, 0, 0, 1, 5, 4})},
        {"an id that is taken", all_numbers({1, 8, 0, 0, 1, 5, 4})},
        {"a parent that isn't there", all_numbers({1, 100, 9, 0, 1, 5, 4})},
        {"a parent that is gone", all_numbers({1, 100, 8, 0, 1, 5, 4})},
        {"a corner that isn't there", all_numbers({1, 100, 0, 0, 1, 5, 16})},
        {"a corner that is gone", all_numbers({1, 100, 0, 0, 1, 5, 15})}}},
      {&DeltaSections::reshaped,
       all_numbers({1, 0, 0, 1, 5, 5}),
       {{"a shell that isn't there", all_numbers({1, 9, 0, 1, 5, 5})},
        {"a shell that is gone", all_numbers({1, 8, 0, 1, 5, 5})},
        {"a corner that is gone", all_numbers({1, 0, 0, 1, 15, 15})},
        {"an endless gap", number_bytes(1) + kEndlessNumber}}},
      {&DeltaSections::removed_shells,
       all_numbers({2, 0, 0}),
       {{"a shell that isn't there", all_numbers({1, 9})},
        {"a shell that is gone", all_numbers({1, 8})},
        {"one behind the last", all_numbers({2, 7, 1})},
        {"an endless gap", number_bytes(1) + kEndlessNumber}}},
      {&DeltaSections::removed_nodes,
       all_numbers({1, 14}),
       {{"a node that isn't there", all_numbers({1, 16})}, {"a node that is gone", all_numbers({1, 15})}}},
      {&DeltaSections::moved,
       all_numbers({1, 14}) + point_bytes(1, 2, 3),
       {{"a node that isn't there", all_numbers({1, 16}) + point_bytes(1)},
        {"a node that is gone", all_numbers({1, 15}) + point_bytes(1)},
        {"an endless place", all_numbers({1, 14}) + point_bytes(0, kInfinite)},
        {"a place that is no number", all_numbers({1, 14}) + point_bytes(0, 0, kNan)},
        {"one behind the last", all_numbers({2, 14}) + point_bytes(1) + number_bytes(1) + point_bytes(1)},
        {"an endless gap", number_bytes(1) + kEndlessNumber + point_bytes(1)}}},
      {&DeltaSections::node_runs,
       all_numbers({2, 0, 2, kSelected, 3, 11, kLocked | kHidden}),
       {{"a run that begins behind the last", all_numbers({1, 17, 1, kSelected})},
        {"a run that ends behind the last", all_numbers({1, 15, 2, kSelected})},
        {"a run of nothing", all_numbers({1, 0, 0, kSelected})},
        {"a run longer than all", all_numbers({1, 0, 17, kSelected})},
        {"a mark that means nothing", all_numbers({1, 0, 1, 8})},
        {"a second run behind the last", all_numbers({2, 0, 15, kSelected, 0, 2, kSelected})},
        {"an endless length", all_numbers({1, 0}) + kEndlessNumber + number_bytes(kSelected)}}},
      {&DeltaSections::shell_runs, all_numbers({1, 0, 9, kSelected}), {{"a mark of nodes", all_numbers({1, 0, 9, kLocked})}}},
      {&DeltaSections::kind, number_bytes(2), {{"no kind", number_bytes(3)}}},
      {&DeltaSections::parts,
       all_numbers({1, 0, 3}),
       {{"a part that isn't there", all_numbers({1, 1, 3})},
        {"a state that means nothing", all_numbers({1, 0, 4})},
        {"an endless number", number_bytes(1) + kEndlessNumber + number_bytes(3)},
        {"something after the end", all_numbers({1, 0, 3, 0})}}},
  };
  const Generation before = sheet_with_a_hole();
  const auto taken = [&](std::string DeltaSections::*section, const std::string& text) {
    DeltaSections sections;
    sections.*section = text;
    const std::string bytes = sections.bytes();
    Generation next = before;
    const Result<NodeSet> moved = apply_delta(std::as_bytes(std::span(bytes)), next);
    if (!moved) {
      EXPECT_EQ(moved.error().message, "its delta doesn't fit the model");
    }
    return moved.has_value();
  };
  for (const Case& each : cases) {
    EXPECT_TRUE(taken(each.section, each.good));
    for (const auto& [what, bytes] : each.bad) EXPECT_FALSE(taken(each.section, bytes)) << what;
  }
}

TEST(Delta, says_in_its_bytes_what_changes) {
  DeltaSections sections;
  sections.moved = all_numbers({2, 3}) + point_bytes(1, 2, 3) + number_bytes(10) + point_bytes(4, 5, 6);
  sections.node_runs = all_numbers({2, 0, 2, kSelected, 3, 1, kSelected | kLocked});
  sections.shell_runs = all_numbers({1, 2, 3, kSelected});
  sections.kind = number_bytes(1);
  sections.parts = all_numbers({1, 0, 2});
  const std::string bytes = sections.bytes();
  Generation next = sheet_with_a_hole();
  const Result<NodeSet> moved = apply_delta(std::as_bytes(std::span(bytes)), next);
  ASSERT_TRUE(moved) << moved.error().text();
  EXPECT_EQ(*moved, (NodeSet{NodeIndex(std::size_t{3}), NodeIndex(std::size_t{14})}));
  EXPECT_EQ(next.model.positions[3], Vec3(1, 2, 3));
  EXPECT_EQ(next.model.positions[14], Vec3(4, 5, 6));
  std::string marks;
  for (std::size_t n = 0; n < next.node_marks.size(); ++n) marks += static_cast<char>('0' + next.node_marks[n]);
  EXPECT_EQ(marks, "1100030000000000");
  EXPECT_EQ(next.selected_nodes, 3u);
  EXPECT_EQ(next.selected_shells, 3u);
  EXPECT_EQ(next.selection_kind, select::EntityKind::element);
  EXPECT_EQ(next.parts->front(), (PartState{false, true}));
}

}  // namespace
}  // namespace prismesh::mesh::document
