#include "mesh/deck/editing/write_elements.h"

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "mesh/deck/editing/edit_text.h"
#include "mesh/deck/editing/element_place.h"
#include "mesh/deck/editing/parts_at_nodes.h"
#include "mesh/deck/editing/text_place.h"
#include "mesh/deck/text/text_lines.h"

namespace prismesh::mesh::deck {
namespace {

/// An added element: its class and its index in it.
struct AddedElement {
  ElementClass element_class;
  std::uint32_t element = 0;
};

/// What its card must say, with ids as in a file's text. `sheets`: null if the card doesn't name them.
ElementCard wanted_card(const Model& model, const AddedElement& added, const IdOffsets& offsets, const PartsAtNodes* sheets) {
  const ElementBlock& block = *model.elements[static_cast<std::size_t>(added.element_class)];
  ElementCard card;
  card.element_class = added.element_class;
  card.id = block.id[added.element] - offsets.element;
  if (const PartIndex part = block.part[added.element]; part.valid()) card.part = (*model.parts)[part.value].id - offsets.part;
  for (std::size_t n = block.first_node[added.element]; n < block.first_node[added.element + 1]; ++n)
    card.nodes.push_back(model.node_ids[block.nodes[n].value] - offsets.node);
  for (std::size_t n = block.first_node[added.element]; sheets != nullptr && n < block.first_node[added.element + 1]; ++n) {
    const PartIndex part = sheets->part_at(model, block.nodes[n]);
    card.sheets.push_back(part.valid() ? (*model.parts)[part.value].id - offsets.part : 0);
  }
  return card;
}

/// Errors: an id doesn't fit the fields of that style.
Result<void> check_fields(const CardWriter& writer, std::uint16_t style, const ElementCard& card) {
  const std::int64_t largest = writer.largest_shell_id(style);
  bool fits = card.id >= 1 && card.id <= largest;
  for (const std::int64_t node : card.nodes) fits = fits && node >= 1 && node <= largest;
  if (!fits) return fail("", "has an id, or nodes whose ids, don't fit the fields of the cards beside it");
  return {};
}

class ElementWriting {
 public:
  ElementWriting(const ModelDifference& difference, TextEdits& edits) : difference_(difference), edits_(edits) {}

  Result<void> write(const AddedElement& added) {
    const TopologyChange& change = *difference_.model.topology_change;
    const auto c = static_cast<std::size_t>(added.element_class);
    const std::uint32_t example = change.element_examples[c][added.element - change.deck_elements[c]];
    ++edits_.counts.elements_added;
    return example == kNoExample ? write_at_end(added) : write_like(added, example);
  }

 private:
  std::string name_of(const AddedElement& added) const {
    return "the new " + element_name(difference_.model, added.element_class, added.element);
  }

  Result<void> write_like(const AddedElement& added, std::uint32_t example) {
    const Deck& deck = difference_.deck;
    const std::pair key(added.element_class, example);
    auto known = places_.find(key);
    if (known == places_.end()) {
      Result<ElementPlace> place = place_of_element(deck, difference_.original, difference_.writer, added.element_class, example);
      if (!place) return fail(std::move(place.error()));
      known = places_.emplace(key, *place).first;
    }
    const ElementPlace& place = known->second;
    const std::string_view text = deck.files[place.file].bytes.text();
    const ElementCard card = wanted_card(difference_.model, added, deck.offsets_in(place.file).value_or(IdOffsets()), sheets());
    Result<WrittenCard> written = WrittenCard{};
    if (const Result<void> fits = check_fields(difference_.writer, place.style, card); !fits)
      written = fail(fits.error());
    else
      written = difference_.writer.element_like(text, place, card);
    if (!written) return fail(refusal_at(deck, place.file, place.offset, name_of(added) + " " + written.error().message));
    insert_lines_behind(edits_, {place.file, text}, place.end, written->text);
    return {};
  }

  Result<void> write_at_end(const AddedElement& added) {
    const Deck& deck = difference_.deck;
    const std::string_view text = deck.files[0].bytes.text();
    const PartIndex part = difference_.model.elements[static_cast<std::size_t>(added.element_class)]->part[added.element];
    const Result<std::string> header =
        difference_.writer.element_header(added.element_class, part.valid() ? (*difference_.model.parts)[part.value] : Part());
    Result<WrittenCard> written =
        header ? difference_.writer.new_element(text, added.element_class, wanted_card(difference_.model, added, IdOffsets(), sheets()))
               : fail(header.error());
    if (!written) return fail(refusal(deck, name_of(added) + " " + written.error().message));
    const std::size_t end = difference_.writer.end_of_cards(text);
    const std::string eol(line_end(text, std::min(text.find('\n'), text.size())));
    std::string& lines = edits_.new_blocks[{0, end, *header}];
    if (lines.empty() && !header->empty()) lines = *header + eol;
    lines += written->text + eol;
    return {};
  }

  const PartsAtNodes* sheets() {
    if (!difference_.writer.names_sheets()) return nullptr;
    if (!sheets_) sheets_.emplace(difference_.original);
    return &*sheets_;
  }

  const ModelDifference& difference_;
  TextEdits& edits_;
  std::optional<PartsAtNodes> sheets_;
  std::map<std::pair<ElementClass, std::uint32_t>, ElementPlace> places_;
};

/// The cards of added parts, with the line ends of the main file.
void write_parts(const ModelDifference& difference, TextEdits& edits) {
  if (difference.changes.added_parts.empty()) return;
  const std::string_view text = difference.deck.files[0].bytes.text();
  const std::string eol(line_end(text, std::min(text.find('\n'), text.size())));
  const TopologyChange& change = *difference.model.topology_change;
  for (const PartIndex part : difference.changes.added_parts) {
    std::string_view cards = change.added_parts[part.value - change.deck_parts].cards;
    const std::size_t first = cards.find('\n');
    std::string& lines = edits.new_blocks[{0, difference.writer.end_of_cards(text), std::string(cards.substr(0, first))}];
    for (std::size_t end; (end = cards.find('\n')) != std::string_view::npos; cards.remove_prefix(end + 1))
      lines += std::string(cards.substr(0, end)) + eol;
  }
}

}  // namespace

Result<void> write_elements(const ModelDifference& difference, CardProgress& progress, TextEdits& edits) {
  ElementWriting writing(difference, edits);
  for (std::size_t c = 1; c < difference.changes.added_elements.size(); ++c)
    for (const std::uint32_t element : difference.changes.added_elements[c]) {
      if (!progress.next_card()) return fail(cancelled());
      if (Result<void> done = writing.write({static_cast<ElementClass>(c), element}); !done) return done;
    }
  write_parts(difference, edits);
  return {};
}

}  // namespace prismesh::mesh::deck
