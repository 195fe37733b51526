// What expressions may name besides ids: a deck's sets and its files. Points into the deck; empty where there is none.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/model/model.h"
#include "mesh/model/references.h"

namespace prismesh::mesh::select {

struct Names {
  const References* references = nullptr;  ///< its sets; null: no sets
  std::vector<std::string> files;          ///< as the deck's SourceFile::relative, by number
  std::function<std::uint32_t(NodeIndex)> file_of_node;
  std::function<std::uint32_t(ShellIndex)> file_of_shell;
};

/// A set of the deck: all its cards of one kind with one id, or with one title in formats whose sets have no ids. What a card holds
/// tells its kind where its keyword leaves that open.
struct NamedSet {
  Referred kind = Referred::node_set;
  std::int64_t id = 0;               ///< 0: it goes by its title
  std::string title;                 ///< may be empty
  bool intersects = false;           ///< of the sets it names, only what all of them have
  std::vector<Reference> members{};  ///< in the order of the cards

  /// As expressions call it: `node_set:17`, `element_set:"rail"`.
  std::string label() const;
};

/// All sets, ascending by kind and id, then as they stand in the deck. Costs the reverse index.
std::vector<NamedSet> find_sets(const References& references);

/// The set that `node_set`, ... (or `set`: nullopt, then of several kinds the preferred one) and an id or a title mean; titles are
/// compared without regard to case. Errors are sentences: there is none (the nearest is named), there are several.
struct WantedSet {
  std::optional<Referred> kind;
  Referred preferred = Referred::node_set;
  std::int64_t id = 0;  ///< 0: by title
  std::string_view title;
};
struct FoundSet {
  const NamedSet* set = nullptr;
  std::string problem;  ///< if there is no set
};
FoundSet find_set(std::span<const NamedSet> sets, const WantedSet& wanted);

/// The number of the file of that name: its path as in the deck, or the end of the path where only one file has it. nullopt: `problem`
/// says why.
std::optional<std::uint32_t> find_file(std::span<const std::string> files, std::string_view name, std::string& problem);

/// Parts by name, without regard to case, ascending; and the words for it where there is none.
std::vector<PartIndex> parts_called(const std::vector<Part>& parts, std::string_view name);
std::string no_part_called(const std::vector<Part>& parts, std::string_view name);

}  // namespace prismesh::mesh::select
