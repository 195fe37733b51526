#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/counted.h"
#include "base/readable_number.h"
#include "mesh/connections/bond_strip.h"
#include "mesh/connections/sheet_stacks.h"
#include "mesh/deck/editing/new_ids.h"
#include "mesh/deck/editing/text_changes.h"
#include "mesh/deck/formats/formats.h"
#include "mesh/document/apply.h"
#include "mesh/document/deck_relations.h"
#include "mesh/document/flanges.h"
#include "mesh/document/grow_parts.h"
#include "mesh/document/grow_relations.h"
#include "mesh/document/join_sheets.h"
#include "mesh/document/part_marks.h"
#include "mesh/document/restructure.h"
#include "mesh/model/topology_change.h"
#include "mesh/spatial/box_tree.h"

namespace prismesh::mesh::document {

namespace {

using connections::BondCorner;
using connections::BondStrip;
using connections::Flange;
using connections::NoBond;

constexpr std::size_t kMaxBondsTold = 1000;
constexpr double kMaxSolidsOfAFlange = 1e6;

std::string bond_length_words(double length) { return readable(length, 4); }

/// What the new hexahedra get from an existing one, or from the part that is made for them.
struct BondKind {
  PartIndex part;
  std::uint32_t example = kNoExample;               ///< as TopologyChange::element_examples
  std::optional<std::array<NodeIndex, 8>> corners;  ///< of the existing one, whose cards those of new nodes follow
  bool joins_sets = false;                          ///< new nodes join the sets of these
};

/// Errors: what the edit asks for isn't made in this version, contradicts itself, or a value is missing.
Result<void> check_bond(const Document& document, const Bond& edit) {
  if (!document.deck->references || document.deck->files.empty()) return fail("", "bond: the document has no deck");
  if (document.deck->format != deck::Format::ls_dyna && document.deck->format != deck::Format::abaqus)
    return fail(
        "", "bond: this version makes no bonds in " + std::string(name(document.deck->format)) + " decks, but in LS-DYNA and Abaqus decks");
  if (edit.like) {
    if (edit.density || edit.youngs_modulus || edit.poissons_ratio)
      return fail("", "bond: \"like\" takes the material from the existing solid; its values can't be given too");
    return {};
  }
  const std::pair<const char*, bool> values[] = {{"density", edit.density.has_value()},
                                                 {"youngs_modulus", edit.youngs_modulus.has_value()},
                                                 {"poissons_ratio", edit.poissons_ratio.has_value()}};
  for (const auto& [field, given] : values)
    if (!given)
      return fail("", "bond: \"" + std::string(field) +
                          "\" is missing: of the adhesive, in the deck's units; or \"like\" names a solid (\"solid:9\")");
  return {};
}

/// Errors: the flange has other than two sheets; the strip doesn't fit it.
Result<void> check_flange(const Bond& edit, const Flange& flange) {
  if (flange.sheets() != 2)
    return fail("", "bond: the flange has " + std::to_string(flange.sheets()) + " sheets; this version bonds flanges of two");
  const auto longer = [](const std::string& what, double length, const std::string& than, double limit) {
    return fail("", "bond: the " + what + ", " + bond_length_words(length) + ", is larger than " + than + ", " + bond_length_words(limit));
  };
  if (edit.width > flange.mean_width) return longer("width", edit.width, "the flange's", flange.mean_width);
  if (edit.length > flange.length) return longer("length", edit.length, "the flange's", flange.length);
  if (flange.length / edit.length > kMaxSolidsOfAFlange)
    return fail("", "bond: a length of " + bond_length_words(edit.length) + " on a flange of " + bond_length_words(flange.length) +
                        " makes over a million hexahedra");
  if (!flange.closed && 2 * edit.end_distance + edit.length > flange.length)
    return longer("end distance", edit.end_distance, "leaves room for a hexahedron", (flange.length - edit.length) / 2);
  return {};
}

Result<BondKind> like_solid(const Document& document, const std::string& like) {
  const Model& model = document.current().model;
  const Result<NamedElement> named = parse_element(like, "bond", "a solid, as \"solid:9\"");
  if (!named) return fail(named.error());
  const std::string words = std::string(name(named->element_class)) + " " + std::to_string(named->id);
  if (named->element_class != ElementClass::solid) return fail("", "bond: " + words + " can't be the example: it is no solid");
  const Result<std::uint32_t> element = index_of_element(document, *named, "bond");
  if (!element) return fail(element.error());
  constexpr auto c = static_cast<std::size_t>(ElementClass::solid);
  const ElementBlock& block = *model.elements[c];
  const std::span<const NodeIndex> nodes =
      std::span(block.nodes).subspan(block.first_node[*element], block.first_node[*element + 1] - block.first_node[*element]);
  std::vector<NodeIndex> different(nodes.begin(), nodes.end());
  std::sort(different.begin(), different.end());
  if (nodes.size() != 8 || std::adjacent_find(different.begin(), different.end()) != different.end())
    return fail("", "bond: " + words + " can't be the example: it is no hexahedron with eight nodes");
  if (!block.part[*element].valid()) return fail("", "bond: " + words + " can't be the example: it has no part");
  BondKind kind;
  kind.part = block.part[*element];
  kind.example = *element;
  kind.corners.emplace();
  std::copy(nodes.begin(), nodes.end(), kind.corners->begin());
  kind.joins_sets = true;
  if (model.topology_change && *element >= model.topology_change->deck_elements[c]) {
    kind.example = model.topology_change->element_examples[c][*element - model.topology_change->deck_elements[c]];
    const PlacedNode* placed = placed_node(model, nodes[0]);
    kind.joins_sets = placed != nullptr && placed->joins != kJoinsNone;
  }
  return kind;
}

/// A side of a part's shells: that to which the normals point, or the other one.
using SheetSide = deck::CardWriter::BondPart::SheetSide;

/// The sides of the sheets that face the first four corners of the hexahedra, and those that face the other four; ascending.
std::array<std::vector<SheetSide>, 2> facing_sides(const Model& model, const std::vector<BondStrip>& strips) {
  std::array<std::vector<SheetSide>, 2> facing;
  for (const BondStrip& strip : strips)
    for (const std::array<std::uint32_t, 8>& solid : strip.solids)
      for (std::size_t c = 0; c < solid.size(); ++c) {
        const BondCorner &own = strip.corners[solid[c]], &other = strip.corners[solid[(c + 4) % 8]];
        const Vec3 normal = connections::unit_normal(model, own.sheet.shell);
        facing[c / 4].push_back(
            {(*model.parts)[model.shell_parts[own.sheet.shell.value].value].id, normal.dot(other.sheet.point - own.sheet.point) > 0});
      }
  for (std::vector<SheetSide>& sides : facing) {
    std::sort(sides.begin(), sides.end());
    sides.erase(std::unique(sides.begin(), sides.end()), sides.end());
  }
  return facing;
}

/// The parts of the sheets that the faces of the existing solid lie on: of its first four corners, and of the other four.
std::array<PartIndex, 2> parts_at_faces(const Model& model, const std::array<NodeIndex, 8>& corners) {
  const spatial::BoxTree tree(model);
  std::array<PartIndex, 2> parts;
  for (std::size_t e = 0; e < 2; ++e) {
    Vec3 middle = Vec3::Zero();
    for (std::size_t c = 0; c < 4; ++c) middle += model.position(corners[c + 4 * e]) / 4;
    if (const std::optional<spatial::SurfacePoint> nearest = tree.closest(middle)) parts[e] = model.shell_parts[nearest->shell.value];
  }
  return parts;
}

/// Where each face is tied by a surface of its own: turns strips over so that the first corners lie on the sheets that those of the
/// existing solid lie on, without one on the part with the lower number. Says which strips the surfaces of the existing one may not hold.
void agree_on_faces(const Model& model, const BondKind* kind, std::vector<BondStrip>& strips, EditReport& report) {
  std::optional<std::array<PartIndex, 2>> wanted;
  if (kind != nullptr) wanted = parts_at_faces(model, *kind->corners);
  bool told = false;
  for (BondStrip& strip : strips) {
    std::array<PartIndex, 2> parts;
    for (std::size_t e = 0; e < 2; ++e) parts[e] = model.shell_parts[strip.corners[strip.solids.front()[4 * e]].sheet.shell.value];
    const std::array<PartIndex, 2> turned{parts[1], parts[0]};
    const bool turns =
        wanted ? parts != *wanted && (turned == *wanted || parts[0] == (*wanted)[1] || parts[1] == (*wanted)[0]) : parts[1] < parts[0];
    if (turns) connections::turn_over(strip);
    if (!wanted || (turns ? turned : parts) == *wanted || told) continue;
    told = true;
    report.notes.push_back("the existing solid joins " + sheet_part_words(model, (*wanted)[0]) + " and " +
                           sheet_part_words(model, (*wanted)[1]) + ": bonds of " + sheet_part_words(model, parts[0]) + " and " +
                           sheet_part_words(model, parts[1]) + " hold only if its surfaces have the sheets too");
  }
}

Result<BondKind> make_bond_part(const Document& document, const Bond& edit, const std::vector<PartIndex>& parts,
                                const std::vector<BondStrip>& strips, Generation& next) {
  Model& model = next.model;
  deck::CardWriter::BondPart wanted;
  for (const PartIndex part : parts) wanted.sheets.push_back((*model.parts)[part.value].id);
  wanted.facing = facing_sides(model, strips);
  wanted.density = *edit.density;
  wanted.youngs_modulus = *edit.youngs_modulus;
  wanted.poissons_ratio = *edit.poissons_ratio;
  Result<std::pair<Part, std::string>> made = deck::card_writer(document.deck->format)->bond_part(*document.deck, model, wanted);
  if (!made) return fail("", "bond: " + made.error().text());
  BondKind kind;
  kind.part = add_part(model, std::move(made->first), {std::move(made->second)});
  grow_parts(model.parts->size(), next);
  return kind;
}

/// Of the shells of the flange only.
spatial::BoxTree tree_of_flange(const Model& model, const spatial::BoxTree& all, const Flange& flange) {
  ShellSet out;
  for (std::size_t s = 0; s < model.shell_count(); ++s)
    if (!std::binary_search(flange.shells.begin(), flange.shells.end(), ShellIndex(s)) && all.contains(ShellIndex(s))) out.emplace_back(s);
  spatial::BoxTree tree = all;
  tree.leave_out(out);
  return tree;
}

/// The middles of the solids.
PlacesTaken solids_there(const Model& model, double cell) {
  PlacesTaken taken(cell);
  const auto& block = model.elements[static_cast<std::size_t>(ElementClass::solid)];
  for (std::size_t e = 0; block && e < block->size(); ++e) {
    Vec3 middle = Vec3::Zero();
    double count = 0;
    for (std::size_t n = block->first_node[e]; n < block->first_node[e + 1]; ++n)
      if (block->nodes[n].valid()) middle += model.position(block->nodes[n]), ++count;
    if (count > 0) taken.add(middle / count);
  }
  return taken;
}

std::string words_of(NoBond why) {
  switch (why) {
    case NoBond::off_sheets: return "a corner doesn't lie between the two sheets";
    case NoBond::no_room:
      return "there is no room between the sheets' faces; \"from\": \"middles\" goes from middle surface to middle surface";
    case NoBond::turned_over: return "the hexahedron would be folded or turned over";
  }
  return {};
}

/// The strips without hexahedra where solids are already.
class BondSearch {
 public:
  BondSearch(const Model& model, const Bond& edit, EditReport& report)
      : model_(model), edit_(edit), report_(report), there_(solids_there(model, std::min(edit.width, edit.length) / 2)), all_(model) {
    report_.bonded.emplace();
  }

