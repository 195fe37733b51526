// What stands in the way of taking an entity out of a deck, or of dividing it: cards that name it, and text nobody understands that may.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "mesh/deck/data/deck.h"

namespace prismesh::mesh::deck {

class CardWriter;

/// A card as reports speak of it: "*SET_NODE_LIST 1", "SPC1 7", "/GRNOD/NODE 3".
std::string card_name(Format format, const Referrer& card);

/// The end of a sentence about what text that isn't understood may name: "*FOO isn't read in this version, and may name it".
std::string unread_name(const Deck& deck, const UnreadText& unread);

/// The cards that name the id, in the deck's order, each once: "*SET_NODE_LIST 1 (deck.k:1234)". At most `most`, then how many more.
std::vector<std::string> what_names(const Deck& deck, Referred referred, std::int64_t id, std::size_t most = 10);

/// The whole numbers in text that isn't understood: searched once, when one is first asked for.
class UnreadNumbers {
 public:
  /// The deck must outlive this.
  explicit UnreadNumbers(const Deck& deck) : deck_(deck) {}
  /// The first such text in which all these ids stand, as they are or less what an include adds to them; nullptr: none. Nothing is found
  /// in encrypted text. `ids` isn't empty.
  const UnreadText* holding_all(Referred referred, std::span<const std::int64_t> ids);

 private:
  void gather();
  std::vector<std::uint32_t> texts_with(Referred referred, std::int64_t id) const;

  const Deck& deck_;
  std::optional<std::vector<std::pair<std::int64_t, std::uint32_t>>> numbers_;  ///< with the index of the text they stand in, ascending
};

/// Decides what may be taken out.
class DeletionCheck {
 public:
  /// The deck must outlive this.
  explicit DeletionCheck(const Deck& deck) : deck_(deck), unread_(deck) {}
  /// Sets that list the id, or have it in a range, don't stand in the way: it can be taken out of them. Errors: the first card that names
  /// it alone or as the corner of a segment; text that isn't understood and holds the number; encrypted text, and files that aren't
  /// there, since they may name anything.
  Result<void> may_be_deleted(Referred referred, std::int64_t id);
  /// The same without the cards that are understood: for who looks after those himself.
  Result<void> unnamed_in_unread(Referred referred, std::int64_t id);

 private:
  std::optional<Error> named_by_card(Referred referred, std::int64_t id, const std::string& what) const;
  std::optional<Error> named_unseen(const std::string& what) const;
  std::optional<Error> named_in_unread(Referred referred, std::int64_t id, const std::string& what);

  const Deck& deck_;
  UnreadNumbers unread_;
};

/// Decides what may be divided. Encrypted text and files that aren't there don't count: nothing could be divided beside them.
class DivisionCheck {
 public:
  /// The deck must outlive this.
  explicit DivisionCheck(const Deck& deck);
  ~DivisionCheck();
  /// Errors: a card names the shell alone and can't be passed on to its pieces (CardWriter::inheritance), or text that isn't understood
  /// holds its number and may say something that must be true of the pieces too.
  Result<void> may_be_divided(std::int64_t shell);
  /// Whether a node may come between these. Errors: text that isn't understood holds all their numbers, and may say what holds of a node
  /// between them too.
  Result<void> may_be_between(std::span<const std::int64_t> nodes);

 private:
  const Deck& deck_;
  std::unique_ptr<const CardWriter> writer_;
  UnreadNumbers unread_;
};

/// For one id; more than a few are faster with a DeletionCheck.
Result<void> may_be_deleted(const Deck& deck, Referred referred, std::int64_t id);

/// Every whole number that a text may hold, whichever way its columns are cut: words between blanks and commas, and of longer runs of
/// digits the fields of 8, 10, 16 and 20 columns. Appended to `numbers`, without signs.
void gather_whole_numbers(std::string_view text, std::vector<std::int64_t>& numbers);

}  // namespace prismesh::mesh::deck
