#include "mesh/quality/shell_properties.h"

#include "mesh/quality/time_step.h"

namespace prismesh::mesh::quality {

ShellProperties properties_of(const Model& model, ShellIndex shell) {
  const PartIndex part = model.shell_parts[shell.value];
  const double speed = part.valid() ? wave_speed((*model.parts)[part.value]).value_or(0.0) : 0.0;
  ShellProperties properties(thickness_of(model, shell.value), speed);
  properties.part = part;
  return properties;
}

}  // namespace prismesh::mesh::quality
