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

/// Checks what may be removed.
class DeletionCheck {
 public:
  /// The deck must outlive this.
  explicit DeletionCheck(const Deck& deck) : deck_(deck), unread_(deck) {}
  /// A set with the id in a list or range allows the removal: saving takes the id out of it. Errors: the first card that names the id alone
  /// or as the corner of a segment; unread text that holds the number; encrypted text or a missing include file, which may name anything.
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
  /// Errors: a card names the shell alone and can't be copied for its pieces (CardWriter::inheritance); unread text holds the shell's id,
  /// and may say something that must hold for the pieces too.
  Result<void> may_be_divided(std::int64_t shell);
  /// Whether a node may be added between these nodes. Errors: unread text holds all their ids, and may say something that must hold for
  /// the new node too.
  Result<void> may_be_between(std::span<const std::int64_t> nodes);

 private:
  const Deck& deck_;
  std::unique_ptr<const CardWriter> writer_;
  UnreadNumbers unread_;
};

/// DeletionCheck::may_be_deleted for a single id; for several ids a DeletionCheck is faster.
Result<void> may_be_deleted(const Deck& deck, Referred referred, std::int64_t id);

}  // namespace prismesh::mesh::deck
