// Parts, properties and materials: what a deck says about its elements besides their shape.
// Source: Radioss Reference Guide, "/PART", "/PROP", "/MAT".
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string_view>
#include <vector>

#include "mesh/deck/data/deck.h"
#include "mesh/deck/radioss/block.h"
#include "mesh/deck/radioss/context.h"
#include "mesh/deck/radioss/parameters.h"

namespace prismesh::mesh::deck::radioss {

struct Material {
  std::optional<double> density;
  std::optional<double> youngs_modulus;
  std::optional<double> poissons_ratio;
  bool limits_time_step = true;
};

/// Where a material law ("PLAS_JOHNS", "LAW2") keeps its constants, as fields from 1; 0 where it has none. The density is the first number
/// of the first card.
struct MaterialFields {
  int card = 2;            ///< with the two others
  int youngs_modulus = 0;  ///< fields are counted one wide
  int poissons_ratio = 0;
  bool limits_time_step = true;
};
MaterialFields material_fields(std::string_view law);

/// What definitions are read with.
struct DeckTables {
  std::span<const SourceFile> files;
  std::span<const Context> contexts;
  const Parameters& parameters;
  const UnitSystems& systems;

  /// The units of a block in a context that names a system (0: none). nullopt: the system isn't defined.
  std::optional<Units> units(std::uint32_t context, std::int64_t system) const;
};

/// Collects definitions block by block; of equal ids the first counts.
class Definitions {
 public:
  /// Reads the block if its keyword is one of those; false: it isn't.
  bool read(const Block& block, const Keyword& keyword, const DeckTables& tables);

  /// Defined parts with property and material put in, ascending by id, in the main file's units.
  std::vector<Part> parts() const;

 private:
  void read_part(const Block& block, const Keyword& keyword, const DeckTables& tables);
  void read_property(const Block& block, const Keyword& keyword, const DeckTables& tables);
  void read_material(const Block& block, const Keyword& keyword, const DeckTables& tables);

  std::map<std::int64_t, Part> parts_;
  std::map<std::int64_t, double> thickness_;
  std::map<std::int64_t, Material> materials_;
};

}  // namespace prismesh::mesh::deck::radioss
