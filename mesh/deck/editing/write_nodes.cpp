#include "mesh/deck/editing/write_nodes.h"

#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "mesh/deck/editing/ancestors.h"
#include "mesh/deck/editing/card_move.h"
#include "mesh/deck/editing/deck_card.h"
#include "mesh/deck/editing/edit_text.h"
#include "mesh/deck/editing/names.h"
#include "mesh/deck/editing/text_place.h"

namespace prismesh::mesh::deck {
namespace {

constexpr const char* kFlattened = "stands in a coordinate system that flattens it, so its place can't be written";

void note_rounded_node(TextEdits& edits, const ModelDifference& difference, const DeckCard& card, const WrittenCard& written,
                       NodeIndex node) {
  if (written.rounded == 0) return;
  if (const std::optional<Vec3> at = difference.writer.node_coordinates({written.text, 0, card.run.style}))
    edits.rounding.nodes.emplace_back(node, to_basic(difference.deck.frames[card.run.frame], *at));
}

/// The move without the axes along which the card's numbers stay the same: where a coordinate moves by less than its field can show, its
/// old digits stay.
NodeMove without_equal_axes(const CardWriter& writer, const DeckCard& card, const WrittenCard& written, const NodeMove& move) {
  const std::optional<Vec3> before = writer.node_coordinates(card.ref());
  const std::optional<Vec3> after = writer.node_coordinates({written.text, 0, card.run.style});
  if (!before || !after) return move;
  NodeMove visible = move;
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    if ((*before)[axis] == (*after)[axis]) visible.to[axis] = move.from[axis];
  return visible;
}

Result<void> write_moved_node(const ModelDifference& difference, NodeIndex node, TextEdits& edits) {
  const Deck& deck = difference.deck;
  const Model& model = difference.model;
  const CardWriter& writer = difference.writer;
  const DeckCard card = card_of(deck, node);
  const std::string name = node_name(difference.model, node);
  const auto refuse = [&](const std::string& why) { return fail(refusal_at(deck, card.run.file, card.offset, name + " " + why)); };
  if (!model.position(node).allFinite()) return refuse("has been moved to a place that is no number");
  if (const std::uint8_t held = difference.original.node_holds[node.value]; held != 0)
    return refuse(std::string(why_held(held)) + "; it can't be moved");
  const std::optional<NodeMove> move =
      move_in_card(deck, writer, card.run, card.offset, {difference.original.position(node), model.position(node)});
  if (!move) return refuse(kFlattened);

  const std::size_t end = writer.node_end(card.ref());
  const std::string_view old = card.text.substr(card.offset, end - card.offset);
  WrittenCard written = writer.move_node(card.ref(), move->from, move->to);
  if (written.by_parameter) return refuse(has_parameter(old) + "; it can't be moved");
  if (const NodeMove visible = without_equal_axes(writer, card, written, *move); visible.to != move->to)
    written.text = writer.move_node(card.ref(), visible.from, visible.to).text;
  note_rounding(edits, deck, card, written, name);
  note_rounded_node(edits, difference, card, written, node);
  if (written.text == old) return {};
  ++edits.counts.nodes_moved;
  replace_card(edits, card, end, std::move(written.text));
  return {};
}

/// Whether all the nodes that an added node comes from are constrained by their own cards in the same way, so that its card gets these
/// constraints too. `example`: example_node. Errors: the constraints differ in a format where they must agree.
Result<bool> takes_constraints(const ModelDifference& difference, NodeIndex node, NodeIndex example) {
  const auto constraints_of = [&](NodeIndex ancestor) {
    const DeckCard card = card_of(difference.deck, ancestor);
    return difference.writer.node_constraints(card.ref());
  };
  const std::string wanted = constraints_of(example);
  if (wanted.empty()) return false;
  bool differ = false;
  for (const NodeIndex ancestor : deck_ancestors(difference.model, node)) {
    const std::string own = constraints_of(ancestor);
    if (own.empty()) return false;
    differ |= own != wanted;
  }
  if (!differ) return true;
  if (!difference.writer.constraints_must_agree()) return false;
  const DeckCard card = card_of(difference.deck, example);
  return fail(
      refusal_at(difference.deck, card.run.file, card.offset,
                 "the new " + node_name(difference.model, node) + " lies between nodes whose cards constrain them in different ways"));
}

/// Where an added node is, in the frame of the card beside it. nullopt: the frame can't be inverted.
std::optional<Vec3> place_in_card(const ModelDifference& difference, const DeckCard& beside, NodeIndex node) {
  const Frame& frame = difference.deck.frames[beside.run.frame];
  const Vec3 at = difference.model.position(node);
  if (frame.is_basic()) return at;
  const Vec3 near = difference.writer.node_coordinates(beside.ref()).value_or(Vec3(Vec3::Zero()));
  const std::optional<Vec3> own = to_card(frame, at, near);
  return own && own->allFinite() ? own : std::nullopt;
}

Result<void> write_added_node(const ModelDifference& difference, NodeIndex node, TextEdits& edits) {
  const Deck& deck = difference.deck;
  const Model& model = difference.model;
  const CardWriter& writer = difference.writer;
  const std::string name = "new " + node_name(difference.model, node);
  if (!model.position(node).allFinite())
    return fail(refusal(deck, node_name(difference.model, node) + " is new and has a place that is no number"));
  const NodeIndex example = example_node(model, node);
  if (!example.valid())
    return fail(
        refusal(deck, node_name(difference.model, node) +
                          " would have to stand in an include that is used twice, or beside nodes that have no cards of their own"));
  const DeckCard card = card_of(deck, example);
  const auto refuse = [&](const std::string& why) { return fail(refusal_at(deck, card.run.file, card.offset, "the " + name + " " + why)); };
  const std::int64_t id = model.node_ids[node.value] - deck.offsets_of(card.run).node;
  if (id < 1 || id > writer.largest_node_id(card.run.style)) return refuse("has an id that doesn't fit the fields of the cards beside it");
  const std::optional<Vec3> at = place_in_card(difference, card, node);
  if (!at) return refuse(kFlattened);

  const Result<bool> constrained = placed_node(model, node) != nullptr ? Result<bool>(false) : takes_constraints(difference, node, example);
  if (!constrained) return fail(constrained.error());
  const Result<WrittenCard> written =
      *constrained ? writer.new_constrained_node(card.ref(), id, *at) : Result<WrittenCard>(writer.new_node(card.ref(), id, *at));
  if (!written) return refuse(written.error().message);
  if (written->by_parameter) return refuse("would have its place given by a parameter");
  note_rounding(edits, deck, card, *written, name);
  note_rounded_node(edits, difference, card, *written, node);
  ++edits.counts.nodes_added;
  const auto block = *constrained ? std::nullopt : writer.block_without_constraints(card.ref());
  if (block)
    add_to_new_block(edits, card, *block, written->text);
  else
    insert_after_card(edits, card, writer.node_end(card.ref()), written->text);
  return {};
}

Result<void> remove_node_card(const ModelDifference& difference, NodeIndex node, TextEdits& edits) {
  const DeckCard card = card_of(difference.deck, node);
  const auto held = static_cast<std::uint8_t>(difference.original.node_holds[node.value] & ~kHeldByParameter);
  if (held != 0)
    return fail(refusal_at(difference.deck, card.run.file, card.offset,
                           node_name(difference.model, node) + " " + std::string(why_held(held)) + "; it can't be removed"));
  remove_card(edits, card, difference.writer.node_end(card.ref()));
  ++edits.counts.nodes_removed;
  return {};
}

}  // namespace

Result<void> write_nodes(const ModelDifference& difference, CardProgress& progress, TextEdits& edits) {
  for (const NodeIndex node : difference.moved) {
    if (!progress.next_card()) return fail(cancelled());
    if (Result<void> done = write_moved_node(difference, node, edits); !done) return done;
  }
  for (const NodeIndex node : difference.changes.added_nodes) {
    if (!progress.next_card()) return fail(cancelled());
    if (Result<void> done = write_added_node(difference, node, edits); !done) return done;
  }
  for (const NodeIndex node : difference.changes.removed_nodes)
    if (Result<void> done = remove_node_card(difference, node, edits); !done) return done;
  return {};
}

}  // namespace prismesh::mesh::deck
