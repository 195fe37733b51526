#include "mesh/quality/chordal.h"

#include <cmath>
#include <limits>

#include "base/parallel_for.h"

namespace prismesh::mesh::quality {

namespace {

constexpr std::size_t kDeviationGrain = 1024;

float deviation(const Model& model, ShellIndex shell, const OnReference& reference) {
  float largest = std::numeric_limits<float>::quiet_NaN();
  if (model.is_removed(shell)) return largest;
  const ShellNodes& nodes = model.shell(shell);
  const auto corners = static_cast<std::size_t>(nodes.corners());
  for (std::size_t i = 0; i < corners; ++i) {
    const Vec3 centre = 0.5 * (model.position(nodes.node[i]) + model.position(nodes.node[(i + 1) % corners]));
    if (!centre.allFinite()) return std::numeric_limits<float>::quiet_NaN();
    const std::optional<Vec3> on = reference(shell, centre);
    if (!on) continue;
    const auto off = static_cast<float>((*on - centre).norm());
    if (!(off <= largest) && std::isfinite(off)) largest = off;
  }
  return largest;
}

}  // namespace

std::vector<float> chordal_deviations(const Model& model, const ShellSet* shells, const OnReference& reference) {
  std::vector<float> deviations(shells != nullptr ? shells->size() : model.shell_count());
  parallel_for(deviations.size(), kDeviationGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) deviations[i] = deviation(model, shells != nullptr ? (*shells)[i] : ShellIndex(i), reference);
  });
  return deviations;
}

}  // namespace prismesh::mesh::quality
