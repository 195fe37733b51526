#include "mesh/deck/radioss/definitions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::radioss {
namespace {

struct Law {
  std::string_view name;
  std::string_view word;
  MaterialFields fields;
};
// A number takes two fields: Young's modulus in the first number is field 1, Poisson's ratio in the second is field 3.
constexpr MaterialFields kIsotropic{2, 1, 3, true};
constexpr MaterialFields kOrthotropic{2, 1, 5, true};
constexpr MaterialFields kModulusOnly{2, 1, 0, true};
constexpr std::array<Law, 40> kLaws = {{
    {"LAW0", "VOID", {1, 3, 5, false}},
    {"LAW1", "ELAST", kIsotropic},
    {"LAW2", "PLAS_JOHNS", kIsotropic},
    {"LAW2", "PLAS_ZERIL", kIsotropic},
    {"LAW3", "HYDPLA", kIsotropic},
    {"LAW4", "HYD_JCOOK", kIsotropic},
    {"LAW13", "RIGID", {2, 1, 3, false}},
    {"LAW15", "CHANG", kOrthotropic},
    {"LAW19", "FABRI", kOrthotropic},
    {"LAW22", "DAMA", kIsotropic},
    {"LAW23", "PLAS_DAMA", kIsotropic},
    {"LAW25", "COMPSH", kOrthotropic},
    {"LAW27", "PLAS_BRIT", kIsotropic},
    {"LAW32", "HILL", kIsotropic},
    {"LAW33", "FOAM_PLAS", kModulusOnly},
    {"LAW35", "FOAM_VISC", kIsotropic},
    {"LAW36", "PLAS_TAB", kIsotropic},
    {"LAW43", "HILL_TAB", kIsotropic},
    {"LAW44", "COWPER", kIsotropic},
    {"LAW48", "ZHAO", kIsotropic},
    {"LAW49", "STEINB", kIsotropic},
    {"LAW52", "GURSON", kIsotropic},
    {"LAW57", "BARLAT3", kIsotropic},
    {"LAW60", "PLAS_T3", kIsotropic},
    {"LAW63", "HANSEL", kIsotropic},
    {"LAW64", "UGINE_ALZ", kIsotropic},
    {"LAW65", "ELASTOMER", kIsotropic},
    {"LAW66", "", kIsotropic},
    {"LAW70", "FOAM_TAB", kIsotropic},
    {"LAW71", "", kIsotropic},
    {"LAW72", "HILL_MMC", kIsotropic},
    {"LAW73", "THERM_HILL", kIsotropic},
    {"LAW74", "THERM_HILL_3D", kIsotropic},
    {"LAW76", "SAMP", kIsotropic},
    {"LAW78", "", kIsotropic},
    {"LAW80", "", kIsotropic},
    {"LAW84", "SWIFT_VOCE", kIsotropic},
    {"LAW87", "BARLAT2000", kIsotropic},
    {"LAW93", "ORTH_HILL", {0, 0, 0, true}},
    {"LAW109", "", kIsotropic},
}};

/// The card and the field, from 1, of the thickness on shell properties.
struct ThicknessPlace {
  std::string_view type;
  std::string_view word;
  int card;
  int field;
};
constexpr std::array<ThicknessPlace, 7> kThicknessPlaces = {{{"TYPE0", "VOID", 1, 1},
                                                             {"TYPE1", "SHELL", 3, 3},
                                                             {"TYPE9", "SH_ORTH", 3, 3},
                                                             {"TYPE10", "SH_COMP", 3, 3},
                                                             {"TYPE11", "SH_SANDW", 3, 3},
                                                             {"TYPE16", "SH_FABR", 3, 3},
                                                             {"TYPE19", "PLY", 1, 3}}};

/// Reads a block's title, then its cards one after the other.
class Cards {
 public:
  Cards(const Block& block, const DeckTables& tables)
      : tables_(tables), block_(block), lines_(tables.files, block), width_(tables.contexts[block.context].field_width()) {}

  std::string title() {
    Line line;
    return lines_.next(line) ? std::string(trim(line.text)) : std::string();
  }
  bool next() { return lines_.next(line_); }
  std::optional<double> real(int from_one) const { return tables_.parameters.real(text(from_one), tables_.contexts, block_.context); }
  /// Adds to `bad` if the field is no number. An undefined parameter is reported where it is defined.
  void check(int from_one, const char* what, std::vector<BadField>& bad) const {
    if (!real(from_one) && text(from_one).find('&') == std::string_view::npos)
      bad.push_back({line_.file, line_.offset, "expected the " + std::string(what) + " but found " + quoted(trim(text(from_one)))});
  }
  std::optional<double> positive(int from_one) const {
    const std::optional<double> value = real(from_one);
    return value && *value > 0 ? value : std::nullopt;
  }
  std::optional<std::int64_t> id(int from_one, std::int64_t added) const {
    const std::optional<std::int64_t> value =
        tables_.parameters.integer(field(line_.text, width_, static_cast<std::size_t>(from_one - 1)), tables_.contexts, block_.context);
    return value && *value > 0 ? std::optional(*value + added) : std::nullopt;
  }

 private:
  std::string_view text(int from_one) const { return field(line_.text, width_, static_cast<std::size_t>(from_one - 1), 2); }

