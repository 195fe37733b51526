// Reads parts, sections, materials, contacts and the time step control (LS-DYNA keyword manual, volumes I and II).
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mesh/deck/data/deck.h"
#include "mesh/deck/lsdyna/card.h"
#include "mesh/deck/lsdyna/contact_cards.h"
#include "mesh/deck/lsdyna/includes.h"
#include "mesh/deck/lsdyna/keyword.h"
#include "mesh/deck/lsdyna/parameters.h"

namespace prismesh::mesh::deck::lsdyna {

/// A field that should be a number and isn't.
struct BadField {
  std::size_t offset = 0;  ///< of its line
  std::string message;
};

struct Material {
  std::optional<double> density;
  std::optional<double> youngs_modulus;
  std::optional<double> poissons_ratio;
  bool limits_time_step = true;
};

/// Collects definitions block by block. Of equal ids the first counts.
class Definitions {
 public:
  /// Reads the block if it has definitions; false: it hasn't. `context`: of the include it stands in; ids and units become the model's.
  bool read(std::string_view text, const Block& block, const Parameters& parameters, const IncludeContext& context);

  /// What the blocks read so far have that isn't read; forgets it.
  std::vector<BadField> take_bad_fields() { return std::exchange(bad_fields_, {}); }

  /// The defined parts, with the values of their sections and materials, ascending by id.
  std::vector<Part> parts() const;
  const TimeStepControl& time_step() const { return time_step_; }
  ContactCards contacts() const { return contacts_.cards(); }

 private:
  struct Layer {
    std::int64_t material = 0;  ///< 0: none
    double thickness = 0;       ///< in the units of its include
  };
  std::optional<double> number(const Card& card, std::size_t offset, std::size_t field, const char* what, const Parameters& parameters);
  std::optional<double> density_of(const std::vector<Layer>& layers) const;
  void add_part(std::int64_t id, Part part, std::string_view title);
  void read_parts(std::string_view text, const Block& block, const Parameters& parameters);
  void read_composite_part(std::string_view text, const Block& block, const Parameters& parameters);
  void read_shell_sections(std::string_view text, const Block& block, const Parameters& parameters);
  void read_material(std::string_view text, const Block& block, const Parameters& parameters);
  void read_time_step(std::string_view text, const Block& block, const Parameters& parameters);

  const IncludeContext* context_ = nullptr;  ///< of what is being read
  std::map<std::int64_t, Part> parts_;
  std::map<std::int64_t, std::vector<Layer>> layers_;  ///< of composite parts
  std::map<std::int64_t, double> section_thickness_;
  std::map<std::int64_t, Material> materials_;
  TimeStepControl time_step_;
  ContactReader contacts_;
  std::vector<BadField> bad_fields_;
};

/// The fields of a material's constants on its first card, from 1; 0: it has none. By the keyword: "MAT_ELASTIC", "MAT_024_TITLE".
struct MaterialFields {
  int density = 2;
  int youngs_modulus = 0;
  int poissons_ratio = 0;
  bool limits_time_step = true;
};
MaterialFields material_fields(std::string_view keyword);

}  // namespace prismesh::mesh::deck::lsdyna
