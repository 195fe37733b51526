// Finds the regions in which shells are closer than their contact thicknesses allow, without crossing.
#pragma once

#include <vector>

#include "mesh/contact/contact_thickness.h"
#include "mesh/contact/penetrations.h"
#include "mesh/contact/shell_crossings.h"
#include "mesh/model/node_set.h"
#include "mesh/spatial/box_tree.h"

namespace prismesh::mesh::contact {

struct PenetrationWish {
  double gap = 0;                      ///< how far the faces must be apart; finite, at least 0
  const ShellSet* selected = nullptr;  ///< ascending: only pairs with one of them count; nothing: all
  const ShellSet* among = nullptr;     ///< ascending: only pairs of two of them are searched for and grouped; nothing: all
};

/// Returns the regions, the deepest first, then by parts and shells; on all cores, the same whatever their number. Pairs are those of
/// find_close_shells, regions those of group_crossings. Left out, with the neighbours they are grown over: regions with shells of
/// `crossings`, which are perforations; and shells that stand on others (planes that differ by more than 30 degrees) about a free edge that
/// touches: T-junctions. `progress` is asked after some 65,000 shells; stopped, it returns nothing. Preconditions: those of
/// find_close_shells; the crossings are all of the model, ascending.
std::vector<Penetration> find_penetrations(const Model& model, const spatial::BoxTree& tree, const ContactThickness& thickness,
                                           const std::vector<ShellCrossing>& crossings, const PenetrationWish& wish = {},
                                           const Progress& progress = {});

/// The second step: of all pairs that find_close_shells gives, or those of some whole regions and their crossings, both ascending.
std::vector<Penetration> group_close_shells(const Model& model, const ContactThickness& thickness, std::vector<CloseShells> pairs,
                                            const std::vector<ShellCrossing>& crossings, double gap, const ShellSet* selected);
/// The order of regions.
bool comes_first(const Penetration& x, const Penetration& y);

}  // namespace prismesh::mesh::contact