  void search(const Flange& flange) {
    connections::BondShape shape;
    shape.width = edit_.width;
    shape.length = edit_.length;
    shape.end_distance = edit_.end_distance;
    shape.gap = edit_.flange.gap;
    shape.from_middle = edit_.from_middles;
    BondStrip strip = connections::lay_strip(model_, tree_of_flange(model_, all_, flange), flange, shape);
    for (const connections::BondLeft& left : strip.left) leave(left.at, words_of(left.why));
    std::erase_if(strip.solids, [&](const std::array<std::uint32_t, 8>& solid) {
      Vec3 middle = Vec3::Zero();
      for (const std::uint32_t corner : solid) middle += strip.corners[corner].point / 8;
      const bool taken = there_.near(middle);
      if (taken) leave(middle, "a solid is there already");
      return taken;
    });
    if (strip.solids.empty()) return;
    Bonded& bonded = *report_.bonded;
    bonded.thinnest = bonded.solids_added == 0 ? strip.thinnest : std::min(bonded.thinnest, strip.thinnest);
    bonded.thickest = std::max(bonded.thickest, strip.thickest);
    bonded.solids_added += strip.solids.size();
    strips_.push_back(std::move(strip));
  }

  std::vector<BondStrip>& strips() { return strips_; }
  const std::string& first_reason() const { return first_; }

