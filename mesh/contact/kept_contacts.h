// The perforations and penetrations of a model, brought from one state to the next at the cost of what changed.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "base/progress.h"
#include "mesh/contact/contact_thickness.h"
#include "mesh/contact/pair_pool.h"
#include "mesh/contact/penetrations.h"
#include "mesh/contact/perforations.h"
#include "mesh/contact/shell_crossings.h"
#include "mesh/model/model.h"
#include "mesh/spatial/box_tree.h"

namespace prismesh::mesh::contact {

/// A state of a model whose contacts are looked for.
struct StateToSearch {
  const Model& model;            ///< with its adjacency
  const spatial::BoxTree& tree;  ///< of the model
  std::shared_ptr<const ContactThickness> thickness;
  double gap = 0;  ///< how far faces must be apart; finite, at least 0
};

class KeptContacts {
 public:
  /// Finds the contacts of a state, bit for bit as find_perforations, perforation_depths and find_penetrations do. Of another state of the
  /// same model (the next one, or any other) only pairs about changed shells are measured, and those regions put together again whose
  /// shells changed, or are so near a changed one that a path over the sheet may have changed, or are connected with such ones; all where
  /// more than an eighth of the shells changed. Shells, nodes and parts that both states have keep their index. `progress`: as of the
  /// searches, 0 to 1. Returns whether it wasn't stopped; stopped, everything is as before.
  bool search(const StateToSearch& state, const Progress& progress = {});

  const std::vector<Perforation>& perforations() const { return found_.perforations; }  ///< as find_perforations
  const std::vector<PerforationDepth>& depths() const { return found_.depths; }         ///< of each, without thicknesses
  const std::vector<Penetration>& penetrations() const { return found_.penetrations; }  ///< as find_penetrations

 private:
  struct Regions {
    std::vector<Perforation> perforations;
    std::vector<PerforationDepth> depths;
    std::vector<spatial::FloatBox> measured;  ///< of each depth: a change that doesn't touch this box doesn't change it
    std::vector<Penetration> penetrations;
  };
  /// All pairs that cross or are too close, whether they count or not.
  struct Pairs {
    PairPool<ShellCrossing> crossings;
    PairPool<CloseShells> close;
  };
  struct State {
    Model model;
    spatial::BoxTree tree;
    std::shared_ptr<const ContactThickness> thickness;
    double gap = 0;
    double reach = 0;  ///< shells farther apart aren't too close, wherever they are
  };
  class Update;

  std::optional<State> at_;
  Pairs pairs_;
  Regions found_;
};

}  // namespace prismesh::mesh::contact
