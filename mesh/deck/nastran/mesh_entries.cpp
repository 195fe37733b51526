#include "mesh/deck/nastran/mesh_entries.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::nastran {
namespace {

/// Of a piece. A text with more is no deck.
constexpr std::size_t kMaxUnreadNodes = 1000;

bool is_all_digits(std::string_view text) { return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos; }

std::string out_of_order(std::string_view entry) {
  return "the continuation of this " + std::string(entry) +
         " has another name than the line before asks for: continuations out of order aren't read (pre-processors can write them in order)";
}

/// Says that the card's id isn't read as a number. `needs_id`: the sentence about the field's text, up to that text.
std::string without_id(const EntryCard& card, std::string_view entry, const std::string& needs_id) {
  const std::string_view text = card.fields.text(0);
  return is_all_digits(text) ? "the id of a " + std::string(entry) + " may have up to 18 digits, but this one has " + quoted(text)
                             : needs_id + quoted(text);
}

/// A property that the card leaves out has the element's id.
std::int64_t part_of(const Card& card, const ElementForm& form, std::int64_t id) {
  if (form.property < 0) return kNoPart;
  const auto field = static_cast<std::size_t>(form.property);
  return card.blank(field) ? id : card.integer_or_zero(field);
}

// --- shells ---

/// Ids of the mid-side nodes, 0 where there is none.
std::array<std::int64_t, 4> midside_nodes(const Card& card, const ElementForm& form, const ShellFields& fields) {
  std::array<std::int64_t, 4> midside{};
  for (std::size_t i = 0; i < fields.midside; ++i)
    midside[i] = std::max<std::int64_t>(card.integer_or_zero(form.first + fields.corners + i), 0);
  return midside;
}

/// The mean of the thicknesses at the corners; 0 where the card has none. Where the property completes them, they are noted for later.
float own_thickness(const Card& card, const ShellFields& fields, std::uint32_t shell, PieceFacts& facts) {
  if (fields.thickness == 0) return 0;
  ThicknessFields own{shell, 0, 0, fields.corners, card.integer_or_zero(fields.relative) == 1};
  for (std::size_t corner = 0; corner < fields.corners; ++corner) {
    const std::optional<double> value = card.real(fields.thickness + corner);
    if (card.blank(fields.thickness + corner) || !value) continue;
    own.sum += *value;
    ++own.given;
  }
  if (own.given == 0) return 0;
  const auto mean = static_cast<float>(own.sum / own.given);
  if (own.given == own.corners && !own.relative) return mean;
  facts.thickness.push_back(own);
  return mean;
}

void read_shell(const EntryCard& card, const ElementForm& form, std::int64_t id, bool is_complete, PieceTarget& target) {
  const ShellFields fields = shell_fields(form.name);
  const std::array<std::int64_t, 4> midside = midside_nodes(card.fields, form, fields);
  const bool has_midside = std::any_of(midside.begin(), midside.end(), [](std::int64_t node) { return node > 0; });
  ++target.cards.counts.of_shell(fields.corners == 3, has_midside);
  if (!is_complete) {
    ++target.cards.left_out.of_shell(fields.corners == 3, has_midside);
    target.cards.hide(ElementClass::shell, card.place.offset, id, target.nodes);
    return target.cards.note("incomplete-element", card.place.offset, id);
  }
  if (form.name == "CQUAD" && card.fields.integer_or_zero(10) > 0)
    target.facts.note("centre-node", card.place.offset, "the centre nodes of CQUAD elements aren't moved along with them");
  const auto index = static_cast<std::uint32_t>(target.cards.shells.id.size());
  ShellEntry shell{id, part_of(card.fields, form, id), {}, card.place.offset, card.fields.layout(), 0};
  for (std::size_t i = 0; i < 4; ++i)
    shell.nodes[i] = card.fields.integer_or_zero(form.first + std::min<std::size_t>(i, fields.corners - 1u));
  shell.thickness = own_thickness(card.fields, fields, index, target.facts);
  target.entities.add(shell);
  if (has_midside) target.cards.shells.midside.emplace_back(index, midside);
}

// --- other elements ---

void add_element(const EntryCard& card, const ElementForm& form, std::int64_t id, const std::vector<std::int64_t>& nodes,
                 PieceCards& cards) {
  RawElements& to = cards.elements[static_cast<std::size_t>(form.element_class)];
  to.id.push_back(id);
  to.part.push_back(part_of(card.fields, form, id));
  to.nodes.insert(to.nodes.end(), nodes.begin(), nodes.end());
  to.first_node.push_back(static_cast<std::uint32_t>(to.nodes.size()));
  to.offset.push_back(card.place.offset);
  // Beside the mesh, entries of different names with one number are found in many decks.
  const bool by_name = form.element_class == ElementClass::mass || form.element_class == ElementClass::other;
  to.numbering.push_back(by_name ? numbering_of(form.name) : 0);
}

/// The second element on a card of pairs, if there is one.
void add_second_of_pair(const EntryCard& card, const ElementForm& form, PieceCards& cards) {
  const std::int64_t id = card.fields.integer_or_zero(4);
  const std::vector<std::int64_t> nodes{card.fields.integer_or_zero(5), card.fields.integer_or_zero(6)};
  if (id > 0 && nodes[0] > 0 && nodes[1] > 0) add_element(card, form, id, nodes, cards);
}

}  // namespace

