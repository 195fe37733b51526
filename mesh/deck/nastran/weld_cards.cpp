#include "mesh/deck/nastran/weld_cards.h"

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <vector>

#include "base/letter_case.h"
#include "mesh/deck/nastran/card.h"
#include "mesh/deck/nastran/card_edit.h"
#include "mesh/deck/nastran/replication.h"
#include "mesh/deck/text/format_number.h"

namespace prismesh::mesh::deck::nastran {
namespace {

constexpr std::int64_t kLargestOfSmallField = 99'999'999;

std::string small_number(double value) { return format_coordinate(value, width_of(Layout::small), Exponent::bare); }

/// The largest number of a property or material; every first number of an entry that begins with P or M counts.
std::int64_t largest_number(const Deck& deck, const Model& model) {
  std::int64_t largest = 0;
  for (const Part& part : *model.parts) largest = std::max({largest, part.id, part.material.value_or(0)});
  for (const auto& file : deck.files) {
    const std::string_view text = file.bytes.text();
    for (std::size_t at = 0; at < text.size();) {
      const Line line = line_at(text, at);
      at = line.next;
      if (line.text.empty() || !starts_card(line.text)) continue;
      if (const char first = upper(line.text[0]); first == 'P' || first == 'M')
        largest = std::max(largest, card_at(text, line.offset).integer_or_zero(0));
    }
  }
  return largest;
}

}  // namespace

Result<std::pair<Part, std::string>> weld_part(const Deck& deck, const Model& model, const CardWriter::WeldPart& wanted) {
  if (wanted.yield_stress) return fail("", "welds of a Nastran deck are elastic: \"yield_stress\" has no place in PWELD and MAT1");
  const auto unknown = [](const std::string& what, const std::string& field) {
    return fail("", "the " + what + " of the welds isn't known from the materials of the sheets: \"" + field +
                        "\" must give it, in the deck's units");
  };
  if (!wanted.youngs_modulus) return unknown("Young's modulus", "youngs_modulus");
  if (!wanted.poissons_ratio) return unknown("Poisson's ratio", "poissons_ratio");
  const std::int64_t id = largest_number(deck, model) + 1;
  if (id > kLargestOfSmallField)
    return fail(deck.files[0].path.string(),
                "no number is left for a new property and material: " + std::to_string(id) + " doesn't fit a field of eight columns");
  const Manner manner;
  const std::string number = std::to_string(id);
  std::string cards = write_card("MAT1",
                                 {number, small_number(*wanted.youngs_modulus), "", small_number(*wanted.poissons_ratio),
                                  wanted.density ? small_number(*wanted.density) : ""},
                                 manner) +
                      "\n" + write_card("PWELD", {number, number, small_number(wanted.diameter)}, manner) + "\n";
  Part part;
  part.id = id;
  part.name = "";
  part.defined = true;
  part.section = part.material = id;
  part.density = wanted.density;
  part.youngs_modulus = wanted.youngs_modulus;
  part.poissons_ratio = wanted.poissons_ratio;
  return std::pair(std::move(part), std::move(cards));
}

}  // namespace prismesh::mesh::deck::nastran
