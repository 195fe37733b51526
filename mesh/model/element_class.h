// Classes of elements.
#pragma once

#include <cstdint>
#include <string_view>

namespace prismesh::mesh {

/// Classes of elements. Elements other than shells are shown and their nodes count; edits add them (welds), and change them in no other
/// way.
enum class ElementClass : std::uint8_t { shell, beam, solid, tshell, discrete, mass, sph, other };
inline constexpr int kElementClassCount = 8;
std::string_view name(ElementClass element_class);

}  // namespace prismesh::mesh
