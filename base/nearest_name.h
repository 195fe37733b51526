// What the user probably meant: the known name nearest to a mistyped one.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace prismesh {

/// Fewest insertions, deletions, replacements and swaps of neighbouring letters that turn `a` into `b`, bytes compared without
/// regard to case (optimal string alignment). Cost: |a| * |b|; longer names than 64 bytes are compared by their first 64.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The nearest of `known` (of equals the first); empty if `known` is.
std::string_view nearest_name(std::string_view name, std::span<const std::string_view> known);

}  // namespace prismesh
