// Collects what the cards of one block name. Private to references.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "mesh/deck/lsdyna/card.h"
#include "mesh/deck/lsdyna/reference_block.h"
#include "mesh/model/references.h"

namespace prismesh::mesh::deck::lsdyna {

/// Adds references under the block's referrers: under the one begun last, else under one for the whole block.
class ReferenceCollector {
 public:
  ReferenceCollector(const ReferenceBlock& block, References& out) : block_(block), out_(out) {}

  const ReferenceBlock& block() const { return block_; }
  /// Whether a field couldn't be read where a number is expected: the block may name more than was added.
  bool unclear() const { return unclear_; }
  void set_unclear() { unclear_ = true; }

  void cut(const Line& line, Card& card) const { card.cut(line.text, block_.widths, block_.columns); }
  /// The number in a field; 0: it is blank, or no number, which makes the block unclear.
  std::int64_t number(const Card& card, std::size_t field);
  /// The id as the model has it.
  std::int64_t with_offset(Referred referred, std::int64_t id) const;

  /// What is added from here on belongs to this card.
  void begin_referrer(const ReferrerCard& card);
  void end_referrer() { current_.reset(); }

  /// Adds ids that the line at `card` names. Nothing where first and last are 0.
  void add(const NamedIds& ids, std::size_t card);
  /// Adds one id. A negative id, where the manual has none, counts as that id: whoever wants to delete it must know.
  void add(Referred referred, ReferenceRole role, std::int64_t id, std::size_t card);

 private:
  const ReferenceBlock& block_;
  References& out_;
  std::optional<std::uint32_t> current_;  ///< referrer
  bool unclear_ = false;
};

}  // namespace prismesh::mesh::deck::lsdyna
