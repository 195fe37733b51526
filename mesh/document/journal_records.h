// The journal as text: a header line, then two lines a record. Pure; the file is journal.cpp's business. Format: docs/journal.md.
// Private to mesh/document.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "mesh/document/prepare.h"

namespace prismesh::mesh::document {

/// What the header pins.
struct JournalHeader {
  std::string program;
  std::string deck_path;
  std::string deck_hash;
  std::size_t nodes = 0, shells = 0, parts = 0;
  LengthUnit length_unit = LengthUnit::mm;
  double target_size = 1;
  std::string criteria;
};

/// A record as it stands in the text.
struct JournalRecord {
  long line = 0;  ///< of its intent, from 1
  std::uint64_t number = 0;
  std::string_view intent;  ///< the edit's JSON
  Prepared::Step step = Prepared::Step::push;
  std::size_t drop_oldest = 0;
  std::string_view delta;  ///< base64
};

/// Where the good part ends, and the check that the next record chains to.
struct JournalEnd {
  std::size_t bytes = 0;
  long lines = 0;
  std::uint64_t records = 0;
  std::string check;
  bool torn_tail = false;       ///< an incomplete record follows: a crash in the middle of an edit that was never acknowledged
  std::optional<Error> damage;  ///< what follows isn't as it was written; with its line
  bool only_last = false;       ///< of damage: no other record follows the one that is damaged
};

std::string header_text(const JournalHeader& header);
/// `check` is that of the record (or header) before.
std::string record_text(std::uint64_t number, std::string_view intent, Prepared::Step step, std::size_t drop_oldest, std::string_view delta,
                        std::string_view check);

/// The check at the end of a header's or record's text.
std::string check_in(std::string_view text);

/// Whether a text is a journal at all, rather than a script of edits.
bool looks_like_journal(std::string_view text);

/// Walks over the text up to its end or the first damage. `file` is for errors. Errors: a damaged header; what the callbacks return.
Result<JournalEnd> read_journal(std::string_view text, const std::string& file,
                                const std::function<Result<void>(const JournalHeader&)>& on_header,
                                const std::function<Result<void>(const JournalRecord&)>& on_record);

}  // namespace prismesh::mesh::document
