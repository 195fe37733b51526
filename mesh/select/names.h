// The names that expressions may use besides ids: a deck's sets, files and parts.
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

/// Points into the deck; empty without one.
struct Names {
  const References* references = nullptr;  ///< its sets; null: no sets
  std::vector<std::string> files;          ///< as the deck's SourceFile::relative, by number
  std::function<std::uint32_t(NodeIndex)> file_of_node;
  std::function<std::uint32_t(ShellIndex)> file_of_shell;
};

/// A set of the deck: all cards of one kind with one id, or with one title in formats whose sets have no ids. Where the keyword leaves the
/// kind open, the members give it.
struct NamedSet {
  Referred kind = Referred::node_set;
  std::int64_t id = 0;               ///< 0: the title names it
  std::string title;                 ///< may be empty
  bool intersects = false;           ///< it is the intersection of the sets it names, not their union
  std::vector<Reference> members{};  ///< in the order of the cards

  /// As expressions call it: `node_set:17`, `element_set:"rail"`.
  std::string label() const;
};

/// Finds all sets, ascending by kind and id, then in the deck's order. Cost: the size of the reverse index.
std::vector<NamedSet> find_sets(const References& references);

/// A set by kind (nullopt: any; of several the preferred kind) and id or title. Titles are compared without regard to case.
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
/// Errors, as sentences in `problem`: no such set (the nearest is named), several sets.
FoundSet find_set(std::span<const NamedSet> sets, const WantedSet& wanted);

/// Returns the number of the file with a name: its path as in the deck, or the end of the path if only one file has it. Nothing: `problem`
/// says why.
std::optional<std::uint32_t> find_file(std::span<const std::string> files, std::string_view name, std::string& problem);

/// Returns the parts with a name, without regard to case, ascending; and the message where none has it.
std::vector<PartIndex> parts_called(const std::vector<Part>& parts, std::string_view name);
std::string no_part_called(const std::vector<Part>& parts, std::string_view name);

}  // namespace prismesh::mesh::select
