// Operations by hand on decks of all four formats that PRISMESH_MODELS points to: saved and read again they are the same shells, with
// the same ids, parts and thicknesses, and the sets hold what came of their members.
#include <array>
#include <iostream>
#include <map>

#include <gtest/gtest.h>

#include "mesh/deck/save.h"
#include "mesh/document/deck_relations.h"
#include "mesh/model/adjacency.h"
#include "mesh/model/topology_change.h"
#include "tests/mesh/document/document_fixture.h"
#include "tests/support/real_deck.h"

namespace prismesh::mesh::document {
namespace {

namespace fs = std::filesystem;

constexpr int kWays = 5;  ///< split one, split two, swap, collapse, merge
constexpr std::array<std::string_view, kWays> kWayNames{"split", "split of two", "swap", "collapse", "merge"};
constexpr int kWanted = 3;  ///< of each
constexpr int kMaxTries = 60;

/// What an operation is asked for at the shell: itself, its neighbour over an edge, or that edge. Empty: the shell has no such place.
std::vector<std::string> place_for(const Model& model, int way, ShellIndex shell, int turn) {
  const auto shell_name = [&](ShellIndex s) { return "shell:" + std::to_string(model.shell_ids[s.value]); };
  if (way == 0) return {shell_name(shell)};
  const ShellNodes& nodes = model.shell(shell);
  const int corners = nodes.corners();
  const NodeIndex a = nodes.node[static_cast<std::size_t>(turn % corners)], b = nodes.node[static_cast<std::size_t>((turn + 1) % corners)];
  if (way == 3) return {"node:" + std::to_string(model.node_ids[a.value]), "node:" + std::to_string(model.node_ids[b.value])};
  const auto shells = model.adjacency->shells_of(model.adjacency->find_edge(a, b));
  if (shells.size() != 2) return {};
  if (way == 4 && !(model.shell(shells[0]).is_triangle() && model.shell(shells[1]).is_triangle())) return {};
  return {shell_name(shells[0]), shell_name(shells[1])};
}

Edit edit_for(int way, std::vector<std::string> at) {
  constexpr std::array<repair::Operation, kWays> kOperations{repair::Operation::split, repair::Operation::split, repair::Operation::swap,
                                                             repair::Operation::collapse, repair::Operation::merge};
  return Restructure{kOperations[static_cast<std::size_t>(way)], std::move(at)};
}

/// Where an operation is tried the `i`th time: merging at each edge of what was split, the others anywhere.
ShellIndex candidate(const Model& model, int way, int i) {
  const auto number = static_cast<std::size_t>(i);
  const std::size_t of_deck = model.topology_change ? model.topology_change->deck_shells : model.shell_count();
  if (way == 4 && of_deck + number / 3 < model.shell_count()) return ShellIndex(of_deck + number / 3);
  return ShellIndex((number * 7919 + static_cast<std::size_t>(way) * 104729) % model.shell_count());
}

/// How many of each were done. Refusals must have words and leave the document alone.
std::array<int, kWays> work_by_hand(Document& document) {
  std::array<int, kWays> done{};
  for (int way = 0; way < kWays; ++way)
    for (int i = 0; i < kMaxTries && done[static_cast<std::size_t>(way)] < kWanted; ++i) {
      const Model& model = document.current().model;
      const ShellIndex shell = candidate(model, way, i);
      if (model.is_removed(shell)) continue;
      std::vector<std::string> at = place_for(model, way, shell, i);
      if (at.empty()) continue;
      const Edit edit = edit_for(way, std::move(at));
      const std::uint64_t number = document.current().number;
      if (const Result<EditReport> report = try_apply(document, edit)) {
        ++done[static_cast<std::size_t>(way)];
      } else {
        EXPECT_FALSE(report.error().message.empty());
        EXPECT_EQ(document.current().number, number);
      }
    }
  return done;
}

struct ShellCard {
  std::array<std::int64_t, 4> corners{};
  std::int64_t part = 0;
  float thickness = 0;
};
std::map<std::int64_t, ShellCard> shells_by_id(const Model& model) {
  std::map<std::int64_t, ShellCard> shells;
  for (std::size_t s = 0; s < model.shell_count(); ++s) {
    if (model.is_removed(ShellIndex(s))) continue;
    ShellCard& card = shells[model.shell_ids[s]];
    for (std::size_t c = 0; c < 4; ++c) card.corners[c] = model.node_ids[model.shell_nodes[s].node[c].value];
    if (const PartIndex part = model.shell_parts[s]; part.valid()) card.part = (*model.parts)[part.value].id;
    card.thickness = model.shell_thickness[s];
  }
  return shells;
}
std::map<std::int64_t, Vec3> nodes_by_id(const Model& model) {
  std::map<std::int64_t, Vec3> nodes;
  for (std::size_t n = 0; n < model.node_count(); ++n)
    if (!model.is_removed(NodeIndex(n))) nodes[model.node_ids[n]] = model.positions[n];
  return nodes;
}

void expect_same_by_id(const Model& meant, const Model& read, double size) {
  const auto here = nodes_by_id(meant), there = nodes_by_id(read);
  ASSERT_EQ(here.size(), there.size());
  for (const auto& [id, at] : here) {
    ASSERT_TRUE(there.contains(id)) << "node " << id;
    EXPECT_LE((there.at(id) - at).norm(), 1e-3 * size) << "node " << id;
  }
  const auto cards = shells_by_id(meant), again = shells_by_id(read);
  ASSERT_EQ(cards.size(), again.size());
  for (const auto& [id, card] : cards) {
    ASSERT_TRUE(again.contains(id)) << "shell " << id;
    const ShellCard& other = again.at(id);
    EXPECT_EQ(other.corners, card.corners) << "shell " << id;
    EXPECT_EQ(other.part, card.part) << "shell " << id;
    EXPECT_NEAR(other.thickness, card.thickness, 1e-5F * card.thickness) << "shell " << id;
  }
}

/// The ids that a set of the deck as it was opened must hold after the edits: its own less what went, and what comes of them alone.
std::vector<std::int64_t> heirs(const Model& model, const select::Chosen& chosen, bool of_nodes) {
  const std::size_t count = of_nodes ? model.node_count() : model.shell_count();
  std::vector<bool> in(count, false);
  if (of_nodes) {
    for (const NodeIndex node : chosen.nodes) in[node.value] = true;
    for (std::size_t n = model.topology_change->deck_nodes; n < count; ++n) {
      const NodeOrigin& origin = model.topology_change->node_origins[n - model.topology_change->deck_nodes];
      in[n] =
          std::all_of(origin.parent.begin(), origin.parent.begin() + origin.count(), [&](NodeIndex parent) { return in[parent.value]; });
    }
  } else {
    for (const ShellIndex shell : chosen.shells) in[shell.value] = true;
    for (std::size_t s = model.topology_change->deck_shells; s < count; ++s)
      in[s] = in[model.topology_change->shell_parents[s - model.topology_change->deck_shells].value];
  }
  std::vector<std::int64_t> ids;
  for (std::size_t i = 0; i < count; ++i) {
    const bool removed = of_nodes ? model.is_removed(NodeIndex(i)) : model.is_removed(ShellIndex(i));
    if (in[i] && !removed) ids.push_back(of_nodes ? model.node_ids[i] : model.shell_ids[i]);
  }
  std::sort(ids.begin(), ids.end());
  return ids;
}

std::vector<std::int64_t> members(const Model& model, const select::Chosen& chosen, bool of_nodes) {
  std::vector<std::int64_t> ids;
  if (of_nodes)
    for (const NodeIndex node : chosen.nodes) ids.push_back(model.node_ids[node.value]);
  else
    for (const ShellIndex shell : chosen.shells) ids.push_back(model.shell_ids[shell.value]);
  std::sort(ids.begin(), ids.end());
  return ids;
}

/// Sets of nodes and of shells; returns how many were compared.
std::size_t expect_sets_inherited(const Document& document, const Document& again) {
  const Generation& opened = *document.opened;
  const Model& model = document.current().model;
  std::size_t compared = 0;
  for (const select::NamedSet& set : select::find_sets(*opened.relations->names.references)) {
    const bool of_nodes = set.kind == Referred::node_set;
    if (!of_nodes && set.kind != Referred::shell_set && set.kind != Referred::element_set) continue;
    const select::EntityKind kind = of_nodes ? select::EntityKind::node : select::EntityKind::element;
    const auto before = select::evaluate(opened.model, set.label(), kind, opened.relations->names);
    if (!before) continue;  // of things that aren't in the model
    const auto after = select::evaluate(again.current().model, set.label(), kind, again.current().relations->names);
    EXPECT_TRUE(after) << set.label() << ": " << after.error().text();
    if (!after) continue;
    EXPECT_EQ(members(again.current().model, *after, of_nodes), heirs(model, *before, of_nodes)) << set.label();
    ++compared;
  }
  return compared;
}

TEST(ByHandRealDecks, are_saved_with_their_cards_and_sets) {
  const auto models = test::real_decks();
  if (!models) GTEST_SKIP() << "PRISMESH_MODELS doesn't point to the real decks: OPERATIONS BY HAND ON THEM ARE NOT TESTED";
  for (const char* path :
       {"gsa_car6_comma/car6_crash.k", "gsa_car6_v3_param/main_v223_param.k", "bird_strike_composite/input.k", "hatprofile/Hatprofile.k",
        "simplecar_nas/full_car.nas", "bumper_beam_rad/Bumper_Beam_AP_meshed_0000.rad", "jp_model_inp/model.inp"}) {
    SCOPED_TRACE(path);
    Document document = open(*models / path, OpenOptions{}).value();
    const std::array<int, kWays> done = work_by_hand(document);
    std::cout << path;
    for (std::size_t way = 0; way < kWays; ++way) {
      std::cout << ", " << done[way] << ' ' << kWayNames[way];
      EXPECT_GT(done[way], 0) << kWayNames[way];
    }
    const Folder folder;
    fs::create_directories(folder / "out");
    const fs::path target = folder / "out" / fs::path(path).filename();
    const Result<deck::SaveReport> saved = save(document, target);
    ASSERT_TRUE(saved) << saved.error().text();
    const Result<Document> again = open(target, OpenOptions{});
    ASSERT_TRUE(again) << again.error().text();
    expect_same_by_id(document.current().model, again->current().model, document.settings.target_size);
    const std::size_t sets = expect_sets_inherited(document, *again);
    std::cout << ": " << saved->shells_added << " shells and " << saved->nodes_added << " nodes came, " << saved->shells_changed
              << " shells changed, " << sets << " sets compared\n";
  }
}

}  // namespace
}  // namespace prismesh::mesh::document
