#include "mesh/deck/abaqus/element_writer.h"

#include <algorithm>
#include <optional>
#include <set>
#include <vector>

#include "mesh/deck/abaqus/card_fields.h"
#include "mesh/deck/abaqus/element_type.h"
#include "mesh/deck/abaqus/keyword.h"
#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::abaqus {
namespace {

std::int64_t number_at(std::string_view text, const FieldRange& place) {
  std::int64_t value = 0;
  return parse_integer(trim(text.substr(place.begin, place.length)), value) ? value : 0;
}

/// The blocks of elements of a class with a number of nodes whose data lines stand below their keyword.
bool holds_such(std::string_view text, const Keyword& keyword, ElementClass element_class, std::size_t nodes) {
  if (keyword.name != "ELEMENT") return false;
  const Parameters given(text, keyword.begin, keyword.end);
  if (given.has("INPUT") || given.has("OFFSET")) return false;
  const std::string word = label(given.value("TYPE").value_or(""));
  if (element_class == ElementClass::discrete) return word == "CONN3D2";
  const ElementType type = element_type(word);
  return type.element_class == element_class && type.nodes == nodes;
}

struct WantedElement {
  std::int64_t id = 0;
  std::span<const std::int64_t> nodes;
};

/// Looks through a block for the wanted card, and for the largest id.
void search_elements(std::string_view text, std::size_t begin, std::size_t end, const WantedElement& wanted, std::int64_t& largest,
                     std::optional<ElementPlace>& found) {
  DataLines lines(text.substr(0, end), begin, end);
  for (DataLine line; lines.next(line);) {
    std::size_t card_end = line.offset;
    const std::vector<FieldRange> places = cut_card(text.substr(0, end), line.offset, wanted.nodes.size() + 1, card_end);
    lines = DataLines(text.substr(0, end), std::min(std::max(card_end, line.offset + line.text.size()) + 1, end), end);
    if (places.size() != wanted.nodes.size() + 1) continue;
    const std::int64_t id = number_at(text, places[0]);
    largest = std::max(largest, id);
    if (found || id != wanted.id) continue;
    bool same = true;
    for (std::size_t n = 0; n < wanted.nodes.size(); ++n) same = same && number_at(text, places[n + 1]) == wanted.nodes[n];
    if (same) found = ElementPlace{0, line.offset, card_end, 0, 0};
  }
}

/// The element sets that *FASTENER names, in capitals.
std::set<std::string> fastened_sets(const Deck& deck) {
  std::set<std::string> sets;
  for (const auto& file : deck.files) {
    Keywords keywords(file.bytes.text());
    for (Keyword keyword; keywords.next(keyword);)
      if (keyword.name == "FASTENER")
        if (const auto elset = Parameters(file.bytes.text(), keyword.begin, keyword.end).value("ELSET")) sets.insert(label(*elset));
  }
  return sets;
}

/// Whether a *FASTENER names the set of the block of the element at `offset`, or a set that lists it.
bool is_fastened(const Deck& deck, std::int64_t id, std::string_view text, std::size_t offset) {
  const std::set<std::string> fastened = fastened_sets(deck);
  for (const Reference& reference : deck.references->naming(referred(ElementClass::discrete), id))
    if (const Referrer& card = deck.references->referrers()[reference.referrer];
        card.keyword == "ELSET" && fastened.contains(label(card.title)))
      return true;
  std::string own;
  Keywords keywords(text.substr(0, offset));
  for (Keyword keyword; keywords.next(keyword);) own = label(Parameters(text, keyword.begin, keyword.end).value("ELSET").value_or(""));
  return !own.empty() && fastened.contains(own);
}

}  // namespace

