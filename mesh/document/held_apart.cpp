#include "mesh/document/held_apart.h"

#include <algorithm>
#include <cstdint>

#include "base/counted.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::document {

namespace {

constexpr int kCallsOfRing = 3;  ///< after so many the neighbours in one ring more are held
constexpr int kMaxCalls = 10;    ///< then everything is held

/// The shells of the model that those became that made the contacts; ascending.
ShellSet makers_in(const Model& model, const repair::Restructuring& change, const std::vector<contact::NewContact>& made) {
  ShellSet makers;
  for (const contact::NewContact& contact : made)
    for (const ShellIndex shell : contact.by)
      makers.push_back(shell.value < model.shell_count() ? shell : change.new_shells[shell.value - model.shell_count()].parent);
  std::sort(makers.begin(), makers.end());
  makers.erase(std::unique(makers.begin(), makers.end()), makers.end());
  std::erase_if(makers, [&](ShellIndex shell) { return model.is_removed(shell); });
  return makers;
}

}  // namespace

void HeldApart::hold(const Model& model, const repair::Restructuring& change, const Model& after,
                     const std::vector<contact::NewContact>& made) {
  if (why_.empty()) why_ = contact::in_words(after, made);
  ++calls_;
  ShellSet makers = makers_in(model, change, made);
  for (int ring = 0; ring < (calls_ - 1) / kCallsOfRing; ++ring) makers = shells_touching(model, nodes_of(model, makers));
  const std::size_t held = shells_.size();
  shells_.insert(makers.begin(), makers.end());
  const NodeSet nodes = nodes_of(model, makers);
  nodes_.insert(nodes.begin(), nodes.end());
  all_ = calls_ >= kMaxCalls || shells_.size() == held;
}

repair::Rules HeldApart::with(const repair::Rules& rules) const {
  repair::Rules out = rules;
  out.node = [ask = rules.node, this](NodeIndex node) {
    return static_cast<std::uint8_t>(ask(node) | (all_ || nodes_.contains(node) ? repair::kStays | repair::kNeeded : 0));
  };
  out.shell = [ask = rules.shell, this](ShellIndex shell) {
    return static_cast<std::uint8_t>(ask(shell) | (all_ || shells_.contains(shell) ? repair::kStaysAsItIs : 0));
  };
  return out;
}

std::string HeldApart::note() const {
  if (why_.empty()) return {};
  return (all_ ? "the elements are left as they are: " : counted(shells_.size(), "element") + " left as they are: ") + why_;
}

}  // namespace prismesh::mesh::document
