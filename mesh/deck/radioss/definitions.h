// Reads parts, properties and materials.
// Source: Radioss Reference Guide, "/PART", "/PROP", "/MAT".
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string_view>
#include <utility>
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

/// The fields of the constants of a material law ("PLAS_JOHNS", "LAW2"), from 1; 0: it has none. The density is the first number of the
/// first card.
struct MaterialFields {
  int card = 2;            ///< with the two others
  int youngs_modulus = 0;  ///< counted in fields of one width, of which a number takes two
  int poissons_ratio = 0;
  bool limits_time_step = true;
  bool has_density = true;  ///< in the first field of the first card
};
MaterialFields material_fields(std::string_view law);

/// The deck's files, submodels, parameters and unit systems, with which blocks are read.
struct DeckTables {
  std::span<const SourceFile> files;
  std::span<const Context> contexts;
  const Parameters& parameters;
  const UnitSystems& systems;

  /// The units of a block in `context` that names `system` (0: none). nullopt: the system isn't defined.
  std::optional<Units> units(std::uint32_t context, std::int64_t system) const;
};

/// A field that should be a number and isn't.
struct BadField {
  std::uint32_t file = 0;
  std::size_t offset = 0;  ///< of its line
  std::string message;
};

/// Collects definitions block by block. Of equal ids the first counts.
class Definitions {
 public:
  /// Reads the block if it has a definition; false: it hasn't.
  bool read(const Block& block, const Keyword& keyword, const DeckTables& tables);

  /// What the blocks read so far have that isn't read; forgets it.
  std::vector<BadField> take_bad_fields() { return std::exchange(bad_fields_, {}); }

  /// The defined parts, with the values of their properties and materials, ascending by id, in the main file's units.
  std::vector<Part> parts() const;

 private:
  void read_part(const Block& block, const Keyword& keyword, const DeckTables& tables);
  void read_property(const Block& block, const Keyword& keyword, const DeckTables& tables);
  void read_material(const Block& block, const Keyword& keyword, const DeckTables& tables);

  std::map<std::int64_t, Part> parts_;
  std::map<std::int64_t, double> thickness_;
  std::map<std::int64_t, Material> materials_;
  std::vector<BadField> bad_fields_;
};

}  // namespace prismesh::mesh::deck::radioss
