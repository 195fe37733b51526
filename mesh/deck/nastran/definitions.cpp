#include "mesh/deck/nastran/definitions.h"

#include <algorithm>

#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::nastran {
namespace {

/// Entries that define properties of elements. A card may define several: PELAS two.
struct PropertyForm {
  std::string_view name;
  PropertyFamily family;
  std::uint8_t every = 0;     ///< data fields from one property to the next on a card; 0: one a card
  std::uint8_t material = 0;  ///< data field; 0: none
  std::uint8_t thickness = 0;
};

using Family = PropertyFamily;

constexpr PropertyForm kPropertyForms[] = {
    {"PSHELL", Family::shell, 0, 1, 2},
    {"PCOMP", Family::shell},
    {"PCOMPG", Family::shell},
    {"PCOMPP", Family::shell},
    {"PSHEAR", Family::shear, 0, 1, 2},
    {"PSOLID", Family::solid, 0, 1},
    {"PLSOLID", Family::solid, 0, 1},
    {"PCOMPS", Family::solid},
    {"PLPLANE", Family::plane, 0, 1},
    {"PPLANE", Family::plane, 0, 1, 2},
    {"PBAR", Family::bar, 0, 1},
    {"PBARL", Family::bar, 0, 1},
    {"PBRSECT", Family::bar, 0, 1},
    {"PBEAM", Family::beam, 0, 1},
    {"PBEAML", Family::beam, 0, 1},
    {"PBCOMP", Family::beam, 0, 1},
    {"PBMSECT", Family::beam, 0, 1},
    {"PBEND", Family::bend, 0, 1},
    {"PBEAM3", Family::beam3, 0, 1},
    {"PROD", Family::rod, 0, 1},
    {"PTUBE", Family::tube, 0, 1},
    {"PBUSH", Family::bush},
    {"PBUSH1D", Family::bush1d},
    {"PBUSH2D", Family::bush2d},
    {"PELAS", Family::spring, 4},
    {"PDAMP", Family::damper, 2},
    {"PDAMP5", Family::damper},
    {"PMASS", Family::mass, 2},
    {"PVISC", Family::viscous, 4},
    {"PGAP", Family::gap},
    {"PWELD", Family::weld, 0, 1},
    {"PFAST", Family::weld},
    {"PSEAM", Family::weld, 0, 1},
    {"PCONT", Family::contact},
    {"PAXI", Family::axisymmetric, 0, 1},
    {"PTRIX", Family::axisymmetric, 0, 1},
};

/// Entries that complete a property with the same number and name nothing else: tables of stiffness and damping, nonlinear behaviour.
constexpr std::string_view kCompanions[] = {"PBUSHT", "PELAST", "PDAMPT", "PSHLN1", "PSHLN2", "PSLDN1", "PBARN1", "PBEMN1", "PRODN1"};

bool is_companion(std::string_view name) {
  return std::find(std::begin(kCompanions), std::end(kCompanions), name) != std::end(kCompanions);
}

const PropertyForm* form_of(std::string_view name) {
  const auto at =
      std::find_if(std::begin(kPropertyForms), std::end(kPropertyForms), [&](const PropertyForm& form) { return form.name == name; });
  return at == std::end(kPropertyForms) ? nullptr : &*at;
}

std::optional<double> given(const Card& card, std::size_t field) { return card.blank(field) ? std::nullopt : card.real(field); }

/// PCOMP: four fields a ply from the second line on; PCOMPG: a line each, an id first. A blank material or thickness is that of the ply
/// before.
std::vector<Ply> plies_of(const Card& card) {
  const bool global = card.name() == "PCOMPG";
  const std::size_t every = global ? 8 : 4;
  std::vector<Ply> plies;
  Ply ply;
  for (std::size_t first = 8; first < card.size(); first += every) {
    const std::size_t f = first + (global ? 1 : 0);
    if (card.blank(f) && card.blank(f + 1) && card.blank(f + 2) && card.blank(f + 3)) continue;
    if (!card.blank(f)) ply.material = card.integer_or_zero(f);
    const std::optional<double> thickness = card.real(f + 1);
    if (!thickness || !card.integer(f)) return {};
    if (!card.blank(f + 1)) ply.thickness = *thickness;
    plies.push_back(ply);
  }
  return plies;
}

double thickness_of(const std::vector<Ply>& plies) {
  double sum = 0;
  for (const Ply& ply : plies) sum += ply.thickness;
  return sum;
}

struct NumberField {
  std::size_t field = 0;
  const char* what = "";
  bool is_whole = false;
};

/// The fields of a property or material that are read as numbers.
std::vector<NumberField> number_fields(const Card& card) {
  const std::string_view name = card.name();
  std::vector<NumberField> fields{{0, "id", true}};
  const auto add = [&](std::initializer_list<NumberField> more) { fields.insert(fields.end(), more); };
  if (name == "MAT1") {
    add({{1, "modulus", false}, {2, "shear modulus", false}, {3, "Poisson's ratio", false}, {4, "density", false}});
  } else if (name == "MAT2") {
    add({{1, "stiffness", false}, {2, "stiffness", false}, {4, "stiffness", false}, {7, "density", false}});
  } else if (name == "MAT8") {
    add({{7, "density", false}});
  } else if (name == "MAT9") {
    add({{22, "density", false}});
  } else if (const PropertyForm* form = form_of(name)) {
    if (form->material) add({{form->material, "material", true}});
    if (form->thickness) add({{form->thickness, "thickness", false}});
    const std::size_t id_fields = name == "PCOMPG" ? 1 : 0;
    if (name == "PCOMP" || name == "PCOMPG")
      for (std::size_t f = 8; f<card.size(); f += id_fields> 0 ? 8 : 4)
        add({{f + id_fields, "material of a ply", true}, {f + id_fields + 1, "thickness of a ply", false}});
  } else {
    return {};
  }
  return fields;
}

/// Completes E, G and nu: any two give the third.
void put_in_isotropic(const Card& card, Material& material) {
  const std::optional<double> e = given(card, 1), g = given(card, 2), nu = given(card, 3);
  material.youngs_modulus = e;
  material.poissons_ratio = nu;
  if (!e && g && nu) material.youngs_modulus = 2 * (1 + *nu) * *g;
  if (!nu && e && g && *g != 0) material.poissons_ratio = *e / (2 * *g) - 1;
  material.density = given(card, 4);
}

/// A plane-stress matrix is an isotropic one where both directions are alike.
void put_in_plane(const Card& card, Material& material) {
  const std::optional<double> g11 = given(card, 1), g12 = given(card, 2), g22 = given(card, 4);
  material.density = given(card, 7);
  if (!g11 || !g12 || !g22 || *g11 != *g22 || *g11 == 0) return;
  material.poissons_ratio = *g12 / *g11;
  material.youngs_modulus = *g11 * (1 - *material.poissons_ratio * *material.poissons_ratio);
}

bool read_material(const Card& card, std::vector<Material>& materials) {
  Material material;
  if (card.name() == "MAT1") {
    put_in_isotropic(card, material);
  } else if (card.name() == "MAT2") {
    put_in_plane(card, material);
  } else if (card.name() == "MAT8") {
    material.density = given(card, 7);
  } else if (card.name() == "MAT9") {
    material.density = given(card, 22);
  } else {
    return false;
  }
  material.id = card.integer_or_zero(0);
  if (material.id > 0) materials.push_back(material);
  return true;
}

/// A name in quotes, or up to `end`.
std::string name_in(std::string_view text) {
  text = trim(text);
  if (!text.empty() && text[0] == '"') text = text.substr(1, text.find('"', 1) - 1);
  return std::string(trim(text.substr(0, 200)));
}

/// Reads the number at the beginning of `text` and removes it from there.
std::int64_t take_number(std::string_view& text) {
  text = trim(text);
  const std::size_t end = std::min(text.find_first_not_of("0123456789"), text.size());
  std::int64_t value = 0;
  if (end == 0 || !parse_integer(text.substr(0, end), value)) return 0;
  text.remove_prefix(end);
  return value;
}

}  // namespace