Result<ElementPlace> find_element(const Deck& deck, ElementClass element_class, std::int64_t id, std::span<const std::int64_t> nodes) {
  if (!(element_class == ElementClass::solid && nodes.size() == 8) && !(element_class == ElementClass::discrete && nodes.size() == 2))
    return fail("",
                "can't be an example: of the elements other than shells this version adds hexahedra with eight nodes and connectors "
                "(CONN3D2) to Abaqus decks");
  if (has_instances(deck)) return fail("", "can't be an example: the deck is made of parts and instances, to which this version adds none");
  for (const Reference& reference : deck.references->naming(referred(element_class), id))
    if (const Referrer& card = deck.references->referrers()[reference.referrer];
        reference.role == ReferenceRole::single && card.keyword == "SURFACE")
      return fail("", "can't be an example: the surface " + card.title + " names it by its number, and wouldn't hold new ones");
  for (std::uint32_t file = 0; file < deck.files.size(); ++file) {
    const std::string_view text = deck.files[file].bytes.text();
    std::int64_t largest = 0;
    std::optional<ElementPlace> found;
    std::optional<std::size_t> begin;  // of the data lines of a block that may hold it
    Keywords keywords(text);
    for (Keyword keyword; keywords.next(keyword);) {
      if (begin) search_elements(text, *begin, keyword.begin, {id, nodes}, largest, found);
      begin.reset();
      if (holds_such(text, keyword, element_class, nodes.size())) begin = keyword.end;
    }
    if (begin) search_elements(text, *begin, text.size(), {id, nodes}, largest, found);
    if (!found) continue;
    if (element_class == ElementClass::discrete && !is_fastened(deck, id, text, found->offset))
      return fail("", "can't be an example: no *FASTENER names its element set, so that nothing would attach a new one to the sheets");
    found->file = file;
    found->last_in_file = largest;
    return *found;
  }
  return fail("", "can't be an example: its card isn't found below an *ELEMENT of its file");
}

Result<WrittenCard> element_like(std::string_view text, const ElementPlace& example, const ElementCard& element) {
  std::size_t end = example.offset;
  const std::vector<FieldRange> places = cut_card(text, example.offset, element.nodes.size() + 1, end);
  if (places.size() != element.nodes.size() + 1) return fail("", "would be like an element whose card can't be read");
  WrittenCard card;
  card.text = std::string(text.substr(example.offset, example.end - example.offset));
  for (std::size_t f = places.size(); f-- > 0;) {
    const std::string_view old = text.substr(places[f].begin, places[f].length);
    card.text.replace(places[f].begin - example.offset, places[f].length,
                      in_place_of(old, std::to_string(f == 0 ? element.id : element.nodes[f - 1]), starts_with_blanks(old)));
  }
  return card;
}

std::size_t end_of_model(std::string_view text) {
  Keywords keywords(text);
  for (Keyword keyword; keywords.next(keyword);)
    if (keyword.name == "STEP") return keyword.begin;
  return text.size();
}

std::string quoted_name(const std::string& name) {
  const bool plain = std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '.' || c == '/';
  });
  return plain ? name : '"' + name + '"';
}

Result<std::string> element_header(ElementClass element_class, const Part& part) {
  if ((element_class != ElementClass::solid && element_class != ElementClass::discrete) || part.name.empty())
    return fail("", "has no example to be written like");
  return "*ELEMENT, TYPE=" + std::string(element_class == ElementClass::solid ? "C3D8" : "CONN3D2") + ", ELSET=" + quoted_name(part.name);
}

WrittenCard new_element(const ElementCard& element) {
  WrittenCard card;
  card.text = std::to_string(element.id);
  for (const std::int64_t node : element.nodes) card.text += ", " + std::to_string(node);
  return card;
}

bool has_instances(const Deck& deck) {
  return std::any_of(deck.files.begin(), deck.files.end(), [](const auto& file) {
    Keywords keywords(file.bytes.text());
    for (Keyword keyword; keywords.next(keyword);)
      if (keyword.name == "PART" || keyword.name == "INSTANCE") return true;
    return false;
  });
}

}  // namespace prismesh::mesh::deck::abaqus
