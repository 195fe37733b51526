// Where common materials keep E, nu and the density (LS-DYNA keyword manual, volume II).
#include <algorithm>
#include <string>

#include "mesh/deck/lsdyna/definitions.h"

namespace prismesh::mesh::deck::lsdyna {
namespace {

struct KnownMaterial {
  std::string_view name;
  int number;
  MaterialFields fields;
};

constexpr MaterialFields kIsotropic = {2, 3, 4, true};
/// Ea Eb Ec and then the Poisson's ratios ba ca cb: the stiffest direction is usually a.
constexpr MaterialFields kOrthotropic = {2, 3, 6, true};
constexpr MaterialFields kNoDensity = {0, 0, 0, true};

constexpr KnownMaterial kMaterials[] = {
    {"ELASTIC", 1, kIsotropic},
    {"ORTHOTROPIC_ELASTIC", 2, kOrthotropic},
    {"PLASTIC_KINEMATIC", 3, kIsotropic},
    {"NULL", 9, {2, 7, 8, false}},
    {"JOHNSON_COOK", 15, {2, 4, 5, true}},
    {"POWER_LAW_PLASTICITY", 18, kIsotropic},
    {"STRAIN_RATE_DEPENDENT_PLASTICITY", 19, kIsotropic},
    {"RIGID", 20, {2, 3, 4, false}},
    {"COMPOSITE_DAMAGE", 22, kOrthotropic},
    {"PIECEWISE_LINEAR_PLASTICITY", 24, kIsotropic},
    {"HONEYCOMB", 26, kIsotropic},
    {"RESULTANT_PLASTICITY", 28, kIsotropic},
    {"LAMINATED_GLASS", 32, kIsotropic},
    {"BARLAT_ANISOTROPIC_PLASTICITY", 33, kIsotropic},
    {"FABRIC", 34, kOrthotropic},
    {"3-PARAMETER_BARLAT", 36, kIsotropic},
    {"TRANSVERSELY_ANISOTROPIC_ELASTIC_PLASTIC", 37, kIsotropic},
    {"FLD_TRANSVERSELY_ANISOTROPIC", 39, kIsotropic},
    {"CLOSED_CELL_FOAM", 53, {2, 3, 0, true}},
    {"ENHANCED_COMPOSITE_DAMAGE", 54, kOrthotropic},
    {"ENHANCED_COMPOSITE_DAMAGE", 55, kOrthotropic},
    {"LOW_DENSITY_FOAM", 57, {2, 3, 0, true}},
    {"LAMINATED_COMPOSITE_FABRIC", 58, kOrthotropic},
    {"COMPOSITE_FAILURE_SHELL_MODEL", 59, kOrthotropic},
    {"CRUSHABLE_FOAM", 63, kIsotropic},
    {"RATE_SENSITIVE_POWERLAW_PLASTICITY", 64, kIsotropic},
    {"CABLE_DISCRETE_BEAM", 71, {2, 3, 0, true}},
    {"PLASTICITY_WITH_DAMAGE", 81, kIsotropic},
    {"PLASTICITY_WITH_DAMAGE_ORTHO", 82, kIsotropic},
    {"FU_CHANG_FOAM", 83, {2, 3, 0, true}},
    {"PLASTICITY_POLYMER", 89, kIsotropic},
    {"SIMPLIFIED_JOHNSON_COOK", 98, kIsotropic},
    {"SPOTWELD", 100, kIsotropic},
    {"ANISOTROPIC_VISCOPLASTIC", 103, kIsotropic},
    {"DAMAGE_1", 104, kIsotropic},
    {"DAMAGE_2", 105, kIsotropic},
    {"ELASTIC_VISCOPLASTIC_THERMAL", 106, kIsotropic},
    {"MODIFIED_JOHNSON_COOK", 107, kIsotropic},
    {"GURSON", 120, kIsotropic},
    {"HILL_3R", 122, kIsotropic},
    {"MODIFIED_PIECEWISE_LINEAR_PLASTICITY", 123, kIsotropic},
    {"PLASTICITY_COMPRESSION_TENSION", 124, kIsotropic},
    {"KINEMATIC_HARDENING_TRANSVERSELY_ANISOTROPIC", 125, kIsotropic},
    {"MODIFIED_HONEYCOMB", 126, kIsotropic},
    {"BARLAT_YLD2000", 133, kIsotropic},
    {"VACUUM", 140, {2, 0, 0, false}},
    {"SAMP-1", 187, {2, 5, 6, true}},
    {"RIGID_DISCRETE", 220, {2, 3, 4, false}},
    {"TABULATED_JOHNSON_COOK", 224, kIsotropic},
    {"SEATBELT", -1, kNoDensity},
};

bool starts_with(std::string_view text, std::string_view start) { return text.substr(0, start.size()) == start; }

/// "024" -> 24; -1 where it isn't a number.
int number_of(std::string_view text) {
  if (text.empty() || text.size() > 3) return -1;
  int number = 0;
  for (const char c : text) {
    if (c < '0' || c > '9') return -1;
    number = number * 10 + (c - '0');
  }
  return number;
}

}  // namespace

MaterialFields material_fields(std::string_view keyword) {
  keyword.remove_prefix(std::min<std::size_t>(4, keyword.size()));
  constexpr std::string_view kTitle = "_TITLE";
  if (keyword.size() > kTitle.size() && keyword.substr(keyword.size() - kTitle.size()) == kTitle) keyword.remove_suffix(kTitle.size());
  // Springs and dampers have a stiffness where the others have a density.
  for (const std::string_view other : {"SPRING", "DAMPER", "S0", "S1", "THERMAL", "T0", "T1"})
    if (starts_with(keyword, other)) return kNoDensity;
  const int number = number_of(keyword.substr(0, keyword.find('_')));
  const KnownMaterial* best = nullptr;
  for (const KnownMaterial& known : kMaterials) {
    // An option may follow the name ("FABRIC_MAP", "PIECEWISE_LINEAR_PLASTICITY_LOG_INTERPOLATION"): the longest name wins.
    const bool named = starts_with(keyword, known.name) && (keyword.size() == known.name.size() || keyword[known.name.size()] == '_');
    if ((named && (!best || best->name.size() < known.name.size())) || (number >= 0 && number == known.number)) best = &known;
  }
  return best ? best->fields : MaterialFields{};
}

}  // namespace prismesh::mesh::deck::lsdyna
