#include "mesh/deck/abaqus/part_cards.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <set>
#include <string_view>

#include "base/readable_number.h"
#include "mesh/deck/abaqus/element_writer.h"
#include "mesh/deck/abaqus/keyword.h"

namespace prismesh::mesh::deck::abaqus {
namespace {

/// Half a thickness is between a node on the middle surface and the shell's face; the rest is room for curved sheets.
constexpr double kReachInThicknesses = 0.6;

/// The shortest text that is read as the same number; it has a point or an exponent.
std::string number_words(double value) {
  std::array<char, 32> text{};
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value);
  std::string out(text.data(), end);
  return out.find_first_of(".e") == std::string::npos ? out + "." : out;
}

/// What the files name: sets, surfaces, materials and others, in capitals. Errors: nothing can be added in front of the first step.
Result<std::set<std::string>> names_of(const Deck& deck) {
  std::set<std::string> names;
  for (std::uint32_t file = 0; file < deck.files.size(); ++file) {
    const std::string_view text = deck.files[file].bytes.text();
    Keywords keywords(text);
    for (Keyword keyword; keywords.next(keyword);) {
      if (file > 0 && keyword.name == "STEP")
        return fail(deck.files[file].path.string(), "a *STEP stands in an include, so that nothing can be added in front of it");
      const Parameters given(text, keyword.begin, keyword.end);
      for (const std::string_view parameter : {"NAME", "ELSET", "NSET"})
        if (const std::optional<std::string> value = given.value(parameter)) names.insert(label(*value));
    }
  }
  return names;
}

/// The name and a number such that no other begins so. Ends with the part's id if it can.
std::string free_name(const std::string& word, std::int64_t part, const Model& model, std::set<std::string> names) {
  for (const Part& each : *model.parts) names.insert(label(each.name));
  for (std::int64_t number = part;; ++number) {
    std::string name = word + "-" + std::to_string(number);
    const auto next = names.lower_bound(name);
    if (next == names.end() || !next->starts_with(name)) return name;
  }
}

/// A part behind all others, with the next numbers. Errors: the deck can't take one.
Result<Part> next_part(const Deck& deck, const Model& model, const std::string& word) {
  if (has_instances(deck))
    return fail(deck.files[0].path.string(),
                "the deck is made of parts and instances: this version joins sheets whose nodes and elements stand outside of *PART");
  Result<std::set<std::string>> names = names_of(deck);
  if (!names) return fail(names.error());
  Part part;
  std::int64_t section = 0, material = 0;
  for (const Part& each : *model.parts) {
    part.id = std::max(part.id, each.id);
    section = std::max(section, each.section.value_or(0));
    material = std::max(material, each.material.value_or(0));
  }
  ++part.id;
  part.section = section + 1;
  part.material = material + 1;
  part.defined = true;
  part.name = free_name(word, part.id, model, std::move(*names));
  return part;
}

const Part& part_with(const Model& model, std::int64_t id) {
  return *std::find_if(model.parts->begin(), model.parts->end(), [&](const Part& part) { return part.id == id; });
}

/// The surface that is made of sides of the sheets. Errors: a part has no set; both sides of one are named.
Result<std::string> sheet_surface(const Model& model, const std::string& name, const std::vector<CardWriter::BondPart::SheetSide>& sides) {
  std::string cards = "*SURFACE, NAME=" + name + ", TYPE=ELEMENT\n";
  for (std::size_t s = 0; s < sides.size(); ++s) {
    const std::string words = "part:" + std::to_string(sides[s].part);
    if (s > 0 && sides[s].part == sides[s - 1].part)
      return fail("",
                  "shells of " + words +
                      " face the adhesive with different sides, and a surface that holds both can't be tied: their normals must point to "
                      "one side, and flanges on both sides of a part be bonded one by one");
    const Part& part = part_with(model, sides[s].part);
    if (part.name.empty()) return fail("", words + " has no element set that a surface could name");
    cards += quoted_name(part.name) + (sides[s].positive ? ", SPOS\n" : ", SNEG\n");
  }
  return cards;
}

}  // namespace

Result<std::pair<Part, std::string>> bond_part(const Deck& deck, const Model& model, const CardWriter::BondPart& wanted) {
  Result<Part> part = next_part(deck, model, "ADHESIVE");
  if (!part) return fail(part.error());
  part->density = wanted.density;
  part->youngs_modulus = wanted.youngs_modulus;
  part->poissons_ratio = wanted.poissons_ratio;
  const std::string& name = part->name;
  double thickness = 0;
  for (const std::int64_t sheet : wanted.sheets) thickness = std::max(thickness, part_with(model, sheet).thickness.value_or(0));
  const std::string reach = thickness > 0 ? ", POSITION TOLERANCE=" + readable(kReachInThicknesses * thickness, 4) : "";

  // Blocks are put in the order of their first lines: this one comes behind *ELEMENT, whose set the section names.
  std::string cards = "*MATERIAL, NAME=" + name + "\n*DENSITY\n" + number_words(wanted.density) + "\n*ELASTIC\n" +
                      number_words(wanted.youngs_modulus) + ", " + number_words(wanted.poissons_ratio) + "\n";
  cards += "*SOLID SECTION, ELSET=" + name + ", MATERIAL=" + name + "\n";
  constexpr std::array<std::string_view, 2> kEnds{"A", "B"}, kFaces{"S1", "S2"};
  for (std::size_t e = 0; e < 2; ++e) {
    const std::string tie = name + "-" + std::string(kEnds[e]), sheets = name + "-SHEETS-" + std::string(kEnds[e]);
    const Result<std::string> main = sheet_surface(model, sheets, wanted.facing[e]);
    if (!main) return fail(main.error());
    cards += "*SURFACE, NAME=" + tie + ", TYPE=ELEMENT\n" + name + ", " + std::string(kFaces[e]) + "\n" + *main;
    cards += "*TIE, NAME=" + tie + ", ADJUST=NO" + reach + "\n" + tie + ", " + sheets + "\n";
  }
  return std::pair(std::move(*part), std::move(cards));
}

Result<std::pair<Part, std::string>> weld_part(const Deck& deck, const Model& model, const CardWriter::WeldPart& wanted) {
  if (wanted.yield_stress) return fail("", "welds of an Abaqus deck are rigid connectors: \"yield_stress\" has no place in them");
  Result<Part> part = next_part(deck, model, "SPOT-WELDS");
  if (!part) return fail(part.error());
  part->material.reset();
  const std::string& name = part->name;
  std::string surface = "*SURFACE, NAME=" + name + "-SHEETS, TYPE=ELEMENT\n";
  for (const std::int64_t sheet : wanted.sheets) {
    const Part& of_sheet = part_with(model, sheet);
    if (of_sheet.name.empty())
      return fail("", "part:" + std::to_string(sheet) + " has no element set that the fasteners' surface could name");
    surface += quoted_name(of_sheet.name) + ", SPOS\n";
  }
  // Behind *ELEMENT, whose set these cards name. The first data line of *FASTENER is the direction of projection: by default the normal.
  std::string cards = "*FASTENER PROPERTY, NAME=" + name + "\n" + number_words(wanted.diameter / 2) + "\n";
  cards += "*CONNECTOR SECTION, ELSET=" + name + "\nBEAM\n" + surface;
  cards += "*FASTENER, INTERACTION NAME=" + name + ", PROPERTY=" + name + ", ELSET=" + name + "\n,\n" + name + "-SHEETS\n";
  return std::pair(std::move(*part), std::move(cards));
}

}  // namespace prismesh::mesh::deck::abaqus
