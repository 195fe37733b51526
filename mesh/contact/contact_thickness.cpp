#include "mesh/contact/contact_thickness.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace prismesh::mesh::contact {

namespace {

double usable(double thickness) { return std::isfinite(thickness) && thickness > 0 ? thickness : 0; }

/// `thickness_of(s)`: of a shell that isn't removed.
template <class ThicknessOf>
ContactThickness for_each_shell(const Model& model, ThicknessFrom from, ThicknessOf&& thickness_of) {
  ContactThickness thickness;
  thickness.of_shell.assign(model.shell_count(), 0);
  thickness.of_part.assign(model.parts->size(), ThicknessFrom::none);
  std::vector<std::uint8_t> missing(model.parts->size(), 0);
  for (std::size_t s = 0; s < model.shell_count(); ++s) {
    if (model.is_removed(ShellIndex(s))) continue;
    thickness.of_shell[s] = thickness_of(s);
    const PartIndex part = model.shell_parts[s];
    if (!part.valid()) continue;
    if (thickness.of_shell[s] > 0)
      thickness.of_part[part.value] = from;
    else
      missing[part.value] = 1;
  }
  for (std::size_t p = 0; p < missing.size(); ++p)
    if (missing[p] != 0) thickness.without.push_back(PartIndex(p));
  return thickness;
}

}  // namespace

std::string_view name(ThicknessFrom from) {
  switch (from) {
    case ThicknessFrom::none: return "none";
    case ThicknessFrom::section: return "section";
    case ThicknessFrom::given: return "given";
    case ThicknessFrom::contact: return "contact";
  }
  return "";
}

double ContactThickness::between(ShellIndex a, ShellIndex b) const {
  if (rules.empty()) return (of_shell[a.value] + of_shell[b.value]) / 2;
  const GapRule &of_a = rules[a.value], &of_b = rules[b.value];
  const double mean = std::min((of_a.thickness + of_b.thickness) / 2, (of_a.by_mesh + of_b.by_mesh) / 2);
  return std::max(std::min(of_a.least, of_b.least), std::min(mean, std::max(of_a.most, of_b.most)));
}

ContactThickness section_thickness(const Model& model) {
  std::vector<double> of_part;
  of_part.reserve(model.parts->size());
  for (const Part& part : *model.parts) of_part.push_back(usable(part.thickness.value_or(0)));
  return for_each_shell(model, ThicknessFrom::section, [&](std::size_t s) {
    if (const double own = usable(model.shell_thickness[s]); own > 0) return own;
    const PartIndex part = model.shell_parts[s];
    return part.valid() ? of_part[part.value] : 0.0;
  });
}

void take_contact_thickness(const Model& model, const std::vector<std::uint8_t>& seen, ContactThickness& thickness) {
  for (std::size_t s = 0; s < model.shell_count(); ++s)
    if (const PartIndex part = model.shell_parts[s]; seen[s] != 0 && part.valid() && thickness.of_shell[s] > 0)
      thickness.of_part[part.value] = ThicknessFrom::contact;
  // A part has none only if it has none in its contacts either: tools without a thickness may get one there.
  std::erase_if(thickness.without, [&](PartIndex part) { return thickness.of_part[part.value] == ThicknessFrom::contact; });
}

ContactThickness given_thickness(const Model& model, double thickness) {
  return for_each_shell(model, ThicknessFrom::given, [&](std::size_t) { return thickness; });
}

}  // namespace prismesh::mesh::contact