std::optional<std::string> unread_number(const Card& card) {
  const std::string_view name = card.name();
  if (name.empty() || (name[0] != 'P' && name[0] != 'M')) return std::nullopt;
  for (const NumberField& field : number_fields(card))
    if (!(field.is_whole ? card.integer(field.field).has_value() : card.real(field.field).has_value()))
      return "expected the " + std::string(field.what) + " of " + std::string(name) + " " + std::string(card.text(0)) + " but found " +
             quoted(card.text(field.field));
  return std::nullopt;
}

bool Definitions::read(const Card& card, std::size_t offset) {
  const std::string_view name = card.name();
  if (name.empty() || (name[0] != 'P' && name[0] != 'M')) return false;
  if (name[0] == 'M') return read_material(card, materials);
  if (is_companion(name)) return true;
  const PropertyForm* form = form_of(name);
  if (!form) return false;
  for (std::size_t first = 0; first < std::max<std::size_t>(form->every ? std::min<std::size_t>(card.size(), 8) : 1, 1);
       first += std::max<std::size_t>(form->every, 1)) {
    Property property;
    property.id = card.integer_or_zero(first);
    property.family = form->family;
    property.offset = offset;
    if (property.id <= 0) continue;
    if (form->material && card.integer_or_zero(form->material) > 0) property.material = card.integer_or_zero(form->material);
    if (form->thickness) property.thickness = given(card, form->thickness);
    // A plate without a membrane material may still have one for bending.
    if (name == "PSHELL" && !property.material && card.integer_or_zero(3) > 0) property.material = card.integer_or_zero(3);
    if (name == "PCOMP" || name == "PCOMPG") {
      property.plies = plies_of(card);
      if (!property.plies.empty()) property.thickness = thickness_of(property.plies) * (begins_with(card.text(7), "SYM") ? 2 : 1);
    }
    property.name = std::exchange(next_name, {});
    properties.push_back(std::move(property));
  }
  return true;
}