void fail_at(PieceCards& cards, std::size_t offset, std::string message) {
  if (!cards.error) cards.error = {offset, std::move(message)};
}

void note_too_long(const EntryCard& card, std::string_view entry, PieceFacts& facts) {
  facts.note("long-card", card.place.offset,
             "the " + std::string(entry) + " card has more fields than a card can have; the last ones aren't read");
}

namespace {

/// A grid point that can't be read: the deck is refused if an element needs it. `id`: 0 if it isn't known.
void leave_grid(const EntryCard& card, std::int64_t id, std::size_t offset, std::string message, PieceTarget& target) {
  if (target.cards.unread_nodes.size() >= kMaxUnreadNodes) return fail_at(target.cards, offset, std::move(message));
  target.cards.unread_nodes.push_back({id, offset, std::move(message)});
  target.references.read_unread("GRID", card.place);
}

/// Whether a card of this class is refused if it can't be read: elements with a shape are the mesh. Others are kept without being shown.
bool is_mesh(ElementClass element_class) {
  return element_class == ElementClass::shell || element_class == ElementClass::beam || element_class == ElementClass::solid;
}

void leave_element(const EntryCard& card, const ElementForm& form, std::size_t offset, std::string message, PieceTarget& target) {
  if (is_mesh(form.element_class)) return fail_at(target.cards, offset, std::move(message));
  target.cards.count_kind(form.name);
  ++target.cards.counts.of(form.element_class);
  ++target.cards.left_out.of(form.element_class);
  target.facts.note("bad-card", offset, message + "; it is kept as it is and isn't shown");
  target.references.read_unread(form.name, card.place);
}

}  // namespace

void read_grid(const EntryCard& card, PieceTarget& target) {
  const Card& fields = card.fields;
  constexpr const char* kNeedsId = "a GRID needs an id above 0, but this one has ";
  const std::size_t offset = card.place.offset;
  const std::optional<std::int64_t> id = fields.integer(0);
  if (!id) return leave_grid(card, 0, offset, without_id(card, "GRID", kNeedsId), target);
  if (*id <= 0) return leave_grid(card, 0, offset, kNeedsId + quoted(fields.text(0)), target);
  if (fields.misplaced()) return leave_grid(card, *id, *fields.misplaced(), out_of_order("GRID"), target);
  const std::optional<std::int64_t> system = fields.integer(1);
  if (!system || *system < 0 || *system > kMaxSystem)
    return leave_grid(card, *id, offset,
                      "expected the coordinate system of GRID " + std::to_string(*id) + " but found " + quoted(fields.text(1)), target);
  GridEntry grid{*id, {}, offset, fields.layout(), fields.blank(1) ? kSystemOfGrdset : static_cast<std::uint32_t>(*system)};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::optional<double> value = fields.real(axis + 2);
    if (!value)
      return leave_grid(card, *id, offset,
                        "expected coordinate " + std::to_string(axis + 1) + " of GRID " + std::to_string(*id) + " but found " +
                            quoted(fields.text(axis + 2)),
                        target);
    grid.position[static_cast<Eigen::Index>(axis)] = *value;
  }
  if (card.is_replicated) target.cards.holds.emplace_back(static_cast<std::uint32_t>(target.cards.node_id.size()), kHeldByMaking);
  target.entities.add(grid);
}

void read_element(const EntryCard& card, const ElementForm& form, PieceTarget& target) {
  if (card.fields.misplaced()) return leave_element(card, form, *card.fields.misplaced(), out_of_order(form.name), target);
  const std::optional<std::int64_t> id = card.fields.integer(0);
  if (!id)
    return leave_element(card, form, card.place.offset,
                         without_id(card, form.name, "expected the id of a " + std::string(form.name) + " but found "), target);
  if (card.is_too_long) note_too_long(card, form.name, target.facts);
  target.cards.count_kind(form.name);
  std::vector<std::int64_t>& nodes = target.nodes;
  const bool is_complete = read_nodes(card.fields, form, nodes) && *id > 0;
  if (form.element_class == ElementClass::shell) return read_shell(card, form, *id, is_complete, target);
  ++target.cards.counts.of(form.element_class);
  if (form.fields == NodeFields::none_shown) return;
  target.references.read_element(card.fields, form, nodes, card.place);
  if (!is_complete) {
    ++target.cards.left_out.of(form.element_class);
    target.cards.hide(form.element_class, card.place.offset, *id, nodes);
    return target.cards.note("incomplete-element", card.place.offset, *id);
  }
  add_element(card, form, *id, nodes, target.cards);
  if (form.fields == NodeFields::pairs) add_second_of_pair(card, form, target.cards);
}

}  // namespace prismesh::mesh::deck::nastran
