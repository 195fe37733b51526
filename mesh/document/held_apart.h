// What a repair must leave as it is so that shells don't cross or come too close. Private to mesh/document.
#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include "mesh/contact/new_contacts.h"
#include "mesh/model/model.h"
#include "mesh/repair/restructuring.h"
#include "mesh/repair/rules.h"

namespace prismesh::mesh::document {

class HeldApart {
 public:
  /// Holds the shells and nodes that made contacts, by a change of the model that was tried; with more neighbours the oftener it is called,
  /// and in the end all. Each call holds at least one shell more, but where all are held. `after`: the model with the change.
  void hold(const Model& model, const repair::Restructuring& change, const Model& after, const std::vector<contact::NewContact>& made);

  /// The rules, with what is held. This must outlive them.
  repair::Rules with(const repair::Rules& rules) const;

  /// "3 elements left as they are: part 1 and part 2 would cross"; empty if nothing is held.
  std::string note() const;
  bool holds_all() const { return all_; }

 private:
  std::set<ShellIndex> shells_;
  std::set<NodeIndex> nodes_;
  bool all_ = false;
  int calls_ = 0;
  std::string why_;
};

}  // namespace prismesh::mesh::document
