#include "mesh/deck/editing/edit_checks.h"

#include <utility>

#include "mesh/deck/editing/ancestors.h"
#include "mesh/deck/editing/deck_card.h"
#include "mesh/deck/editing/names.h"
#include "mesh/deck/editing/other_kind.h"
#include "mesh/deck/editing/text_place.h"
#include "mesh/deck/formats/formats.h"
#include "mesh/deck/writing/card_writer.h"

namespace prismesh::mesh::deck {
namespace {

constexpr std::string_view kSharedId =
    "two shells have this number, and an edit of one of them would have to say so in the sets and cards that name it, which this version "
    "can't";

}  // namespace

std::optional<Error> DeletionCheck::named_by_card(Referred referred, std::int64_t id, const std::string& what) const {
  for (const Reference& reference : deck_.references->naming(referred, id)) {
    if (reference.role != ReferenceRole::single && reference.role != ReferenceRole::segment) continue;
    const Referrer& card = deck_.references->referrers()[reference.referrer];
    const bool segment = reference.role == ReferenceRole::segment;
    return error_at(deck_, card.file, reference.card,
                    what + " can't be removed: " + (segment ? "a segment of " : "") + card_name(deck_.format, card) + " names it");
  }
  return std::nullopt;
}

std::optional<Error> DeletionCheck::named_unseen(const std::string& what) const {
  for (const UnreadText& unread : deck_.references->unread())
    if (unread.encrypted)
      return error_at(
          deck_, unread.file, unread.begin,
          what + " can't be removed: " +
              (unread.keyword.starts_with("INCLUDE") ? "this file isn't read, and may name it" : "the encrypted text here may name it"));
  if (!deck_.missing_files.empty())
    return Error{deck_.files[0].path.string(), 0,
                 what + " can't be removed: the include file " + deck_.missing_files.front() + " isn't there, and may name it"};
  return std::nullopt;
}

std::optional<Error> DeletionCheck::named_in_unread(Referred referred, std::int64_t id, const std::string& what) {
  const UnreadText* unread = unread_.holding_all(referred, std::span(&id, 1));
  if (unread == nullptr) return std::nullopt;
  return error_at(deck_, unread->file, unread->begin, what + " can't be removed: " + unread_name(deck_, *unread));
}

Result<void> DeletionCheck::may_be_deleted(Referred referred, std::int64_t id) {
  const std::string what = std::string(name(referred)) + " " + std::to_string(id);
  if (std::optional<Error> error = named_by_card(referred, id, what)) return fail(std::move(*error));
  return check_unread_text(referred, id);
}

Result<void> DeletionCheck::check_unread_text(Referred referred, std::int64_t id) {
  const std::string what = std::string(name(referred)) + " " + std::to_string(id);
  if (referred == Referred::shell && deck_.shares_id(id))
    return fail(deck_.files[0].path.string(), what + " can't be removed: " + std::string(kSharedId));
  std::optional<Error> error = named_unseen(what);
  if (!error) error = named_in_unread(referred, id, what);
  if (error) return fail(std::move(*error));
  return {};
}

DivisionCheck::DivisionCheck(const Deck& deck) : deck_(deck), writer_(card_writer(deck.format)), unread_(deck) {}
DivisionCheck::~DivisionCheck() = default;

Result<void> DivisionCheck::may_be_divided(std::int64_t shell) {
  const std::string what = "shell " + std::to_string(shell) + " can't be divided: ";
  if (deck_.shares_id(shell)) return fail(deck_.files[0].path.string(), what + std::string(kSharedId));
  for (const Reference& reference : deck_.references->naming(Referred::shell, shell)) {
    if (reference.role != ReferenceRole::single) continue;
    const Referrer& card = deck_.references->referrers()[reference.referrer];
    if (writer_->inheritance(card, Referred::shell) == Inheritance::forbids)
      return fail(error_at(deck_, card.file, reference.card,
                           what + card_name(deck_.format, card) + " names it, which can't be passed on to its pieces"));
  }
  const UnreadText* unread = unread_.holding_all(Referred::shell, std::span(&shell, 1));
  if (unread == nullptr) return {};
  return fail(error_at(deck_, unread->file, unread->begin, what + unread_name(deck_, *unread)));
}

Result<void> DivisionCheck::may_be_between(std::span<const std::int64_t> nodes) {
  const UnreadText* unread = unread_.holding_all(Referred::node, nodes);
  if (unread == nullptr) return {};
  std::string named;
  for (const std::int64_t node : nodes) named += (named.empty() ? "" : ", ") + std::to_string(node);
  return fail(error_at(deck_, unread->file, unread->begin,
                       "no node can come between the nodes " + named + ": " + keyword_name(deck_.format, unread->keyword) +
                           " isn't read in this version, and may say of them what would hold of it too"));
}

KindCheck::KindCheck(const Deck& deck, const Model& original)
    : deck_(deck),
      original_(original),
      writer_(card_writer(deck.format)),
      other_kind_(std::make_unique<OtherKind>(deck, original, *writer_)) {}
KindCheck::~KindCheck() = default;

Result<void> KindCheck::may_change_kind(ShellIndex shell) {
  const DeckCard card = card_of(deck_, shell);
  if (writer_->holds_triangles_and_quads(card.ref())) return {};
  const bool to_triangle = !original_.shell(shell).is_triangle();
  const std::string what = shell_name(original_, shell) + " can't become a " + (to_triangle ? "triangle" : "quad") + ": ";
  if (deck_.shares_id(original_.shell_ids[shell.value]))
    return fail(error_at(deck_, card.run.file, card.offset, what + std::string(kSharedId)));
  if (const std::string why = other_kind_->card_that_forbids(shell, to_triangle); !why.empty())
    return fail(error_at(deck_, card.run.file, card.offset, what + why));
  // Its card with the other number of corners: which nodes these are doesn't matter.
  ShellCard wanted = shell_card(original_, original_, shell);
  wanted.nodes[3] = wanted.nodes[to_triangle ? 2 : 0];
  const Result<OtherKind::Place> place = other_kind_->place(shell, wanted);
  if (!place) return fail(error_at(deck_, card.run.file, card.offset, what + "it " + place.error().message));
  return {};
}

Result<void> may_be_deleted(const Deck& deck, Referred referred, std::int64_t id) {
  return DeletionCheck(deck).may_be_deleted(referred, id);
}

}  // namespace prismesh::mesh::deck
