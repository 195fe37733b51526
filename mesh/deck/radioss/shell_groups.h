// The groups of four-node shells and of three-node shells (GRSHEL, GRSH3N), and the cards that use them. A shell that becomes a triangle
// leaves its group, and needs one of the other kind wherever its group is used.
// Source: Radioss Reference Guide, "/GRSHEL", "/GRSH3N", "/SECT", "/ACTIV"; the cards that use shell groups are those of the starter of
// OpenRadioss.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "mesh/deck/data/deck.h"
#include "mesh/deck/writing/cards.h"

namespace prismesh::mesh::deck::radioss {

/// Searches the text of a deck once.
class ShellGroups {
 public:
  /// The deck must outlive this.
  explicit ShellGroups(const Deck& deck);

  /// CardWriter::companion and CardWriter::new_companion.
  Result<std::optional<std::uint32_t>> companion(std::uint32_t set) const;
  std::vector<FileReplacement> new_companion(std::uint32_t set, std::span<const std::int64_t> ids) const;

 private:
  enum Kind : std::uint8_t { quads, triangles };
  /// A card that uses a group of each kind.
  struct Use {
    std::string name;
    std::uint32_t file = 0;
    std::size_t line = 0;                 ///< offset of the line with both ids
    std::array<std::size_t, 2> field{};   ///< of each kind, from 0
    std::array<std::int64_t, 2> group{};  ///< 0: none
  };

  void search(std::uint32_t file);
  void read_use(std::uint32_t file, std::size_t begin, std::size_t end, const std::string& name, const Use& places, std::size_t line);
  void read_other(std::string_view body, const std::string& name);
  std::vector<const Use*> uses_of(Kind kind, std::int64_t group) const;
  std::optional<std::uint32_t> only_group(Kind kind, std::int64_t id) const;

  const Deck& deck_;
  std::vector<Use> uses_;
  std::array<std::map<std::int64_t, std::string>, 2> others_;  ///< groups used by cards that can't use one of each kind, with such a card
  std::array<std::map<std::int64_t, std::size_t>, 2> groups_;  ///< number of blocks with each id
  std::string unclear_;                                        ///< why uses can't be told; empty: they can
};

}  // namespace prismesh::mesh::deck::radioss
