#include "mesh/deck/abaqus/materials.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::abaqus {
namespace {

/// Keywords that give the elements of ELSET= their properties.
constexpr std::string_view kSections[] = {
    "ACOUSTIC WAVE FORMULATION",
    "BEAM GENERAL SECTION",
    "BEAM SECTION",
    "COHESIVE SECTION",
    "CONNECTOR SECTION",
    "DASHPOT",
    "DISCRETE SECTION",
    "EULERIAN SECTION",
    "FLUID SECTION",
    "FRAME SECTION",
    "GAP",
    "GASKET SECTION",
    "HEATCAP",
    "JOINT",
    "MASS",
    "MEMBRANE SECTION",
    "PARTICLE SECTION",
    "ROTARY INERTIA",
    "SHELL GENERAL SECTION",
    "SHELL SECTION",
    "SOLID SECTION",
    "SPRING",
    "SURFACE SECTION",
    "TRUSS SECTION",
    "USER ELEMENT PROPERTY",
};

struct Material {
  std::int64_t number = 0;
  std::optional<double> density, youngs_modulus, poissons_ratio;
};

class Reader {
 public:
  explicit Reader(const DeckOutline& outline) : outline_(outline) {}

  std::vector<Section> run() {
    read_materials();
    std::vector<Section> out;
    for (const KeptBlock& kept : outline_.kept) {
      const std::string& word = outline_.words[kept.word];
      if (!std::binary_search(std::begin(kSections), std::end(kSections), word)) continue;
      const Parameters given = outline_.parameters(kept.block);
      const auto elset = given.value("ELSET");
      if (!elset || elset->empty()) continue;
      out.push_back({kept.block.scope, std::string(*elset), {}, 0});
      Part& part = out.back().part;
      part.section = static_cast<std::int64_t>(out.size());
      read_material_of(given, part);
      read_thickness(word, kept.block, given, part);
      if (word == "SHELL SECTION" || word == "SHELL GENERAL SECTION") out.back().offset = offset_of(given);
      part.limits_time_step = !rigid_.contains({kept.block.scope, label(*elset)});
    }
    return out;
  }

 private:
  /// The first data lines, up to `max` of them.
  std::vector<std::string_view> lines_of(const Block& block, std::size_t max) const {
    std::vector<std::string_view> out;
    for (std::uint32_t s = 0; s < block.segments && out.size() < max; ++s) {
      const Segment& where = outline_.segments[block.first_segment + s];
      DataLines lines(outline_.text(where.file), where.begin, where.end);
      for (DataLine line; out.size() < max && lines.next(line);) out.push_back(line.text);
    }
    return out;
  }

  std::optional<double> number(std::string_view field) const {
    double value = 0;
    if (field.empty()) return std::nullopt;
    if (field.size() > 2 && field.front() == '<' && field.back() == '>') {
      const auto at = outline_.values.find(trim(field.substr(1, field.size() - 2)));
      return at == outline_.values.end() ? std::nullopt : std::optional(at->second);
    }
    return parse_real(field, value) ? std::optional(value) : std::nullopt;
  }

  void read_materials() {
    Material* material = nullptr;
    for (const KeptBlock& kept : outline_.kept) {
      const std::string& word = outline_.words[kept.word];
      if (word == "MATERIAL") {
        const auto [at, added] = materials_.try_emplace(label(outline_.parameters(kept.block).value("NAME").value_or("")));
        material = added ? &at->second : nullptr;
        if (added) material->number = static_cast<std::int64_t>(materials_.size());
      } else if (word == "RIGID BODY") {
        if (const auto elset = outline_.parameters(kept.block).value("ELSET")) rigid_.insert({kept.block.scope, label(*elset)});
      } else if (material && word == "DENSITY") {
        if (const auto lines = lines_of(kept.block, 1); !lines.empty()) material->density = number(first_fields<1>(lines[0])[0]);
      } else if (material && word == "ELASTIC") {
        read_elastic(kept.block, *material);
      }
    }
  }

