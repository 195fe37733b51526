// The thickness with which each shell takes part in contact.
#pragma once

#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

#include "mesh/model/model.h"

namespace prismesh::mesh::contact {

/// Where a part's contact thickness comes from.
enum class ThicknessFrom : std::uint8_t {
  none,     ///< no shell of the part has one
  section,  ///< the element's own card, else the part's section
  given,    ///< one number for all shells
  contact,  ///< a contact of the deck
};
std::string_view name(ThicknessFrom from);

/// What a contact makes of a shell's thickness where its least distance isn't the mean of both: max(least, min(mean, most)).
struct GapRule {
  double thickness = 0;                                      ///< whose mean with the other shell's it takes
  double least = 0;                                          ///< of two shells the lesser counts
  double most = std::numeric_limits<double>::infinity();     ///< of two shells the greater counts
  double by_mesh = std::numeric_limits<double>::infinity();  ///< no more than the mean of this with the other shell's
};

struct ContactThickness {
  std::vector<double> of_shell;        ///< one a shell, deck's length unit; 0: none, the shell has no contact
  std::vector<ThicknessFrom> of_part;  ///< one a part
  std::vector<PartIndex> without;      ///< parts with shells of which at least one has none, ascending
  /// One a shell; empty: all take the mean. Then `of_shell` is at least what it makes with any thinner shell.
  std::vector<GapRule> rules;
  /// One a shell: how far its contact surface lies from its nodes along its normal; empty: all go through their nodes.
  std::vector<double> offset;

  /// The least distance of two shells without a gap: the mean of their thicknesses, or by the rules.
  double between(ShellIndex a, ShellIndex b) const;
  ThicknessFrom from(PartIndex part) const { return part.valid() ? of_part[part.value] : ThicknessFrom::none; }
};

/// The element's own thickness, else that of its part's section. What isn't a finite number above 0 counts as none.
ContactThickness section_thickness(const Model& model);
/// Sets anew, after contacts have set thicknesses, where each part's come from: where a shell of a part is seen by a contact, from that.
/// `seen`: one a shell, 0: no contact sees it.
void take_contact_thickness(const Model& model, const std::vector<std::uint8_t>& seen, ContactThickness& thickness);
/// The same thickness for every shell. Precondition: finite, above 0.
ContactThickness given_thickness(const Model& model, double thickness);

}  // namespace prismesh::mesh::contact