void Definitions::read_comment(std::string_view line) {
  line = line.substr(0, 400);
  std::string_view rest;
  const auto after = [&](std::string_view start) {
    if (!begins_with(line, start)) return false;
    rest = line.substr(start.size());
    return true;
  };
  std::int64_t id = 0;
  if (after("$HMNAME PROP ")) {
    id = take_number(rest);
  } else if (after("$ FEMAP PROPERTY ")) {
    id = take_number(rest);
    const std::size_t colon = rest.find(':');
    rest = colon == std::string_view::npos ? std::string_view() : rest.substr(colon + 1);
  } else if (after("$ANSA_NAME_COMMENT;")) {
    id = take_number(rest);
    if (!begins_with(rest, ";P")) return;
    rest = rest.substr(std::min(rest.find(';', 1), rest.size() - 1) + 1);
    rest = rest.substr(0, rest.find(';'));
  } else if (after("$ ELEMENTS AND ELEMENT PROPERTIES FOR REGION :")) {
    next_name = name_in(rest);
  }
  if (id > 0 && names.size() < 1000000)
    if (std::string name = name_in(rest); !name.empty()) names.emplace_back(id, std::move(name));
}

bool PartTable::add(const Property& property) { return !properties_.try_emplace({property.id, property.family}, property).second; }

std::optional<double> PartTable::thickness_of(std::int64_t property) const {
  const auto at = properties_.lower_bound({property, PropertyFamily::shell});
  const bool is_of_shells = at != properties_.end() && at->first.first == property && at->first.second <= PropertyFamily::plane;
  return is_of_shells ? at->second.thickness : std::nullopt;
}

/// A laminate has the density of all its plies, and a stiffness only where all are of one isotropic material.
void PartTable::put_in(const Property& property, Part& part) const {
  const auto material_of = [&](std::int64_t id) {
    const auto at = materials_.find(id);
    return at == materials_.end() ? nullptr : &at->second;
  };
  part.material = property.material;
  if (!property.plies.empty()) {
    double mass = 0, thickness = 0;
    bool known = true;
    for (const Ply& ply : property.plies) {
      const Material* material = material_of(ply.material);
      known &= material && material->density;
      if (known) mass += *material->density * ply.thickness;
      thickness += ply.thickness;
    }
    if (known && thickness > 0) part.density = mass / thickness;
    const std::int64_t first = property.plies[0].material;
    if (std::any_of(property.plies.begin(), property.plies.end(), [&](const Ply& ply) { return ply.material != first; })) return;
    part.material = first;
  }
  if (!part.material) return;
  if (const Material* material = material_of(*part.material)) {
    part.density = material->density;
    part.youngs_modulus = material->youngs_modulus;
    part.poissons_ratio = material->poissons_ratio;
  }
}

std::vector<Part> PartTable::parts() const {
  std::vector<Part> out;
  for (const auto& [key, property] : properties_) {
    const std::int64_t id = key.first;
    if (!out.empty() && out.back().id == id) continue;
    Part part;
    part.id = id;
    part.defined = true;
    part.section = id;
    part.name = property.name;
    if (const auto name = names_.find(id); name != names_.end()) part.name = name->second;
    part.thickness = property.thickness;
    put_in(property, part);
    out.push_back(std::move(part));
  }
  return out;
}

}  // namespace prismesh::mesh::deck::nastran