  void read_elastic(const Block& block, Material& material) const {
    const auto lines = lines_of(block, 1);
    if (lines.empty()) return;
    const std::string type = label(outline_.parameters(block).value("TYPE").value_or("ISOTROPIC"));
    const auto fields = first_fields<4>(lines[0]);
    const auto stiffest = [&](std::size_t count) {
      std::optional<double> max;
      for (std::size_t i = 0; i < count; ++i)
        if (const auto value = number(fields[i]); value && (!max || *value > *max)) max = value;
      return max;
    };
    // ORTHOTROPIC and ANISOTROPIC give stiffness terms and no modulus: it stays unknown. Of several directions the stiffest counts, since
    // it limits the time step.
    if (type.substr(0, 3) == "ISO") {
      material.youngs_modulus = number(fields[0]);
      material.poissons_ratio = number(fields[1]);
    } else if (type.substr(0, 3) == "LAM") {
      material.youngs_modulus = stiffest(2);
      material.poissons_ratio = number(fields[2]);
    } else if (type.substr(0, 3) == "ENG") {
      material.youngs_modulus = stiffest(3);
      material.poissons_ratio = number(fields[3]);
    }
  }

  void read_material_of(const Parameters& given, Part& part) const {
    const auto name = given.value("MATERIAL");
    if (!name) return;
    const auto at = materials_.find(label(*name));
    if (at == materials_.end()) return;
    part.material = at->second.number;
    part.density = at->second.density;
    part.youngs_modulus = at->second.youngs_modulus;
    part.poissons_ratio = at->second.poissons_ratio;
  }

  /// OFFSET is how far the nodes lie from the middle, so the middle lies on the other side. That of a distribution isn't read.
  double offset_of(const Parameters& given) const {
    const std::string value = label(given.value("OFFSET").value_or(""));
    if (value == "SPOS") return -0.5;
    if (value == "SNEG") return 0.5;
    const double fraction = number(value).value_or(0);
    return std::isfinite(fraction) && fraction != 0 ? -fraction : 0;
  }

  void read_thickness(std::string_view word, const Block& block, const Parameters& given, Part& part) const {
    const bool shell = word == "SHELL SECTION" || word == "SHELL GENERAL SECTION";
    if (!shell && word != "MEMBRANE SECTION") return;
    // With these parameters the thickness comes from nodes or from a distribution.
    if (given.has("NODALTHICKNESS") || given.has("SHELLTHICKNESS")) return;
    if (given.has("COMPOSITE")) {
      constexpr std::size_t kMaxLayers = 100000;
      double sum = 0;
      for (const std::string_view line : lines_of(block, kMaxLayers)) {
        const auto [thickness, points, material] = first_fields<3>(line);
        sum += number(thickness).value_or(0);
        if (!part.material) take_layer_material(material, part);
      }
      if (sum > 0) part.thickness = sum;
      return;
    }
    // Without a material the lines of a general section are its stiffness.
    if (word == "SHELL GENERAL SECTION" && !given.has("MATERIAL")) return;
    if (const auto lines = lines_of(block, 1); !lines.empty()) part.thickness = number(first_fields<1>(lines[0])[0]);
  }

  /// The material of the first layer.
  void take_layer_material(std::string_view name, Part& part) const {
    const auto at = materials_.find(label(name));
    if (at == materials_.end()) return;
    part.material = at->second.number;
    part.density = at->second.density;
    part.youngs_modulus = at->second.youngs_modulus;
    part.poissons_ratio = at->second.poissons_ratio;
  }

  const DeckOutline& outline_;
  std::map<std::string, Material, std::less<>> materials_;
  std::set<std::pair<std::uint32_t, std::string>> rigid_;
};

}  // namespace

std::vector<Section> sections(const DeckOutline& outline) { return Reader(outline).run(); }

ContactCards section_offsets(const DeckOutline& outline) {
  ContactCards cards;
  for (const Section& section : sections(outline))
    if (section.offset != 0) cards.offset_of_section.try_emplace(*section.part.section, section.offset);
  if (!cards.offset_of_section.empty()) cards.offsets = ContactOffsets::of_every_shell;
  return cards;
}

}  // namespace prismesh::mesh::deck::abaqus
