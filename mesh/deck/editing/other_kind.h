// Where the card of a shell goes whose number of corners changes, in formats whose keywords hold triangles or quads only.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tuple>

#include "base/error.h"
#include "mesh/deck/data/deck.h"
#include "mesh/deck/editing/unread_numbers.h"
#include "mesh/deck/writing/card_writer.h"

namespace prismesh::mesh::deck {

/// A triangle instead of a quad, or the reverse. Asked for many shells it looks up each thing once.
class OtherKind {
 public:
  /// All must outlive this. `original`: the model as it was opened from the deck.
  OtherKind(const Deck& deck, const Model& original, const CardWriter& writer)
      : deck_(deck), original_(original), writer_(writer), unread_(deck) {}

  /// Where such a shell's card goes.
  struct Place {
    WrittenCard card;
    ShellIndex behind;           ///< the card of this shell; invalid: it goes to `block`
    CardWriter::NewBlock block;  ///< of a part without such cards
  };
  /// `shell`: of the deck; `wanted`: what the card must say. Errors: the reason, as the end of a sentence "the shell becomes a quad and".
  Result<Place> place(ShellIndex shell, const ShellCard& wanted);

  /// Which card names the shell and couldn't name it as a triangle or as a quad, as the end of a sentence; empty: none. A set may give its
  /// shells to another one (CardWriter::companion).
  std::string card_that_forbids(ShellIndex shell, bool triangle);

 private:
  const std::optional<std::string>& why_no_companion(std::uint32_t set);
  ShellIndex neighbour_of(ShellIndex shell, bool triangle);
  ShellIndex find_neighbour(ShellIndex shell, bool triangle) const;

  const Deck& deck_;
  const Model& original_;
  const CardWriter& writer_;
  UnreadNumbers unread_;
  std::map<std::uint32_t, std::optional<std::string>> no_companion_;             ///< by set: why there can't be one; nullopt: there can
  std::map<std::tuple<std::uint32_t, PartIndex, bool>, ShellIndex> neighbours_;  ///< by file, part and whether it is a triangle
};

bool has_midside_nodes(const Model& model, ShellIndex shell);

}  // namespace prismesh::mesh::deck
