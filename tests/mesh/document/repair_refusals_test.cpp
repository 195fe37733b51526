// Repairs and operations by hand where there is nothing to do or nothing may be done: a sentence, and the document is as it was.
#include <algorithm>

#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh/model/topology_change.h"
#include "tests/mesh/document/document_fixture.h"
#include "tests/mesh/document/restructuring.h"

namespace prismesh::mesh::document {
namespace {

using testing::Contains;
using testing::HasSubstr;

constexpr auto kDent = R"({"edit":"translate","by":[1,1,4],"on":"31"})";

void expect_untouched(const Model& before, const Model& after) {
  EXPECT_TRUE(moved_nodes(before, after).empty());
  EXPECT_TRUE(changes_between(before, after).empty());
  EXPECT_EQ(before.node_count(), after.node_count());
  EXPECT_EQ(before.shell_count(), after.shell_count());
}

/// The words of a refusal that leaves the document alone.
std::string refused_alone(Document& document, const std::string& json) {
  const std::uint64_t number = document.current().number;
  const std::size_t generations = document.generations.size();
  const std::string why = refusal(document, json);
  EXPECT_FALSE(why.empty()) << json << " was done";
  EXPECT_EQ(document.current().number, number);
  EXPECT_EQ(document.generations.size(), generations);
  return why;
}

TEST(RepairRefusals, an_empty_scope_is_a_sentence) {
  const Folder folder;
  Document document = open_text(folder / "a.k", sheet_deck(8, 6));
  EXPECT_THAT(refused_alone(document, R"({"edit":"repair","scope":"selection"})"), HasSubstr("repair: nothing is selected"));
  EXPECT_THAT(refused_alone(document, R"({"edit":"repair","scope":"part"})"), HasSubstr("repair: nothing is selected"));
  const std::pair<std::string, std::string> nothing[] = {
      {R"({"edit":"repair"})", "nothing to repair: no edit made an element fail or warn"},
      {R"({"edit":"repair","scope":"failed"})", "nothing to repair: every element in the scope is fine"},
      {R"({"edit":"repair","scope":"all"})", "nothing to repair: every element in the scope is fine"},
  };
  for (const auto& [edit, note] : nothing) {
    const Model before = document.current().model;
    const EditReport report = must_apply(document, edit);
    EXPECT_THAT(report.notes, Contains(note));
    EXPECT_EQ(report.nodes_moved + report.elements_added + report.elements_removed, 0u);
    expect_untouched(before, document.current().model);
  }
}

TEST(RepairRefusals, what_is_locked_stays_as_it_is_and_is_said) {
  const Folder folder;
  Document document = open_text(folder / "a.k", sheet_deck(8, 6));
  must_apply(document, kDent);
  ASSERT_GT(document.current().counts.fail, 0u);
  must_apply(document, R"({"edit":"lock","on":"all"})");
  const Model before = document.current().model;
  const EditReport report = must_apply(document, R"({"edit":"repair"})");
  expect_untouched(before, document.current().model);
  EXPECT_EQ(report.after, report.before);
  EXPECT_THAT(report.notes, Contains(HasSubstr("still fail")));
  EXPECT_THAT(report.notes, Contains(HasSubstr("shell:"))) << "each with its reason";
  must_apply(document, R"({"edit":"unlock","on":"all"})");
  EXPECT_LT(must_apply(document, R"({"edit":"repair"})").after.fail, report.after.fail) << "unlocked, it is repaired";
}

TEST(RepairLimits, no_node_goes_farther_than_max_move) {
  // A sheet whose columns are crushed on the left, borders and all: to cure it nodes of both kinds have to go far.
  const Folder folder;
  std::string text = "*NODE\n";
  for (int n = 0; n < 13 * 9; ++n) {
    const int i = n % 13, j = n / 13;
    text += std::to_string(n + 1) + "," + std::to_string(i < 4 ? 1.2 * i : 5.0 * (i - 3) + 3.6) + "," + std::to_string(5 * j) + ".,0.\n";
  }
  text += "*ELEMENT_SHELL\n";
  for (int n = 1; n < 13 * 8; ++n)
    if (n % 13 != 0)
      for (const int number : {n, 1, n, n + 1, n + 14, n + 13}) text += std::to_string(number) + (number == n + 13 ? "\n" : ",");
  const Document opened = open_text(folder / "a.k", text);
  const Model& crushed = opened.current().model;
  const auto farthest_after = [&](const std::string& repair) {
    Document document = opened;
    must_apply(document, repair);
    const Model& model = document.current().model;
    std::pair<double, double> farthest{0, 0};  // inside, on the border
    for (std::size_t n = 0; n < crushed.node_count(); ++n) {
      if (model.is_removed(NodeIndex(n))) continue;
      const bool inside = n % 13 > 0 && n % 13 < 12 && n / 13 > 0 && n / 13 < 8;
      double& far = inside ? farthest.first : farthest.second;
      far = std::max(far, (model.positions[n] - crushed.positions[n]).norm());
    }
    return farthest;
  };
  const auto [inside, border] = farthest_after(R"({"edit":"repair","scope":"all"})");
  EXPECT_GT(inside, 0.5);
  EXPECT_GT(border, 0.5);
  const auto [free, line] = farthest_after(R"({"edit":"repair","scope":"all","max_move":{"free":0.3,"line":0.1}})");
  EXPECT_GT(free, 0.1);
  EXPECT_LE(free, 0.3 + 1e-9);
  EXPECT_LE(line, 0.1 + 1e-9);
}

TEST(RepairRefusals, by_hand_what_is_not_there_or_locked_is_refused) {
  const Folder folder;
  Document document = open_text(folder / "a.k", sheet_deck(8, 6));
  const std::pair<std::string, std::string> cases[] = {
      {R"({"edit":"split","at":["shell:99999"]})", "split: there is no shell 99999"},
      {R"({"edit":"collapse","at":["node:7","node:99999"]})", "collapse: there is no node 99999"},
      {R"({"edit":"split","at":["beam:7"]})", "neither \"shell:ID\" nor \"node:ID\""},
      {R"({"edit":"split","at":["shell:-7"]})", "neither"},
      {R"({"edit":"split","at":["shell:9999999999999999999999"]})", "neither"},
      {R"({"edit":"merge","at":["shell:1","shell:2"]})", "merge: "},
      {R"({"edit":"swap","at":["shell:1","shell:48"]})", "swap: "},
      {R"({"edit":"collapse","at":["node:1","node:63"]})", "collapse: "},
  };
  for (const auto& [edit, why] : cases) EXPECT_THAT(refused_alone(document, edit), HasSubstr(why));
  EXPECT_FALSE(refused_alone(document, R"({"edit":"split","at":["node:7"]})").empty());
  const Result<EditReport> of_nothing = try_apply(document, Restructure{repair::Operation::swap, {}});  // JSON has none without
  ASSERT_FALSE(of_nothing);
  EXPECT_EQ(of_nothing.error().text(), "swap: \"at\" names no shell and no node");
  must_apply(document, R"({"edit":"lock","on":"1"})");
  for (const char* edit : {R"({"edit":"split","at":["shell:1"]})", R"({"edit":"split","at":["shell:4","shell:5"]})",
                           R"({"edit":"swap","at":["shell:1","shell:2"]})"})
    EXPECT_THAT(refused_alone(document, edit), HasSubstr("a shell there")) << edit;
  refused_alone(document, R"({"edit":"collapse","at":["node:20","node:21"]})");
  must_apply(document, R"({"edit":"split","at":["shell:8"]})");
  must_apply(document, R"({"edit":"unlock"})");
  must_apply(document, R"({"edit":"split","at":["shell:1"]})");
}

TEST(RepairRefusals, what_is_gone_is_not_there) {
  const Folder folder;
  Document document = open_text(folder / "a.k", sheet_deck(8, 6));
  must_apply(document, R"({"edit":"collapse","at":["node:31","node:32"]})");
  const Model& model = document.current().model;
  ASSERT_TRUE(model.topology_change);
  ASSERT_EQ(model.topology_change->removed_nodes.size(), 1u);
  const std::string gone = std::to_string(model.node_ids[model.topology_change->removed_nodes[0].value]);
  EXPECT_THAT(refused_alone(document, R"({"edit":"collapse","at":["node:)" + gone + R"(","node:33"]})"),
              HasSubstr("there is no node " + gone));
  EXPECT_FALSE(refused_alone(document, R"({"edit":"translate","by":[0,0,1],"on":")" + gone + "\"}").empty());
}

TEST(MendingOfHiddenParts, is_said_with_their_ids) {
  const Folder folder;
  for (const bool hidden : {true, false})
    for (const char* mend : {R"({"edit":"repair","scope":"all"})", R"({"edit":"relax","scope":"all"})"}) {
      Document document = open_text(folder / "a.k", sheet_deck(8, 6));
      must_apply(document, kDent);
      if (hidden) must_apply(document, R"({"edit":"hide","on":"1"})");
      const EditReport report = must_apply(document, mend);
      ASSERT_GT(report.nodes_moved + report.elements_added, 0u) << mend;
      EXPECT_EQ(std::ranges::count(report.notes, "a hidden part was changed too: 1"), hidden ? 1 : 0) << mend;
    }
}

}  // namespace
}  // namespace prismesh::mesh::document
