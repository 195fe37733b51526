// Submodels and unit systems: how ids and lengths of a text become those of the model.
// Source: Radioss Reference Guide, "//SUBMODEL", "/BEGIN", "/UNIT".
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "mesh/deck/data/deck.h"
#include "mesh/deck/radioss/block.h"

namespace prismesh::mesh::deck::radioss {

/// Units of mass, length and time in kg, m and s.
struct Units {
  double mass = 1;
  double length = 1;
  double time = 1;
};

/// The factor of "kg", "mm", "ms", "Mg", "mus", or of a number. `base`: the unit's letter, 'g', 'm' or 's'. nullopt: neither a unit nor a
/// number.
std::optional<double> unit_factor(std::string_view code, char base);

/// A submodel, or the deck outside of them.
struct Context {
  std::int64_t id = 0;
  std::uint32_t parent = 0;  ///< index; of the deck outside: its own
  std::uint32_t file = 0;
  std::size_t offset = 0;    ///< of its keyword
  std::int64_t version = 0;  ///< 0: that of the context around it
  std::int64_t unit = 0;     ///< of its keyword; 0: none
  std::optional<Units> units;
  bool has_begin = false;
  int depth = 0;    ///< number of submodels around it
  IdOffsets added;  ///< includes those of the submodels around it

  std::size_t field_width() const { return version > 0 && version < kFirstWideVersion ? kOldField : kField; }
};

/// The unit systems that /UNIT defines, by context and id.
class UnitSystems {
 public:
  void define(std::uint32_t context, std::int64_t id, Units units) { systems_.try_emplace({context, id}, units); }
  std::optional<Units> find(std::span<const Context> contexts, std::uint32_t context, std::int64_t id) const;

 private:
  std::map<std::pair<std::uint32_t, std::int64_t>, Units> systems_;
};

}  // namespace prismesh::mesh::deck::radioss