 private:
  void leave(const Vec3& at, const std::string& why) {
    Bonded& bonded = *report_.bonded;
    ++bonded.solids_left;
    if (first_.empty()) first_ = why;
    if (bonded.left_out.size() < kMaxBondsTold) bonded.left_out.push_back({{at.x(), at.y(), at.z()}, why});
  }

  const Model& model_;
  const Bond& edit_;
  EditReport& report_;
  PlacesTaken there_;
  spatial::BoxTree all_;
  std::vector<BondStrip> strips_;
  std::string first_;
};

/// The parts of the sheets, ascending. Errors: a sheet has none, which no contact could name.
Result<std::vector<PartIndex>> parts_bonded(const Model& model, const std::vector<BondStrip>& strips) {
  std::vector<PartIndex> parts;
  for (const BondStrip& strip : strips)
    for (const BondCorner& corner : strip.corners) parts.push_back(model.shell_parts[corner.sheet.shell.value]);
  std::sort(parts.begin(), parts.end());
  parts.erase(std::unique(parts.begin(), parts.end()), parts.end());
  for (const PartIndex part : parts)
    if (!part.valid()) return fail("", "bond: a sheet there has no part, so that no contact can name it");
  return parts;
}

/// What a new node's card follows: nodes of the example's face, or the sheet's nearest node.
NodeOrigin origin_of_corner(const Model& model, const BondKind& kind, const BondCorner& corner, bool upper) {
  if (!kind.corners) return corner_origin(model, corner.sheet);
  NodeOrigin origin;
  for (std::size_t n = 0; n < 4; ++n) {
    origin.parent[n] = (*kind.corners)[n + (upper ? 4 : 0)];
    origin.weight[n] = 0.25;
  }
  return origin;
}

Result<void> add_solids(const BondKind& kind, const BondStrip& strip, deck::NewIds& ids, Model& model) {
  std::vector<std::optional<NodeIndex>> nodes(strip.corners.size());
  const std::uint32_t joins = kind.joins_sets ? kJoinsCommon : kJoinsNone;
  for (const std::array<std::uint32_t, 8>& solid : strip.solids) {
    std::array<NodeIndex, 8> of_solid;
    for (std::size_t c = 0; c < solid.size(); ++c) {
      std::optional<NodeIndex>& node = nodes[solid[c]];
      if (!node) {
        const BondCorner& corner = strip.corners[solid[c]];
        const NodeOrigin origin = origin_of_corner(model, kind, corner, c >= 4);
        const Result<std::int64_t> id = ids.placed_node(origin, joins);
        if (!id) return fail(id.error());
        node = add_placed_node(model, *id, corner.point, origin, joins);
      }
      of_solid[c] = *node;
    }
    const Result<std::int64_t> id = ids.element(ElementClass::solid, kind.example);
    if (!id) return fail(id.error());
    add_element(model, ElementClass::solid, *id, kind.part, of_solid, kind.example);
  }
  return {};
}

}  // namespace

Result<void> apply_edit(const Document& document, const Bond& edit, Generation& next, EditReport& report, const Progress& progress) {
  const Generation& before = document.current();
  if (const Result<void> sound = check_bond(document, edit); !sound) return sound;
  std::optional<BondKind> kind;
  if (edit.like) {  // before the flanges are looked for: a wrong name is told at once
    Result<BondKind> like = like_solid(document, *edit.like);
    if (!like) return fail(like.error());
    kind = *like;
  }
  const Result<std::vector<Flange>> flanges = flanges_wanted(before, edit.flange, "bond", progress);
  if (!flanges) return fail(flanges.error());
  for (const Flange& flange : *flanges)
    if (const Result<void> fits = check_flange(edit, flange); !fits) return fits;
  BondSearch search(before.model, edit, report);
  for (const Flange& flange : *flanges) search.search(flange);
  const Bonded& bonded = *report.bonded;
  if (bonded.solids_added == 0)
    return fail("", "bond: none of " + counted(bonded.solids_left, "solid") + " can be made: " + search.first_reason());
  const Result<std::vector<PartIndex>> sheets = parts_bonded(before.model, search.strips());
  if (!sheets) return fail(sheets.error());
  if (const Result<void> open = refuse_locked(before, *sheets, "a bond", "bond"); !open) return open;
  if (document.deck->format == deck::Format::abaqus) agree_on_faces(before.model, kind ? &*kind : nullptr, search.strips(), report);
  if (kind) {
    if (const Result<void> open = refuse_locked(before, {kind->part}, "elements", "bond"); !open) return open;
    note_untied(document, kind->part, *sheets, "bonds", report);
  } else {
    Result<BondKind> made = make_bond_part(document, edit, *sheets, search.strips(), next);
    if (!made) return fail(made.error());
    kind = *made;
  }
  deck::NewIds ids(*document.deck, next.model);
  for (const BondStrip& strip : search.strips())
    if (const Result<void> added = add_solids(*kind, strip, ids, next.model); !added) return added;
  if (const Result<void> sound = deck::can_restructure(*document.deck, document.opened->model, next.model, {}); !sound) return sound;

  settle_growth(before, {}, next);
  grow_relations(before.model, next);
  const Changes changes = changes_between(before.model, next.model);
  mark_parts_at(changes.added_nodes, next);
  report.elements_added = changes.other_elements();
  report.notes.push_back(counted(bonded.solids_added, "solid") + " added to " + sheet_part_words(next.model, kind->part) + ", " +
                         bond_length_words(bonded.thinnest) + " to " + bond_length_words(bonded.thickest) + " thick");
  if (bonded.solids_left > 0)
    report.notes.push_back(counted(bonded.solids_left, "solid") + " left out; the first: " + search.first_reason());
  note_missing_files(document, changes, report);
  return {};
}

}  // namespace prismesh::mesh::document
