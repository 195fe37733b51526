// Thickness and wave speed of a shell, as criteria look at them.
#pragma once

#include "mesh/model/model.h"

namespace prismesh::mesh::quality {

/// What of a shell besides its corners the criteria may look at; 0 where unknown.
struct Sheet {
  float thickness = 0;   ///< deck's length unit
  float wave_speed = 0;  ///< of the material, deck's units; 0 also where it doesn't limit the time step

  Sheet() = default;
  Sheet(double its_thickness, double its_wave_speed = 0)
      : thickness(static_cast<float>(its_thickness)), wave_speed(static_cast<float>(its_wave_speed)) {}
};
/// Of a model's shell: thickness of its own card, else of its section.
Sheet sheet_of(const Model& model, ShellIndex shell);

/// A shell's thickness: its own card's, else its section's; 0 if neither says.
inline float thickness_of(const Model& model, std::size_t shell) {
  if (const float own = model.shell_thickness[shell]; own > 0) return own;
  const PartIndex part = model.shell_parts[shell];
  if (!part.valid()) return 0;
  return static_cast<float>((*model.parts)[part.value].thickness.value_or(0.0));
}

}  // namespace prismesh::mesh::quality
