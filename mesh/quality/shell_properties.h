// Thickness, wave speed and part of a shell, which criteria may depend on.
#pragma once

#include "mesh/model/model.h"

namespace prismesh::mesh::quality {

/// Properties of a shell besides its corners; 0 where unknown.
struct ShellProperties {
  float thickness = 0;   ///< deck's length unit
  float wave_speed = 0;  ///< of the material, deck's units; 0 also where it doesn't limit the time step
  PartIndex part;        ///< tells by which target size and criteria the shell is judged; invalid: by those of shells without a part

  ShellProperties() = default;
  ShellProperties(double its_thickness, double its_wave_speed = 0)
      : thickness(static_cast<float>(its_thickness)), wave_speed(static_cast<float>(its_wave_speed)) {}
};
/// The properties of a model's shell; the thickness is that of thickness_of().
ShellProperties properties_of(const Model& model, ShellIndex shell);

/// A shell's thickness by its own card, else by its section; 0 if neither has one.
inline float thickness_of(const Model& model, std::size_t shell) {
  if (const float own = model.shell_thickness[shell]; own > 0) return own;
  const PartIndex part = model.shell_parts[shell];
  if (!part.valid()) return 0;
  return static_cast<float>((*model.parts)[part.value].thickness.value_or(0.0));
}

}  // namespace prismesh::mesh::quality
