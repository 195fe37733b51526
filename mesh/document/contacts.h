// Finds where the shells of a generation cross or are too close, and describes each place.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/progress.h"
#include "mesh/contact/contact_thickness.h"
#include "mesh/contact/kept_contacts.h"
#include "mesh/contact/triangle_crossing.h"
#include "mesh/document/generation.h"
#include "mesh/model/node_set.h"
#include "mesh/spatial/box_tree.h"

namespace prismesh::mesh::document {

/// What the search keeps from one state of a document to the next. Of one document only.
class ContactSearch {
 public:
  /// The tree of the model's shells: built the first time, then brought up to date at the cost of what differs.
  const spatial::BoxTree& tree(const Model& model);
  /// The thickness by elements and sections; computed again only where the model's differ from those of the last call.
  std::shared_ptr<const contact::ContactThickness> section_thickness(const Model& model);
  /// As contact_thickness(); of decks without contacts that can be read it costs no more than section_thickness().
  std::shared_ptr<const contact::ContactThickness> thickness(const Generation& generation);
  /// What was found last, of all shells.
  contact::KeptContacts& kept() { return kept_; }

 private:
  std::optional<spatial::BoxTree> tree_;
  std::shared_ptr<const contact::ContactThickness> thickness_;
  std::optional<Model> thickness_of_;
  contact::KeptContacts kept_;
};

struct ContactWish {
  std::optional<std::string> select;  ///< an expression: only where one of its shells takes part
  double gap = 0;                     ///< how far faces must be apart, deck's length unit
  std::optional<double> thickness{};  ///< of all shells; nothing: as below
  bool by_contacts = true;            ///< what the deck's contacts say (mesh/contact/deck_contacts.h), else that of elements and sections
};

/// A node that is too close to the other side, or has entered it, and where it must go.
struct ContactVector {
  NodeIndex node;
  Vec3 to = Vec3::Zero();
  double depth = 0;  ///< the way's length
};

/// A region in which shells cross, or are too close.
struct ContactRegion {
  std::string kind;                 ///< "perforation", "penetration" or "clearance"
  std::string a, b;                 ///< "part:1"; "" for shells without a part
  std::string name_a, name_b;       ///< of the parts
  ShellSet shells_a, shells_b;      ///< of each side, ascending
  double length = 0;                ///< of the curve along which they cross; else 0
  std::optional<double> max_depth;  ///< nothing: half through
  double mean_depth = 0;            ///< if the max is known
  double area = 0;                  ///< of the shells of the smaller side
  Vec3 at = Vec3::Zero();           ///< the deepest place; half through: a point of the curve
  std::string worst_a, worst_b;     ///< "shell:7" of each side: the deepest pair, or the first that cross
  bool joined = false;              ///< a weld, bond or tie joins the parts there
  std::string contact;              ///< the deck's contact that keeps the worst pair apart: ContactCard::name(); empty: none is known
  bool clear = false;               ///< the edit separate would remove it: set by find_clear(), which tries it
  std::string why;                  ///< why it wouldn't; or that it wasn't tried
  std::string thickness_from;
  std::vector<contact::CurveSegment> curve;  ///< along which they cross
  std::vector<ContactVector> vectors;        ///< ascending by node within a side
};

struct Contacts {
  std::size_t perforations = 0, penetrations = 0, clearances = 0;
  std::vector<ContactRegion> regions;           ///< perforations, then the others; of each the worst first
  std::vector<std::int64_t> without_thickness;  ///< ids of parts, ascending
};

/// How thick shells are in the deck's contacts; in decks without contacts that can be read, by elements and sections. Costs all shells.
contact::ContactThickness contact_thickness(const Generation& generation);

/// On all cores; the same whatever their number. Without `select` costs what differs from the state that was searched last with the same
/// gap and thicknesses, and the regions about it. Errors: of the expression; a gap or thickness that isn't usable; cancelled.
Result<Contacts> find_contacts(const Generation& generation, ContactSearch& search, const ContactWish& wish, const Progress& progress = {});

}  // namespace prismesh::mesh::document
