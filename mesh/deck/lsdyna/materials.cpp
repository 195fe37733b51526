// Fields of E, nu and the density on the cards of common materials (LS-DYNA keyword manual, volume II).
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
constexpr MaterialFields kModulusOnly = {2, 3, 0, true};
constexpr MaterialFields kDensityOnly = {2, 0, 0, true};
constexpr MaterialFields kNoDensity = {0, 0, 0, true};

/// The longest name that a keyword begins with counts, then its number; -1: it has a name only.
constexpr KnownMaterial kMaterials[] = {
    {"ELASTIC", 1, kIsotropic},
    {"ORTHOTROPIC_ELASTIC", 2, kOrthotropic},
    {"2_ANIS", -1, kDensityOnly},
    {"002_ANIS", -1, kDensityOnly},
    {"PLASTIC_KINEMATIC", 3, kIsotropic},
    {"ELASTIC_PLASTIC_THERMAL", 4, kDensityOnly},
    {"NULL", 9, {2, 7, 8, false}},
    {"ELASTIC_PLASTIC_HYDRO", 10, kDensityOnly},
    {"JOHNSON_COOK", 15, {2, 4, 5, true}},
    {"POWER_LAW_PLASTICITY", 18, kIsotropic},
    {"STRAIN_RATE_DEPENDENT_PLASTICITY", 19, kIsotropic},
    {"RIGID", 20, {2, 3, 4, false}},
    {"COMPOSITE_DAMAGE", 22, kOrthotropic},
    {"PIECEWISE_LINEAR_PLASTICITY", 24, kIsotropic},
    {"HONEYCOMB", 26, kIsotropic},
    {"RESULTANT_PLASTICITY", 28, kIsotropic},
    {"FORCE_LIMITED", 29, kIsotropic},
    {"SHAPE_MEMORY", 30, kIsotropic},
    {"LAMINATED_GLASS", 32, kIsotropic},
    {"BARLAT_ANISOTROPIC_PLASTICITY", 33, kIsotropic},
    {"FABRIC", 34, kOrthotropic},
    {"3-PARAMETER_BARLAT", 36, kIsotropic},
    {"EXTENDED_3-PARAMETER_BARLAT", -1, kIsotropic},
    {"036E", -1, kIsotropic},
    {"TRANSVERSELY_ANISOTROPIC_ELASTIC_PLASTIC", 37, kIsotropic},
    {"FLD_TRANSVERSELY_ANISOTROPIC", 39, kIsotropic},
    {"NONLINEAR_ORTHOTROPIC", 40, kOrthotropic},
    {"BAMMAN", 51, kIsotropic},
    {"BAMMAN_DAMAGE", 52, kIsotropic},
    {"CLOSED_CELL_FOAM", 53, kModulusOnly},
    {"ENHANCED_COMPOSITE_DAMAGE", 54, kOrthotropic},
    {"ENHANCED_COMPOSITE_DAMAGE", 55, kOrthotropic},
    {"LOW_DENSITY_FOAM", 57, kModulusOnly},
    {"LAMINATED_COMPOSITE_FABRIC", 58, kOrthotropic},
    {"COMPOSITE_FAILURE_SHELL_MODEL", 59, kOrthotropic},
    {"COMPOSITE_FAILURE_SOLID_MODEL", -1, kOrthotropic},
    {"ELASTIC_WITH_VISCOSITY", 60, kDensityOnly},
    {"VISCOUS_FOAM", 62, {2, 3, 8, true}},
    {"CRUSHABLE_FOAM", 63, kIsotropic},
    {"RATE_SENSITIVE_POWERLAW_PLASTICITY", 64, kIsotropic},
    {"CABLE_DISCRETE_BEAM", 71, kModulusOnly},
    {"LOW_DENSITY_VISCOUS_FOAM", 73, kModulusOnly},
    {"ELASTIC_SPRING_DISCRETE_BEAM", 74, kDensityOnly},
    {"BILKHU/DUBOIS_FOAM", 75, kModulusOnly},
    {"PLASTICITY_WITH_DAMAGE", 81, kIsotropic},
    {"PLASTICITY_WITH_DAMAGE_ORTHO", 82, kIsotropic},
    {"FU_CHANG_FOAM", 83, kModulusOnly},
    {"PLASTICITY_POLYMER", 89, kIsotropic},
    {"ELASTIC_6DOF_SPRING_DISCRETE_BEAM", 93, kDensityOnly},
    {"BRITTLE_DAMAGE", 96, kIsotropic},
    {"SIMPLIFIED_JOHNSON_COOK", 98, kIsotropic},
    {"SIMPLIFIED_JOHNSON_COOK_ORTHOTROPIC_DAMAGE", 99, kIsotropic},
    {"SPOTWELD", 100, kIsotropic},
    {"GEPLASTIC_SRATE_2000A", 101, kIsotropic},
    {"INV_HYPERBOLIC_SIN", 102, kIsotropic},
    {"ANISOTROPIC_VISCOPLASTIC", 103, kIsotropic},
    {"DAMAGE_1", 104, kIsotropic},
    {"DAMAGE_2", 105, kIsotropic},
    {"ELASTIC_VISCOPLASTIC_THERMAL", 106, kIsotropic},
    {"MODIFIED_JOHNSON_COOK", 107, kIsotropic},
    {"FINITE_ELASTIC_STRAIN_PLASTICITY", 112, kIsotropic},
    {"TRIP", 113, kIsotropic},
    {"LAYERED_LINEAR_PLASTICITY", 114, kIsotropic},
    {"UNIFIED_CREEP", 115, kIsotropic},
    {"COMPOSITE_LAYUP", 116, kOrthotropic},
    {"GURSON", 120, kIsotropic},
    {"HILL_3R", 122, kIsotropic},
    {"HILL_3R_3D", -1, kOrthotropic},
    {"122_3D", -1, kOrthotropic},
    {"MODIFIED_PIECEWISE_LINEAR_PLASTICITY", 123, kIsotropic},
    {"PLASTICITY_COMPRESSION_TENSION", 124, kIsotropic},
    {"KINEMATIC_HARDENING_TRANSVERSELY_ANISOTROPIC", 125, kIsotropic},
    {"MODIFIED_HONEYCOMB", 126, kIsotropic},
    {"ISOTROPIC_SMEARED_CRACK", 131, kIsotropic},
    {"BARLAT_YLD2000", 133, kIsotropic},
    {"MODIFIED_FORCE_LIMITED", 139, kIsotropic},
    {"VACUUM", 140, {2, 0, 0, false}},
    {"RATE_SENSITIVE_POLYMER", 141, kIsotropic},
    {"DAMAGE_3", 153, kIsotropic},
    {"DESHPANDE_FLECK_FOAM", 154, kIsotropic},
    {"PLASTICITY_COMPRESSION_TENSION_EOS", 155, kIsotropic},
    {"RATE_SENSITIVE_COMPOSITE_FABRIC", 158, kOrthotropic},
    {"COMPOSITE_MSC", 161, kOrthotropic},
    {"COMPOSITE_MSC_DMG", 162, kOrthotropic},
    {"MODIFIED_CRUSHABLE_FOAM", 163, kIsotropic},
    {"PLASTIC_NONLINEAR_KINEMATIC", 165, kIsotropic},
    {"POLYMER", 168, kIsotropic},
    {"ARUP_ADHESIVE", 169, kIsotropic},
    {"LOW_DENSITY_SYNTHETIC_FOAM", 179, kModulusOnly},
    {"SAMP-1", 187, {2, 5, 6, true}},
    {"FLD_3-PARAMETER_BARLAT", 190, kIsotropic},
    {"RIGID_DISCRETE", 220, {2, 3, 4, false}},
    {"TABULATED_JOHNSON_COOK", 224, kIsotropic},
    {"VISCOPLASTIC_MIXED_HARDENING", 225, kIsotropic},
    {"KINEMATIC_HARDENING_BARLAT89", 226, kIsotropic},
    {"CAZACU_BARLAT", 233, kIsotropic},
    {"KINEMATIC_HARDENING_BARLAT2000", 242, kIsotropic},
    {"HILL_90", 243, kIsotropic},
    {"UHS_STEEL", 244, kIsotropic},
    {"TAILORED_PROPERTIES", 251, kIsotropic},
    {"TOUGHENED_ADHESIVE_POLYMER", 252, kIsotropic},
    {"PIECEWISE_LINEAR_PLASTIC_THERMAL", 255, kIsotropic},
    {"NON_QUADRATIC_FAILURE", 258, kIsotropic},
    {"LAMINATED_FRACTURE_DAIMLER_PINHO", 261, kOrthotropic},
    {"LAMINATED_FRACTURE_DAIMLER_CAMANHO", 262, kOrthotropic},
    {"CONCRETE_DAMAGE_PLASTIC_MODEL", 273, kIsotropic},
    {"GLASS", 280, kIsotropic},
    {"ELASTIC_PERI", 292, kModulusOnly},
    {"SEATBELT", -1, kNoDensity},
};

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
  // Springs and dampers have a stiffness in the field where others have the density.
  for (const std::string_view other : {"SPRING", "DAMPER", "S0", "S1", "B0", "THERMAL", "T0", "T1"})
    if (keyword.starts_with(other)) return kNoDensity;
  const int number = number_of(keyword.substr(0, keyword.find('_')));
  const KnownMaterial* best = nullptr;
  const KnownMaterial* numbered = nullptr;
  for (const KnownMaterial& known : kMaterials) {
    // An option may follow the name ("FABRIC_MAP", "PIECEWISE_LINEAR_PLASTICITY_LOG_INTERPOLATION"): the longest name counts.
    const bool named = keyword.starts_with(known.name) && (keyword.size() == known.name.size() || keyword[known.name.size()] == '_');
    if (named && (!best || best->name.size() < known.name.size())) best = &known;
    if (number >= 0 && number == known.number) numbered = &known;
  }
  if (!best) best = numbered;
  return best ? best->fields : MaterialFields{};
}

}  // namespace prismesh::mesh::deck::lsdyna
