// What the contacts of a deck say about which shells see each other, and how thick they are there. In the numbers of the deck; mesh/contact
// finds the shells.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "mesh/model/references.h"

namespace prismesh::mesh {

/// The shells of one side of a contact.
struct ContactSide {
  bool everything = false;           ///< all parts
  bool all_but = false;              ///< all parts but the named ones
  std::optional<Referred> referred;  ///< what is named: a part, or a set of parts, shells, segments, nodes; nothing: none
  std::int64_t id = 0;               ///< of that
  double thickness = 0;              ///< of all its shells, deck's length unit; 0: their own
  double scale = 0;                  ///< of their own thickness; 0: 1
};

struct ContactCard {
  std::string keyword;  ///< as in the deck: "CONTACT_AUTOMATIC_SINGLE_SURFACE_ID"
  std::int64_t id = 0;  ///< 0: none
  std::string title;
  ContactSide a;
  std::optional<ContactSide> b;  ///< nothing: a side with itself
  bool ties = false;             ///< it holds nodes at a surface instead of keeping surfaces apart
  /// Whether shells are as thick as they are; false: their middle surfaces touch.
  bool thick = true;
  /// Whether shells are at most 0.4 times their shortest side thick, unless a thickness is given.
  bool limited_by_sides = false;

  /// "CONTACT_AUTOMATIC_SINGLE_SURFACE 32 Body Interaction", without the options that only say how it is written.
  std::string name() const;
};

/// What a part says about its contacts.
struct PartContact {
  double thickness = 0;  ///< in all contacts, before all else; 0: none
  double scale = 0;      ///< of its own thickness, before that of a contact; 0: none
};

struct ContactCards {
  std::vector<ContactCard> cards;               ///< in the deck's order
  std::map<std::int64_t, PartContact> of_part;  ///< by part id
  double thickness = 0;                         ///< of all shells in all contacts, after all else; 0: none
};

}  // namespace prismesh::mesh
