#include "mesh/deck/nastran/element_writer.h"

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "mesh/deck/nastran/card.h"
#include "mesh/deck/nastran/card_edit.h"
#include "mesh/deck/nastran/elements.h"
#include "mesh/deck/nastran/replication.h"
#include "mesh/deck/nastran/walk.h"

namespace prismesh::mesh::deck::nastran {
namespace {

/// The fields of a weld of form PARTPAT, or of a CFAST of type PROP.
std::vector<std::string> weld_fields(bool is_fastener, const ElementCard& element) {
  const std::string id = std::to_string(element.id), property = std::to_string(element.part);
  const std::string a = std::to_string(element.nodes[0]), b = std::to_string(element.nodes[1]);
  const std::string sheet_a = std::to_string(element.sheets[0]), sheet_b = std::to_string(element.sheets[1]);
  if (is_fastener) return {id, property, "PROP", sheet_a, sheet_b, "", a, b};
  return {id, property, "", "PARTPAT", a, b, "", "", sheet_a, sheet_b};
}

Result<void> has_two_sheets(const ElementCard& element) {
  if (element.nodes.size() == 2 && element.sheets.size() == 2 && element.sheets[0] > 0 && element.sheets[1] > 0 &&
      element.sheets[0] != element.sheets[1])
    return {};
  return fail("", "would join sheets whose properties can't be told apart");
}

}  // namespace

Result<deck::ElementPlace> find_element(const Deck& deck, ElementClass element_class, std::int64_t id) {
  if (element_class != ElementClass::discrete)
    return fail("", "can't be an example: of the elements other than shells this version adds CWELD and CFAST to Nastran decks");
  for (std::uint32_t file = 0; file < deck.files.size(); ++file) {
    const std::string_view text = deck.files[file].bytes.text();
    std::int64_t largest = 0;
    std::optional<deck::ElementPlace> found;
    for (std::size_t at = 0; at < text.size();) {
      const Line line = line_at(text, at);
      at = line.next;
      if (line.text.empty() || (line.text[0] != 'C' && line.text[0] != 'c') || !starts_card(line.text)) continue;
      const Card card = card_at(text, line.offset);
      const ElementForm* form = element_form(card.name());
      if (form == nullptr || form->element_class != element_class) continue;
      largest = std::max(largest, card.integer_or_zero(0));
      if (found || card.integer_or_zero(0) != id) continue;
      if (card.name() != "CWELD" && card.name() != "CFAST")
        return fail("", "can't be an example: it is a " + std::string(card.name()) + ", no CWELD or CFAST");
      if (is_replicated(text, line.offset)) return fail("", "can't be an example: it is made by replication or replicated");
      found = deck::ElementPlace{file, line.offset, end_of_card(text, line.offset), static_cast<std::uint16_t>(card.layout()), 0};
    }
    if (!found) continue;
    found->last_in_file = largest;
    return *found;
  }
  return fail("", "can't be an example: its card isn't found");
}

Result<WrittenCard> weld_like(std::string_view text, std::size_t example, const ElementCard& element) {
  if (const Result<void> sound = has_two_sheets(element); !sound) return fail(sound.error());
  const Card card = card_at(text, example);
  WrittenCard written;
  written.text = write_card(card.name(), weld_fields(card.name() == "CFAST", element), manner_of(text, example));
  return written;
}

Result<WrittenCard> new_weld(std::string_view text, const ElementCard& element) {
  if (const Result<void> sound = has_two_sheets(element); !sound) return fail(sound.error());
  Manner manner;
  manner.line_end = line_end_at(text, std::min(text.find('\n'), text.size()));
  WrittenCard written;
  written.text = write_card("CWELD", weld_fields(false, element), manner);
  return written;
}

std::size_t end_of_bulk_data(std::string_view text) {
  const std::vector<Mark> marks = find_marks(text);
  bool in_bulk = std::none_of(marks.begin(), marks.end(), [](const Mark& mark) {
    return mark.kind == MarkKind::begin_bulk || mark.kind == MarkKind::begin_other || mark.kind == MarkKind::executive;
  });
  for (const Mark& mark : marks) {
    if (in_bulk && (mark.kind == MarkKind::end_data || mark.kind == MarkKind::begin_other)) return mark.offset;
    in_bulk = in_bulk || mark.kind == MarkKind::begin_bulk;
  }
  return text.size();
}

}  // namespace prismesh::mesh::deck::nastran
