// Changes the text around single cards, and puts all changes of a deck in order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "mesh/deck/data/deck.h"
#include "mesh/deck/editing/deck_card.h"
#include "mesh/deck/editing/text_edits.h"
#include "mesh/deck/writing/card_writer.h"

namespace prismesh::mesh::deck {

// `end`, below: one past the last character of the card, before its line's end.

void replace_card(TextEdits& edits, const DeckCard& card, std::size_t end, std::string text);

/// Removes the card's lines with their ends.
void remove_card(TextEdits& edits, const DeckCard& card, std::size_t end);

/// Inserts lines behind the card. They end as the card's last line does.
void insert_after_card(TextEdits& edits, const DeckCard& card, std::size_t end, const std::string& text);

/// A file by its index and its text.
struct FileText {
  std::uint32_t file = 0;
  std::string_view text;
};
/// Inserts lines behind the line whose last character is before `end`. They end as it does.
void insert_lines_behind(TextEdits& edits, const FileText& file, std::size_t end, const std::string& lines);

/// Appends a card to a new block. The block's lines end as those of the card `beside`.
void add_to_new_block(TextEdits& edits, const DeckCard& beside, const CardWriter::NewBlock& block, const std::string& text);

/// Turns the new blocks into insertions.
void insert_new_blocks(TextEdits& edits, const Deck& deck);

/// Counts the rounded numbers of what was written for `card`. `name`: of the node or shell, for the message.
void note_rounding(TextEdits& edits, const Deck& deck, const DeckCard& card, const WrittenCard& written, const std::string& name);

struct OrderedReplacements {
  std::vector<std::vector<Replacement>> by_file;  ///< as Deck::files; ascending, none overlaps another
  std::size_t lines = 0;                          ///< lines that are added, removed or changed
};

/// Sorts the replacements by file and place, and drops those that change nothing. At one place, insertions come before what is changed
/// there. Errors: two changes overlap (file and line).
Result<OrderedReplacements> in_order(const Deck& deck, std::vector<FileReplacement> replacements);

}  // namespace prismesh::mesh::deck
