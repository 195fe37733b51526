// The defaults of a format's writer: it refuses.
#include "mesh/deck/writing/card_writer.h"

namespace prismesh::mesh::deck {

Result<WrittenCard> CardWriter::new_constrained_node(const CardRef&, std::int64_t, const Vec3&) const {
  return fail("", "has constraints that can't be given to a new node");
}

Result<WrittenCard> CardWriter::shell_in_manner(const CardRef&, const CardRef&, const ShellCard&) const {
  return fail("", "stands on a card whose kind says how many corners it has");
}

Result<std::optional<std::uint32_t>> CardWriter::companion(const Deck&, std::uint32_t) const { return fail("", ""); }

std::vector<FileReplacement> CardWriter::new_companion(const Deck&, std::uint32_t, std::span<const std::int64_t>) const { return {}; }

Result<CardWriter::NewBlock> CardWriter::block_of_kind(const CardRef&, bool) const {
  return fail("", "stands on a card whose kind says how many corners it has, and its part has none of the other kind");
}

Result<WrittenCard> CardWriter::shell_in_block(const CardRef&, const ShellCard&) const {
  return fail("", "stands on a card whose kind says how many corners it has");
}

Result<std::vector<Replacement>> CardWriter::change_list(std::string_view text, const Referrer& set, std::span<const std::int64_t> joining,
                                                         std::span<const std::int64_t> leaving) const {
  if (leaving.empty()) return join(text, set, joining);
  return fail("", "can't have an entry taken out");
}

Result<std::vector<Replacement>> CardWriter::replace_segment(std::string_view, const Referrer&, std::size_t,
                                                             std::span<const std::array<std::int64_t, 4>>) const {
  return fail("", "can't have a segment replaced");
}

Inheritance CardWriter::inheritance(const Referrer&, Referred) const { return Inheritance::forbids; }

Result<std::vector<Replacement>> CardWriter::copy_single(std::string_view, const Referrer&, const Reference&,
                                                         std::span<const std::int64_t>) const {
  return fail("", "can't be written again for another");
}

Result<ElementPlace> CardWriter::find_element(const Deck& deck, ElementClass, std::int64_t, std::span<const std::int64_t>) const {
  return fail("", "can't be an example: this version adds no such elements to " + std::string(name(deck.format)) + " decks");
}

Result<WrittenCard> CardWriter::element_like(std::string_view, const ElementPlace&, const ElementCard&) const {
  return fail("", "can't be an example");
}

Result<std::pair<Part, std::string>> CardWriter::weld_part(const Deck& deck, const Model&, const WeldPart&) const {
  return fail("", "this version makes no part of welds in " + std::string(name(deck.format)) +
                      " decks, but in LS-DYNA, Nastran and Abaqus decks; in Radioss decks \"like\" copies an existing spring");
}

Result<std::pair<Part, std::string>> CardWriter::bond_part(const Deck& deck, const Model&, const BondPart&) const {
  return fail("", "this version makes no bonds in " + std::string(name(deck.format)) + " decks, but in LS-DYNA and Abaqus decks");
}

Result<std::string> CardWriter::element_header(ElementClass, const Part&) const { return fail("", "has no example to be written like"); }

Result<WrittenCard> CardWriter::new_element(std::string_view, ElementClass, const ElementCard&) const {
  return fail("", "has no example to be written like");
}

}  // namespace prismesh::mesh::deck
