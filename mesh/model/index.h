// Strong index types: a position in the model's arrays, never a deck's id.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>

namespace prismesh::mesh {

/// An index that can't be mistaken for one of another kind. `Tag` only tells kinds apart.
template <class Tag>
struct Index {
  std::uint32_t value = kNone;

  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  constexpr Index() = default;
  constexpr explicit Index(std::size_t index) : value(static_cast<std::uint32_t>(index)) {}
  constexpr bool valid() const { return value != kNone; }
  constexpr auto operator<=>(const Index&) const = default;  // NOLINT(modernize-use-nullptr): the check mistakes the operator
};

using NodeIndex = Index<struct NodeTag>;
using ShellIndex = Index<struct ShellTag>;
using PartIndex = Index<struct PartTag>;

}  // namespace prismesh::mesh

template <class Tag>
struct std::hash<prismesh::mesh::Index<Tag>> {
  std::size_t operator()(prismesh::mesh::Index<Tag> index) const { return std::hash<std::uint32_t>()(index.value); }
};
