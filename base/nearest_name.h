// Finds the known name nearest to a mistyped one.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace prismesh {

/// The min number of insertions, deletions, replacements and swaps of neighbouring letters that turn `a` into `b`, ignoring case (optimal
/// string alignment distance). Cost: |a| * |b|. Only the first 64 bytes of a name are compared.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The nearest of `known`, the first of several; empty if `known` is empty.
std::string_view nearest_name(std::string_view name, std::span<const std::string_view> known);

}  // namespace prismesh
