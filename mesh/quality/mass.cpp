#include "mesh/quality/mass.h"

#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>

#include "base/parallel_for.h"
#include "mesh/quality/shell_batch.h"
#include "mesh/quality/shell_properties.h"

namespace prismesh::mesh::quality {

namespace {

constexpr std::size_t kMassGrain = 16384;

}  // namespace

MassProperties& MassProperties::operator+=(const MassProperties& more) {
  mass += more.mass;
  moment += more.moment;
  shells += more.shells;
  return *this;
}

MassProperties& MassProperties::operator-=(const MassProperties& less) {
  mass -= less.mass;
  moment -= less.moment;
  shells -= less.shells;
  return *this;
}

std::optional<Vec3> MassProperties::centre() const {
  if (!(mass > 0)) return std::nullopt;
  return Vec3(moment / mass);
}

MassProperties mass_properties(const Model& model, ShellIndex shell) {
  const PartIndex part = model.shell_parts[shell.value];
  if (!part.valid() || model.is_removed(shell)) return {};
  const std::optional<double>& density = (*model.parts)[part.value].density;
  const double thickness = thickness_of(model, shell.value);
  if (!density || !(thickness > 0)) return {};
  const ShellNodes& nodes = model.shell(shell);
  std::array<Vec3, 4> p;
  for (std::size_t c = 0; c < 4; ++c) p[c] = model.position(nodes.node[c]);
  const double first = 0.5 * (p[1] - p[0]).cross(p[2] - p[0]).norm();
  const double second = 0.5 * (p[2] - p[0]).cross(p[3] - p[0]).norm();
  if (!std::isfinite(first + second)) return {};
  const double surface_density = *density * thickness;
  return {surface_density * (first + second), surface_density / 3.0 * (first * (p[0] + p[1] + p[2]) + second * (p[0] + p[2] + p[3])), 1};
}

MassProperties mass_properties(const Model& model) {
  std::vector<MassProperties> parts((model.shell_count() + kMassGrain - 1) / kMassGrain);
  parallel_for(model.shell_count(), kMassGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) parts[begin / kMassGrain] += mass_properties(model, ShellIndex(s));
  });
  MassProperties sum;
  for (const MassProperties& part : parts) sum += part;
  return sum;
}

MassProperties mass_properties(const Model& model, const ShellSet& shells) {
  MassProperties sum;
  for (const ShellIndex shell : shells) sum += mass_properties(model, shell);
  return sum;
}

}  // namespace prismesh::mesh::quality
