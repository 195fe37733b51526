// Any bytes as an expression over ids, sets and files: no crash, errors point into the text, and what is selected can be written and
// read again.
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/select/expression.h"
#include "tests/fuzz/require.h"
#include "tests/support/make_model.h"

using namespace prismesh;  // NOLINT: a fuzz target is a program of its own

namespace {

const mesh::Model& sample() {
  static const mesh::Model model = [] {
    std::vector<test::NodeSpec> nodes;
    for (int i = 0; i < 9; ++i) nodes.push_back({10 * (i + 1), mesh::Vec3(i % 3, i / 3, 0)});
    nodes.push_back({9223372036854775807, mesh::Vec3(9, 9, 9)});
    return test::make_model(nodes, {{1, 3, {10, 20, 50, 40}}, {2, 3, {20, 30, 60, 50}}, {3, 7, {40, 50, 80}}},
                            {{mesh::ElementClass::beam, 9, 7, {80, 90}}});
  }();
  return model;
}

/// Sets of several kinds, of sets, in a circle, and files.
const mesh::select::Names& names() {
  static const mesh::References references = [] {
    using mesh::Referred;
    using mesh::ReferenceRole;
    mesh::References made;
    std::uint64_t line = 0;
    const auto set = [&](const char* keyword, std::int64_t id, const char* title, std::optional<Referred> defines) {
      mesh::Referrer card;
      card.keyword = keyword;
      card.id = id;
      card.title = title;
      card.defines = defines;
      return made.add(card);
    };
    const auto member = [&](std::uint32_t card, Referred referred, std::int64_t first, std::int64_t last, bool takes_away = false) {
      made.add(
          mesh::Reference{referred, first == last ? ReferenceRole::list : ReferenceRole::range, first, last, 1, card, ++line, takes_away});
    };
    const std::uint32_t nodes = set("SET_NODE_LIST_TITLE", 17, "flange nodes", Referred::node_set);
    member(nodes, Referred::node, 10, 50);
    member(nodes, Referred::node, 30, 30, true);
    member(set("SET_NODE_LIST", 18, "", Referred::node_set), Referred::node, 90, 90);
    member(set("SET_PART", 17, "", Referred::part_set), Referred::part, 3, 3);
    const std::uint32_t added = set("SET_NODE_ADD", 31, "", Referred::node_set);
    member(added, Referred::node_set, 17, 18);
    member(set("SET_NODE_INTERSECT", 32, "", Referred::node_set), Referred::node_set, 17, 31);
    member(set("SET_NODE_ADD", 33, "", Referred::node_set), Referred::node_set, 31, 33);
    member(set("ELSET", 0, "rail", std::nullopt), Referred::any_element, 1, 9);
    made.finish();
    return made;
  }();
  static const mesh::select::Names names = [] {
    mesh::select::Names made;
    made.references = &references;
    made.files = {"main.k", "a/bumper.k", "b/welds.k"};
    made.file_of_node = [](mesh::NodeIndex node) { return node.value < 4 ? 1u : 2u; };
    made.file_of_shell = [](mesh::ShellIndex shell) { return shell.value < 2 ? 1u : 0u; };
    return made;
  }();
  return names;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const auto kind = static_cast<mesh::select::EntityKind>(data[0] % 3);
  const std::string_view text(reinterpret_cast<const char*>(data + 1), size - 1);
  const auto chosen = mesh::select::evaluate(sample(), text, kind, names());
  if (!chosen) {
    require(chosen.error().file == "expression" && !chosen.error().message.empty());
    require(chosen.error().line >= 1 && chosen.error().line <= static_cast<long>(text.size()) + 1);
    return 0;
  }
  // twice the complement is the set itself
  const auto again_all = mesh::select::evaluate(sample(), "~(~(" + std::string(text) + "))", kind, names());
  const bool begins_by_taking = text.find('!') != std::string_view::npos;
  if (again_all && !begins_by_taking) require(again_all->nodes == chosen->nodes && again_all->shells == chosen->shells);
  if (chosen->nodes.empty()) return 0;
  std::vector<std::int64_t> ids;
  for (const mesh::NodeIndex node : chosen->nodes) ids.push_back(sample().node_ids[node.value]);
  const auto again = mesh::select::evaluate(sample(), mesh::select::to_expression(ids), mesh::select::EntityKind::node);
  require(again.has_value() && again->nodes == chosen->nodes);
  return 0;
}