  const DeckTables& tables_;
  const Block& block_;
  BlockLines lines_;
  std::size_t width_;
  Line line_;
};

/// Converts to other units. nullopt: the result isn't finite; a deck may define any units.
std::optional<double> converted(std::optional<double> value, double factor) {
  if (value) *value *= factor;
  return value && std::isfinite(*value) ? value : std::nullopt;
}

}  // namespace

MaterialFields material_fields(std::string_view law) {
  for (const Law& known : kLaws)
    if (law == known.name || (!known.word.empty() && law == known.word)) return known.fields;
  // Gases of airbags and mixtures of other materials begin with something else. A user's law may as well.
  for (const std::string_view other :
       {"GAS", "LAW20", "BIMAT", "LAW51", "MULTIMAT", "MULTIFLUID", "LAW151", "B-K-EPS", "LAW29", "LAW30", "LAW31"})
    if (law == other || law.starts_with("USER")) return {0, 0, 0, true, false};
  return {0, 0, 0, true};
}

std::optional<Units> DeckTables::units(std::uint32_t context, std::int64_t system) const {
  if (system > 0) return systems.find(contexts, context, system);
  for (;;) {
    const Context& at = contexts[context];
    if (at.units) return at.units;
    if (at.unit > 0) return systems.find(contexts, context, at.unit);
    if (at.parent == context) return Units();
    context = at.parent;
  }
}

bool Definitions::read(const Block& block, const Keyword& keyword, const DeckTables& tables) {
  if (keyword.number(0) <= 0) return false;
  if (keyword.word(0) == "PART")
    read_part(block, keyword, tables);
  else if (keyword.word(0) == "PROP")
    read_property(block, keyword, tables);
  else if (keyword.word(0) == "MAT")
    read_material(block, keyword, tables);
  else
    return false;
  return true;
}

void Definitions::read_part(const Block& block, const Keyword& keyword, const DeckTables& tables) {
  const IdOffsets& added = tables.contexts[block.context].added;
  Cards cards(block, tables);
  Part part;
  part.id = keyword.number(0) + added.part;
  part.defined = true;
  part.name = cards.title();
  if (cards.next()) {
    part.section = cards.id(1, added.other);
    part.material = cards.id(2, added.material);
  }
  parts_.try_emplace(part.id, std::move(part));
}

void Definitions::read_property(const Block& block, const Keyword& keyword, const DeckTables& tables) {
  const auto place = std::find_if(kThicknessPlaces.begin(), kThicknessPlaces.end(), [&](const ThicknessPlace& known) {
    return keyword.word(1) == known.type || keyword.word(1) == known.word;
  });
  const std::optional<Units> units = tables.units(block.context, keyword.number(1));
  const std::optional<Units> main = tables.units(0, 0);
  if (place == kThicknessPlaces.end() || !units || !main) return;
  Cards cards(block, tables);
  cards.title();
  for (int card = 0; card < place->card; ++card)
    if (!cards.next()) return;
  cards.check(place->field, "thickness of a /PROP", bad_fields_);
  if (const std::optional<double> thickness = converted(cards.positive(place->field), units->length / main->length))
    thickness_.try_emplace(keyword.number(0) + tables.contexts[block.context].added.other, *thickness);
}

void Definitions::read_material(const Block& block, const Keyword& keyword, const DeckTables& tables) {
  const MaterialFields fields = material_fields(keyword.word(1));
  Material material;
  material.limits_time_step = fields.limits_time_step;
  const std::optional<Units> units = tables.units(block.context, keyword.number(1));
  const std::optional<Units> main = tables.units(0, 0);
  Cards cards(block, tables);
  cards.title();
  if (units && main && cards.next()) {
    const double mass = units->mass / main->mass;
    const double length = units->length / main->length;
    const double time = units->time / main->time;
    if (fields.has_density) {
      cards.check(1, "density of a /MAT", bad_fields_);
      material.density = converted(cards.positive(1), mass / (length * length * length));
    }
    if (fields.youngs_modulus > 0 && (fields.card == 1 || cards.next())) {
      cards.check(fields.youngs_modulus, "modulus of a /MAT", bad_fields_);
      if (fields.poissons_ratio > 0) cards.check(fields.poissons_ratio, "Poisson's ratio of a /MAT", bad_fields_);
      material.youngs_modulus = converted(cards.positive(fields.youngs_modulus), mass / (length * time * time));
      if (material.youngs_modulus && fields.poissons_ratio > 0) material.poissons_ratio = cards.real(fields.poissons_ratio);
    }
  }
  materials_.try_emplace(keyword.number(0) + tables.contexts[block.context].added.material, material);
}

std::vector<Part> Definitions::parts() const {
  std::vector<Part> out;
  for (const auto& [id, defined] : parts_) {
    Part part = defined;
    if (part.section)
      if (const auto thickness = thickness_.find(*part.section); thickness != thickness_.end()) part.thickness = thickness->second;
    if (part.material)
      if (const auto material = materials_.find(*part.material); material != materials_.end()) {
        part.density = material->second.density;
        part.youngs_modulus = material->second.youngs_modulus;
        part.poissons_ratio = material->second.poissons_ratio;
        part.limits_time_step = material->second.limits_time_step;
      }
    out.push_back(std::move(part));
  }
  return out;
}

}  // namespace prismesh::mesh::deck::radioss
