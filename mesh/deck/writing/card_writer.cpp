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

}  // namespace prismesh::mesh::deck
