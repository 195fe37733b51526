#include <algorithm>

#include "mesh/deck/editing/edit_checks.h"
#include "mesh/document/apply.h"
#include "mesh/document/restructure.h"
#include "mesh/document/scope.h"
#include "mesh/model/topology_change.h"
#include "mesh/repair/manual_operation.h"

namespace prismesh::mesh::document {

namespace {

/// The shells and nodes that an operation by hand acts on.
struct HandTargets {
  ShellSet shells;
  NodeSet nodes;
};

/// The shell with an id. `word`: shell, quad or tri. Errors: none, or two, has it.
Result<ShellIndex> find_shell_by_hand(const Model& model, const std::string& word, std::int64_t id) {
  std::vector<ShellIndex> found{model.find_shell(id)};
  if (model.second_shells)
    for (const ShellIndex shell : *model.second_shells)
      if (model.shell_ids[shell.value] == id) found.push_back(shell);
  std::erase_if(
      found, [&](ShellIndex shell) { return !shell.valid() || (word != "shell" && model.shell(shell).is_triangle() != (word == "tri")); });
  const std::string number = std::to_string(id);
  if (found.empty()) return fail("", "there is no " + word + " " + number);
  if (found.size() > 1)
    return fail("", word + " " + number + " is two shells; \"quad:" + number + "\" and \"tri:" + number + "\" name one of them");
  return found.front();
}

Result<HandTargets> find_hand_targets(const Model& model, const Restructure& edit) {
  const std::string what(repair::name(edit.operation));
  HandTargets targets;
  for (const std::string& at : edit.at) {
    const std::size_t colon = at.find(':');
    const std::string kind = at.substr(0, colon), digits = colon == std::string::npos ? "" : at.substr(colon + 1);
    const bool is_id = !digits.empty() && digits.size() <= 18 && digits.find_first_not_of("0123456789") == std::string::npos;
    const bool is_shell = kind == "shell" || kind == "quad" || kind == "tri";
    if (!is_id || (!is_shell && kind != "node")) return fail("", what + ": \"" + at + "\" is neither \"shell:ID\" nor \"node:ID\"");
    const std::int64_t id = std::stoll(digits);
    Result<ShellIndex> shell = ShellIndex();
    if (is_shell && !(shell = find_shell_by_hand(model, kind, id))) return fail("", what + ": " + shell.error().message);
    const NodeIndex node = kind == "node" ? model.find_node(id) : NodeIndex();
    if (!is_shell && !node.valid()) return fail("", what + ": there is no " + kind + " " + digits);
    if (is_shell) targets.shells.push_back(*shell);
    if (node.valid()) targets.nodes.push_back(node);
  }
  if (targets.shells.empty() && targets.nodes.empty()) return fail("", what + ": \"at\" names no shell and no node");
  return targets;
}

/// Refuses to divide a shell that a card forbids to divide; the rules refuse it too, but name no card.
Result<void> refuse_indivisible(const Document& document, const Model& model, const ShellSet& shells) {
  if (!document.deck->references) return {};
  deck::DivisionCheck division(*document.deck);
  for (const ShellIndex shell : shells)
    if (Result<void> may = division.may_be_divided(model.shell_ids[deck_ancestor(model, shell).value]); !may) return may;
  return {};
}

}  // namespace

Result<void> apply_edit(const Document& document, const Restructure& edit, Generation& next, EditReport& report) {
  const Generation& current = document.current();
  const Result<HandTargets> targets = find_hand_targets(current.model, edit);
  if (!targets) return fail(targets.error());
  if (edit.operation == repair::Operation::split)
    if (const Result<void> may = refuse_indivisible(document, current.model, targets->shells); !may) return may;
  const repair::Options options;
  NodeSet nodes = targets->nodes;
  std::sort(nodes.begin(), nodes.end());
  ShellSet about = shells_touching(current.model, nodes);
  about.insert(about.end(), targets->shells.begin(), targets->shells.end());
  const relax::ReferenceSurface surface = surface_about(current, about, options.relax.feature_angle);
  const Result<repair::Restructuring> change =
      repair::apply_manual_operation({current.model, surface, rules_for(document, current), judged_by(document), options},
                                     {edit.operation, targets->shells, targets->nodes});
  if (!change) return fail("", std::string(repair::name(edit.operation)) + ": " + change.error().message);
  return restructure(document, *change, next, report);
}

}  // namespace prismesh::mesh::document
