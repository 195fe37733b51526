// Writes and reads the text of a journal: a header line, then two lines for each record (docs/journal.md). Touches no file. Private to
// mesh/document.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/document/prepare.h"

namespace prismesh::mesh::document {

/// The deck and the settings that a journal belongs to.
struct JournalHeader {
  struct Deck {
    std::string path;
    std::string hash;
    std::size_t nodes = 0, shells = 0, parts = 0;
  };
  /// Parts that have the same target size, for the same reasons.
  struct PartSizes {
    std::string on;      ///< as an expression
    double guessed = 1;  ///< from their edges, or from the deck's
    quality::SizeFrom from = quality::SizeFrom::part;
    std::optional<TargetSize> own;  ///< that the user chose for them
  };
  /// Criteria with their content, so that a recovery needs no file.
  struct ChosenOn {
    std::optional<std::string> on;  ///< parts, as an expression; absent: the deck's
    std::string name;               ///< what the user gave; empty: nobody chose
    std::string text;
  };
  struct Settings {
    LengthUnit length_unit = LengthUnit::mm;
    double target_size = 1;
    std::string criteria;
    TargetSize size_of_all = SizeGuess::deck;  ///< of the parts without a size of their own; older journals: one size for all
    std::optional<double> guessed_size{};      ///< the deck's; absent: target_size
    std::vector<PartSizes> parts{};            ///< empty in older journals
    std::vector<ChosenOn> chosen_criteria{};   ///< the deck's first; empty in older journals
  };
  std::string program;  ///< version that wrote it
  Deck deck;
  Settings settings;
};

struct JournalRecord {
  std::uint64_t number = 0;
  std::string_view intent;  ///< the edit's JSON
  Prepared::Step step = Prepared::Step::push;
  std::size_t drop_oldest = 0;
  std::string_view delta;  ///< base64
  long line = 0;           ///< of its intent in the text, from 1
  std::size_t drop_branches = 0;
  std::uint64_t branch = 0;  ///< of step branch
};

/// Where the undamaged part ends.
struct JournalEnd {
  std::size_t bytes = 0;
  long lines = 0;
  std::uint64_t records = 0;
  std::string check;            ///< the next record's check covers it
  bool torn_tail = false;       ///< an incomplete record follows: a crash in the middle of an edit that was never acknowledged
  std::optional<Error> damage;  ///< what follows isn't as it was written, with the line
  bool only_last = false;       ///< of damage: no other record follows the one that is damaged
};

std::string header_text(const JournalHeader& header);
/// `check` is that of the record (or header) before. The record's line isn't used.
std::string record_text(const JournalRecord& record, std::string_view check);

/// The check at the end of a header's or record's text.
std::string check_in(std::string_view text);

/// Whether a text is a journal at all, rather than a script of edits.
bool looks_like_journal(std::string_view text);

/// Reads the text up to its end or the first damage. `file` is for errors. Errors: a damaged header; what the callbacks return.
Result<JournalEnd> read_journal(std::string_view text, const std::string& file,
                                const std::function<Result<void>(const JournalHeader&)>& on_header,
                                const std::function<Result<void>(const JournalRecord&)>& on_record);

}  // namespace prismesh::mesh::document
