// What the shells of each part are judged by: what the user chose, what was guessed, and what follows. The rules: docs/quality/criteria.md.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "mesh/quality/criteria.h"

namespace prismesh::mesh::document {

/// How a part's target size is guessed: from its own edges (from the deck's for a part with few edges), or from the deck's.
enum class SizeGuess : std::uint8_t { part, deck };
/// A target size as the user chooses it: guessed, or a length in the deck's unit.
using TargetSize = std::variant<SizeGuess, double>;

inline bool is_guessed(const TargetSize& size) { return std::holds_alternative<SizeGuess>(size); }

/// Criteria with the name or file that the user gave, and their text, so that nothing depends on the file any more.
struct ChosenCriteria {
  std::string name;  ///< built-in, or the file's path; empty: nobody chose, they are the built-in default
  std::shared_ptr<const quality::Criteria> criteria;
  std::shared_ptr<const std::string> text;
};

/// What the user chose for one part.
struct PartChoice {
  std::optional<TargetSize> target_size;   ///< absent: as for all parts
  std::optional<ChosenCriteria> criteria;  ///< absent: the deck's
};

struct Judging {
  // chosen
  TargetSize target_size = SizeGuess::part;  ///< of the parts that have no choice of their own
  ChosenCriteria criteria;                   ///< the deck's: of the parts that have none of their own, and of the deck as a whole
  std::vector<PartChoice> parts;             ///< by PartIndex

  // guessed when the deck was opened
  double guessed_size = 1;                     ///< the deck's
  std::vector<quality::PartCriteria> guessed;  ///< by PartIndex

  // what follows
  double deck_size = 1;             ///< of shells that belong to no part
  quality::CriteriaByPart by_part;  ///< by PartIndex
};

/// Derives what follows from what is chosen and guessed.
void settle(Judging& judging);

/// The criteria and sizes of every part. `judging` must outlive the result and not change.
inline quality::SizedCriteria sized(const Judging& judging) { return {*judging.criteria.criteria, judging.deck_size, &judging.by_part}; }

}  // namespace prismesh::mesh::document
