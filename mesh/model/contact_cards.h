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

/// Entities that a side names one by one, where the format's groups aren't the deck's sets. Ids first, first + step, ... last.
struct ContactMember {
  Referred referred = Referred::part;  ///< part, shell or node
  std::int64_t first = 0, last = 0, step = 1;
  bool takes_away = false;
};

/// The shells of one side of a contact.
struct ContactSide {
  bool everything = false;               ///< all parts
  bool all_but = false;                  ///< all parts but the named ones
  std::optional<Referred> referred;      ///< what is named: a part, or a set of parts, shells, segments, nodes; nothing: none
  std::int64_t id = 0;                   ///< of that
  std::vector<ContactMember> members{};  ///< besides; what they take away goes last
  double thickness = 0;                  ///< of all its shells, deck's length unit; 0: their own
  double scale = 0;                      ///< of their own thickness; 0: 1
};

/// The distance at which a contact keeps shells apart, where it isn't the mean of thicknesses: /INTER/TYPE7. In the deck's length unit.
struct ContactGap {
  bool variable = false;  ///< the mean of both thicknesses, between the limits; else `min` everywhere
  double min = 0;         ///< 0: from the thickness and the sides of the main surface
  double max = 0;         ///< 0: none
  double scale = 1;       ///< of the thicknesses
  double mesh_share = 0;  ///< at most this share of both shells' shortest sides together; 0: no such limit
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
  std::optional<ContactGap> gap{};  ///< then neither the sides' thickness and scale nor the flags above count

  /// "CONTACT_AUTOMATIC_SINGLE_SURFACE 32 Body Interaction", without the options that only say how it is written.
  std::string name() const;
};

/// What a part says about its contacts.
struct PartContact {
  double thickness = 0;  ///< in all contacts, before all else; 0: none
  double scale = 0;      ///< of its own thickness, before that of a contact; 0: none
};

/// Whether contact surfaces lie where sections offset them from the nodes.
enum class ContactOffsets : std::uint8_t {
  ignored,         ///< they go through the nodes
  of_shell,        ///< the offset is a share of the shell's own thickness
  of_contact,      ///< of its thickness in the contact
  of_every_shell,  ///< of its own thickness, whether or not a contact that is read sees it
};

struct ContactCards {
  std::vector<ContactCard> cards;               ///< in the deck's order
  std::map<std::int64_t, PartContact> of_part;  ///< by part id
  double thickness = 0;                         ///< of all shells in all contacts, after all else; 0: none
  ContactOffsets offsets = ContactOffsets::ignored;
  /// By section id: how far the middle of a shell lies from its nodes along its normal, as a share of its thickness. Sections without an
  /// offset are left out.
  std::map<std::int64_t, double> offset_of_section;
};

}  // namespace prismesh::mesh
