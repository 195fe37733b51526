// Checks whether an entity may be removed from a deck or divided: cards may name it, and text that the reader doesn't understand may too.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "base/error.h"
#include "mesh/deck/data/deck.h"
#include "mesh/deck/editing/unread_numbers.h"

namespace prismesh::mesh::deck {

class CardWriter;
class OtherKind;

/// Checks what may be removed.
class DeletionCheck {
 public:
  /// The deck must outlive this.
  explicit DeletionCheck(const Deck& deck) : deck_(deck), unread_(deck) {}
  /// A set with the id in a list or range allows the removal: saving takes the id out of it. Errors: the first card that names the id alone
  /// or as the corner of a segment; another shell has the id too; unread text that holds the number; encrypted text or a missing include
  /// file, which may name anything.
  Result<void> may_be_deleted(Referred referred, std::int64_t id);
  /// As may_be_deleted, without the cards that the reader understands.
  Result<void> check_unread_text(Referred referred, std::int64_t id);

 private:
  std::optional<Error> named_by_card(Referred referred, std::int64_t id, const std::string& what) const;
  std::optional<Error> named_unseen(const std::string& what) const;
  std::optional<Error> named_in_unread(Referred referred, std::int64_t id, const std::string& what);

  const Deck& deck_;
  UnreadNumbers unread_;
};

/// Checks what may be divided. Encrypted text and missing include files don't count: with them, nothing in the deck could be divided.
class DivisionCheck {
 public:
  /// The deck must outlive this.
  explicit DivisionCheck(const Deck& deck);
  ~DivisionCheck();
  /// Errors: another shell has the id too; a card names the shell alone and can't be copied for its pieces (CardWriter::inheritance);
  /// unread text holds the shell's id, and may say something that must hold for the pieces too.
  Result<void> may_be_divided(std::int64_t shell);
  /// Whether a node may be added between these nodes. Errors: unread text holds all their ids, and may say something that must hold for
  /// the new node too.
  Result<void> may_be_between(std::span<const std::int64_t> nodes);

 private:
  const Deck& deck_;
  std::unique_ptr<const CardWriter> writer_;
  UnreadNumbers unread_;
};

/// Checks which quads may become triangles and which triangles quads, as wholes or in pieces. Much depends on the format: where a keyword
/// or a set holds one kind only, the other kind needs another place.
class KindCheck {
 public:
  /// Both must outlive this. `original`: the model as it was opened from the deck.
  KindCheck(const Deck& deck, const Model& original);
  ~KindCheck();
  /// `shell`: of the deck. Errors: a card names it that can't name the other kind; the format has no place for the other kind's card.
  Result<void> may_change_kind(ShellIndex shell);

 private:
  const Deck& deck_;
  const Model& original_;
  std::unique_ptr<const CardWriter> writer_;
  std::unique_ptr<OtherKind> other_kind_;
};

/// DeletionCheck::may_be_deleted for a single id; for several ids a DeletionCheck is faster.
Result<void> may_be_deleted(const Deck& deck, Referred referred, std::int64_t id);

}  // namespace prismesh::mesh::deck
