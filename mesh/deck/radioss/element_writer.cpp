#include "mesh/deck/radioss/element_writer.h"

#include <algorithm>
#include <optional>
#include <string>

#include "mesh/deck/radioss/block.h"
#include "mesh/deck/radioss/mesh_cards.h"
#include "mesh/deck/radioss/text_columns.h"
#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::radioss {
namespace {

constexpr std::size_t kThirdNodeOfSpring = 3;

std::int64_t id_in(std::string_view line, std::size_t width, std::size_t at) {
  std::int64_t value = 0;
  return parse_integer(field(line, width, at), value) ? value : 0;
}

/// The offset of the next line that begins with a slash, from a line's beginning on.
std::size_t next_keyword(std::string_view text, std::size_t at) {
  while (at < text.size() && text[at] != '/') at = std::min(text.find('\n', at), text.size() - 1) + 1;
  return at;
}

/// The layout of a file's cards: that of its nodes or shells, else of the deck's first.
Style style_of_file(const Deck& deck, std::uint32_t file) {
  const CardRun* first = nullptr;
  for (const auto* runs : {&deck.node_runs, &deck.shell_runs})
    for (const CardRun& run : *runs) {
      if (run.file == file) return Style::of(run.style);
      if (first == nullptr) first = &run;
    }
  return first != nullptr ? Style::of(first->style) : Style{};
}

}  // namespace

Result<ElementPlace> find_element(const Deck& deck, ElementClass element_class, std::int64_t id, std::span<const std::int64_t> nodes) {
  if (element_class != ElementClass::discrete)
    return fail("", "can't be an example: of the elements other than shells this version adds springs to Radioss decks");
  for (std::uint32_t file = 0; file < deck.files.size(); ++file) {
    const std::string_view text = deck.files[file].bytes.text();
    const IdOffsets offsets = deck.offsets_in(file).value_or(IdOffsets());
    const Style style{style_of_file(deck, file).old, false};
    const std::size_t width = style.width();
    std::optional<ElementPlace> found;
    std::int64_t largest = 0;
    for (std::size_t at = next_keyword(text, 0), end = 0; at < text.size(); at = end) {
      const std::size_t body = std::min(text.find('\n', at), text.size() - 1) + 1;
      end = next_keyword(text, body);
      if (keyword_at(text, at).word(0) != "SPRING") continue;
      Lines lines(text, body, end);
      std::string_view raw;
      for (std::size_t offset = 0; lines.next(raw, offset);) {
        const std::string line = without_tabs(raw);
        const std::int64_t own = id_in(line, width, 0);
        largest = std::max(largest, own);
        if (found || own + offsets.element != id) continue;
        bool same = true;
        for (std::size_t n = 0; n < nodes.size(); ++n) same = same && id_in(line, width, 1 + n) + offsets.node == nodes[n];
        if (same) found = ElementPlace{file, offset, offset + raw.size(), style.number(), 0};
      }
    }
    if (!found) continue;
    found->last_in_file = largest;
    return *found;
  }
  return fail("", "can't be an example: its card isn't found in its block, or parameters give its numbers");
}

Result<WrittenCard> element_like(std::string_view text, const ElementPlace& example, const ElementCard& element) {
  const std::size_t width = Style::of(example.style).width();
  WrittenCard card;
  card.text = without_tabs(text.substr(example.offset, example.end - example.offset));
  if (id_in(card.text, width, kThirdNodeOfSpring) != 0)
    return fail("", "would be like a spring with a third node for its orientation, which a new spring hasn't");
  put(card.text, 0, width, std::to_string(element.id));
  for (std::size_t n = 0; n < element.nodes.size(); ++n) put(card.text, (1 + n) * width, width, std::to_string(element.nodes[n]));
  return card;
}

}  // namespace prismesh::mesh::deck::radioss
