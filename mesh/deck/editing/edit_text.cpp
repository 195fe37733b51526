#include "mesh/deck/editing/edit_text.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "mesh/deck/editing/text_place.h"
#include "mesh/deck/text/text_lines.h"

namespace prismesh::mesh::deck {

void replace_card(TextEdits& edits, const DeckCard& card, std::size_t end, std::string text) {
  edits.replacements.push_back({card.run.file, {card.offset, end - card.offset, std::move(text)}});
}

void remove_card(TextEdits& edits, const DeckCard& card, std::size_t end) {
  const std::size_t newline = card.text.find('\n', end);
  replace_card(edits, card, newline == std::string_view::npos ? card.text.size() : newline + 1, "");
}

void insert_after_card(TextEdits& edits, const DeckCard& card, std::size_t end, const std::string& text) {
  insert_lines_behind(edits, {card.run.file, card.text}, end, text);
}

void insert_lines_behind(TextEdits& edits, const FileText& file, std::size_t end, const std::string& lines) {
  const std::string eol(line_end(file.text, end));
  const std::size_t newline = file.text.find('\n', end);
  if (newline == std::string_view::npos)
    edits.replacements.push_back({file.file, {file.text.size(), 0, eol + lines}});
  else
    edits.replacements.push_back({file.file, {newline + 1, 0, lines + eol}});
}

void add_to_new_block(TextEdits& edits, const DeckCard& beside, const CardWriter::NewBlock& block, const std::string& text) {
  const std::string eol(line_end(beside.text, std::min(beside.text.find('\n', beside.offset), beside.text.size())));
  std::string& lines = edits.new_blocks[{beside.run.file, block.offset, block.header}];
  if (lines.empty()) lines = block.header + eol;
  lines += text + eol;
}

void insert_new_blocks(TextEdits& edits, const Deck& deck) {
  for (auto& [place, lines] : edits.new_blocks) {
    const std::string_view text = deck.files[place.file].bytes.text();
    const bool last_line_is_open = place.offset == text.size() && place.offset > 0 && text[place.offset - 1] != '\n';
    if (last_line_is_open) lines.insert(0, line_end(text, place.offset));
    edits.replacements.push_back({place.file, {place.offset, 0, std::move(lines)}});
  }
  edits.new_blocks.clear();
}

void note_rounding(TextEdits& edits, const Deck& deck, const DeckCard& card, const WrittenCard& written, const std::string& name) {
  if (written.rounded == 0) return;
  Rounding& rounding = edits.rounding;
  if (rounding.count == 0) rounding.first = place_of(deck, card.run.file, card.offset) + " (" + name + ")";
  rounding.count += static_cast<std::size_t>(written.rounded);
  rounding.largest_error = std::max(rounding.largest_error, written.largest_error);
}

Result<OrderedReplacements> in_order(const Deck& deck, std::vector<FileReplacement> replacements) {
  std::vector<std::vector<Replacement>> by_file(deck.files.size());
  for (FileReplacement& each : replacements) by_file[each.file].push_back(std::move(each.replacement));

  OrderedReplacements ordered;
  ordered.by_file.resize(by_file.size());
  for (std::uint32_t file = 0; file < by_file.size(); ++file) {
    const std::string_view text = deck.files[file].bytes.text();
    std::stable_sort(by_file[file].begin(), by_file[file].end(), [](const Replacement& a, const Replacement& b) {
      return a.offset != b.offset ? a.offset < b.offset : (a.length == 0 && b.length > 0);
    });
    std::size_t reached = 0;
    for (Replacement& replacement : by_file[file]) {
      if (replacement.offset < reached || replacement.offset + replacement.length > text.size())
        return fail(refusal_at(deck, file, std::min(replacement.offset, text.size()),
                               "two changes meet in this line, and can't be written together"));
      reached = replacement.offset + replacement.length;
      const std::string_view old = text.substr(replacement.offset, replacement.length);
      if (old == replacement.text) continue;
      ordered.lines += lines_that_differ(old, replacement.text);
      ordered.by_file[file].push_back(std::move(replacement));
    }
  }
  return ordered;
}

}  // namespace prismesh::mesh::deck
