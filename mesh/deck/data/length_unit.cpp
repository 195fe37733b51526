#include "mesh/deck/data/length_unit.h"

#include <algorithm>
#include <cmath>

namespace prismesh::mesh::deck {
namespace {

constexpr std::size_t kSampledShells = 20000;

/// Median edge of the shells, of a sample where there are many; 0 without shells.
double median_edge(const Model& model) {
  std::vector<double> lengths;
  const std::size_t step = std::max<std::size_t>(1, model.shell_count() / kSampledShells);
  for (std::size_t s = 0; s < model.shell_count(); s += step) {
    const ShellNodes& shell = model.shell_nodes[s];
    for (std::size_t i = 0; i < 4; ++i)
      if (shell.node[i] != shell.node[(i + 1) % 4])
        lengths.push_back((model.position(shell.node[i]) - model.position(shell.node[(i + 1) % 4])).norm());
  }
  if (lengths.empty()) return 0;
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return *middle;
}

/// A unit system by what engineering materials weigh in it: from light plastics or magnesium to lead.
struct System {
  double lightest;
  double heaviest;
  LengthUnit unit;
};
constexpr System kSystems[] = {
    {0.5e-9, 2.5e-8, LengthUnit::mm},  // t, mm, s: steel 7.85e-9
    {0.5e-6, 2.5e-5, LengthUnit::mm},  // kg, mm, ms: steel 7.85e-6
    {5.0e-5, 2.0e-3, LengthUnit::in},  // lbf s2/in, in, s: steel 7.3e-4
    {2.0e-3, 2.5e-2, LengthUnit::mm},  // g, mm, ms: steel 7.85e-3
    {200.0, 25000.0, LengthUnit::m},   // kg, m, s: steel 7850
};

}  // namespace

LengthUnit guess_length_unit(const Model& model) {
  // The median density: dummies of rigid parts often have absurd ones.
  std::vector<double> densities;
  for (const Part& part : *model.parts)
    if (part.density && *part.density > 0) densities.push_back(*part.density);
  if (!densities.empty()) {
    const auto middle = densities.begin() + static_cast<std::ptrdiff_t>(densities.size() / 2);
    std::nth_element(densities.begin(), middle, densities.end());
    for (const System& system : kSystems)
      if (*middle >= system.lightest && *middle <= system.heaviest) return system.unit;
  }
  const double edge = median_edge(model);
  return edge > 0 && edge < 0.1 ? LengthUnit::m : LengthUnit::mm;
}

}  // namespace prismesh::mesh::deck
