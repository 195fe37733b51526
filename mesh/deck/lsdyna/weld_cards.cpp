#include "mesh/deck/lsdyna/weld_cards.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string_view>

#include "mesh/deck/lsdyna/card.h"
#include "mesh/deck/lsdyna/keyword.h"
#include "mesh/deck/text/format_number.h"
#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::lsdyna {
namespace {

constexpr std::size_t kFieldsOfLine = 8;

bool begins_with_any(std::string_view name, std::initializer_list<std::string_view> words) {
  return std::any_of(words.begin(), words.end(), [&](std::string_view word) { return name.starts_with(word); });
}

/// Materials whose yield stress is the fifth field of their first card.
bool has_yield_stress(std::string_view name) {
  return begins_with_any(name, {"MAT_PIECEWISE_LINEAR_PLASTICITY", "MAT_024", "MAT_PLASTIC_KINEMATIC", "MAT_003",
                                "MAT_PLASTICITY_WITH_DAMAGE", "MAT_081", "MAT_MODIFIED_PIECEWISE_LINEAR_PLASTICITY", "MAT_123"}) &&
         name.find("LOG_INTERPOLATION") == std::string_view::npos;
}

/// What the text says that the model doesn't hold.
struct TextFacts {
  std::int64_t largest_id = 0;         ///< of parts, sections, materials, sets of parts, or a number that may be one
  std::optional<double> yield_stress;  ///< the least of the wanted materials'
  bool all_have_yield_stress = true;
};

void note_yield_stress(std::string_view text, const Block& block, const std::vector<std::int64_t>& materials, std::int64_t offset,
                       std::size_t& found, TextFacts& facts) {
  Lines lines(text, block.begin, block.end);
  Line line;
  if (block.name.ends_with("_TITLE") && !lines.next(line)) return;
  if (!lines.next(line)) return;
  Card card;
  card.cut(line.text, block.columns);
  const Parameters none;
  const std::optional<std::int64_t> id = card.integer(0, none);
  if (!id || !std::binary_search(materials.begin(), materials.end(), *id + offset)) return;
  const std::optional<double> stress = has_yield_stress(block.name) ? card.real(4, none) : std::nullopt;
  if (!stress || !(*stress > 0)) return;
  ++found;
  if (!facts.yield_stress || *stress < *facts.yield_stress) facts.yield_stress = *stress;
}

/// Every whole number that begins a line of a definition counts as an id: some are other numbers, which does no harm.
TextFacts read_facts(const Deck& deck, const std::vector<std::int64_t>& materials) {
  TextFacts facts;
  std::size_t found = 0;
  Columns columns = Columns::standard;
  for (std::uint32_t file = 0; file < deck.files.size(); ++file) {
    const std::string_view text = deck.files[file].bytes.text();
    const IdOffsets offsets = deck.offsets_in(file).value_or(IdOffsets());
    const std::int64_t most = std::max({std::int64_t{0}, offsets.part, offsets.material, offsets.set, offsets.other});
    Blocks blocks(text, columns);
    for (Block block; blocks.next(block);) {
      if (!begins_with_any(block.name, {"PART", "SECTION_", "MAT_", "SET_PART"})) continue;
      if (block.name.starts_with("MAT_")) note_yield_stress(text, block, materials, offsets.material, found, facts);
      Lines lines(text, block.begin, block.end);
      Card card;
      for (Line line; lines.next(line);) {
        card.cut(line.text, block.columns);
        std::int64_t id = 0;
        if (parse_integer(card.text(0), id)) facts.largest_id = std::max(facts.largest_id, id + most);
      }
    }
    if (file == 0) columns = blocks.columns();
  }
  facts.all_have_yield_stress = found >= materials.size() && !materials.empty();
  return facts;
}

/// Lines of fields that are aligned to the right.
class FieldText {
 public:
  explicit FieldText(std::size_t width) : width_(width) {}
  FieldText& keyword(std::string_view name) {
    text_ += '*';
    return line(name);
  }
  FieldText& line(std::string_view whole) {
    text_ += whole;
    text_ += '\n';
    return *this;
  }
  FieldText& id(std::int64_t value) { return put(std::to_string(value)); }
  FieldText& real(double value) { return put(format_coordinate(value, width_)); }
  FieldText& end() {
    text_ += '\n';
    return *this;
  }
  std::string take() { return std::move(text_); }

 private:
  FieldText& put(const std::string& value) {
    text_.append(width_ - std::min(width_, value.size()), ' ');
    text_ += value;
    return *this;
  }
  std::size_t width_;
  std::string text_;
};

Columns columns_of_main(const Deck& deck) {
  Blocks blocks(deck.files[0].bytes.text(), Columns::standard);
  for (Block block; blocks.next(block);) {
  }
  return blocks.columns();
}

std::int64_t largest_of_width(int width) {
  std::int64_t power = 1;
  for (int digit = 0; digit < std::min(18, width); ++digit) power *= 10;
  return power - 1;
}

/// One number for a part, its section, its material and a set of parts, above all of the deck's and `largest`. Errors: none is left.
Result<std::int64_t> number_of_part(const Deck& deck, const Model& model, std::int64_t largest, Columns columns) {
  std::int64_t id = largest;
  for (const Part& part : *model.parts) id = std::max({id, part.id, part.section.value_or(0), part.material.value_or(0)});
  for (const Referred referred : {Referred::part, Referred::part_set})
    for (const Reference& reference : deck.references->all(referred))
      if (reference.first == reference.last) id = std::max(id, reference.last);
  ++id;
  const int width = field_width(10, columns);
  // The part stands on the elements' cards too, whose fields are narrower.
  if (id > largest_of_width(std::min(width, field_width(8, columns))))
    return fail(deck.files[0].path.string(),
                "no number is left for a new part, section, material and set: " + std::to_string(id) + " doesn't fit the fields");
  // Ranges of parts say something of all that lie in them.
  for (const Reference& reference : deck.references->naming(Referred::part, id))
    return fail(deck.files[0].path.string(), "no number is left for a new part: the next, " + std::to_string(id) +
                                                 ", lies in a range of parts of " +
                                                 deck.references->referrers()[reference.referrer].keyword);

  return id;
}

/// The set of the parts that are joined.
void list_sheets(std::int64_t id, const std::vector<std::int64_t>& sheets, FieldText& cards) {
  cards.keyword("SET_PART_LIST").id(id).end();
  for (std::size_t s = 0; s < sheets.size(); ++s) {
    cards.id(sheets[s]);
    if ((s + 1) % kFieldsOfLine == 0 || s + 1 == sheets.size()) cards.end();
  }
}

}  // namespace

Result<std::pair<Part, std::string>> weld_part(const Deck& deck, const Model& model, const CardWriter::WeldPart& wanted) {
  std::vector<std::int64_t> materials;
  for (const Part& part : *model.parts)
    if (part.material && std::binary_search(wanted.sheets.begin(), wanted.sheets.end(), part.id)) materials.push_back(*part.material);
  std::sort(materials.begin(), materials.end());
  materials.erase(std::unique(materials.begin(), materials.end()), materials.end());
  const TextFacts facts = read_facts(deck, materials);
  std::optional<double> yield_stress = wanted.yield_stress;
  if (!yield_stress && facts.all_have_yield_stress) yield_stress = facts.yield_stress;

  const auto unknown = [](const std::string& what, const std::string& field) {
    return fail("", "the " + what + " of the welds isn't known from the materials of the sheets: \"" + field +
                        "\" must give it, in the deck's units");
  };
  if (!wanted.density) return unknown("density", "density");
  if (!wanted.youngs_modulus) return unknown("Young's modulus", "youngs_modulus");
  if (!wanted.poissons_ratio) return unknown("Poisson's ratio", "poissons_ratio");
  if (!yield_stress) return unknown("yield stress", "yield_stress");

  const Columns columns = columns_of_main(deck);
  const Result<std::int64_t> number = number_of_part(deck, model, facts.largest_id, columns);
  if (!number) return fail(number.error());
  const std::int64_t id = *number;
  FieldText cards(static_cast<std::size_t>(field_width(10, columns)));
  cards.keyword("PART").line("spot welds").id(id).id(id).id(id).end();
  cards.keyword("SECTION_BEAM").id(id).id(9).real(1).real(2).real(1).end();
  cards.real(wanted.diameter).real(wanted.diameter).real(0).real(0).end();
  cards.keyword("MAT_SPOTWELD");
  cards.id(id).real(*wanted.density).real(*wanted.youngs_modulus).real(*wanted.poissons_ratio).real(*yield_stress).real(0).end();
  cards.end();
  list_sheets(id, wanted.sheets, cards);
  // The part of the welds (SSTYP 3) is tied to the set of the sheets' parts (MSTYP 2); the two cards behind are left at their defaults.
  cards.keyword("CONTACT_SPOTWELD").id(id).id(id).id(3).id(2).end().end().end();

  Part part;
  part.id = id;
  part.name = "spot welds";
  part.defined = true;
  part.section = part.material = id;
  part.density = wanted.density;
  part.youngs_modulus = wanted.youngs_modulus;
  part.poissons_ratio = wanted.poissons_ratio;
  return std::pair(std::move(part), cards.take());
}

Result<std::pair<Part, std::string>> bond_part(const Deck& deck, const Model& model, const CardWriter::BondPart& wanted) {
  const Columns columns = columns_of_main(deck);
  const Result<std::int64_t> number = number_of_part(deck, model, read_facts(deck, {}).largest_id, columns);
  if (!number) return fail(number.error());
  const std::int64_t id = *number;
  FieldText cards(static_cast<std::size_t>(field_width(10, columns)));
  cards.keyword("PART").line("adhesive").id(id).id(id).id(id).end();
  cards.keyword("SECTION_SOLID").id(id).id(-1).end();
  cards.keyword("MAT_ELASTIC").id(id).real(wanted.density).real(wanted.youngs_modulus).real(wanted.poissons_ratio).end();
  list_sheets(id, wanted.sheets, cards);
  // The nodes of the part (SSTYP 3) are tied to the set of the sheets' parts (MSTYP 2); the two cards behind are left at their defaults.
  cards.keyword("CONTACT_TIED_NODES_TO_SURFACE_OFFSET").id(id).id(id).id(3).id(2).end().end().end();

  Part part;
  part.id = id;
  part.name = "adhesive";
  part.defined = true;
  part.section = part.material = id;
  part.density = wanted.density;
  part.youngs_modulus = wanted.youngs_modulus;
  part.poissons_ratio = wanted.poissons_ratio;
  return std::pair(std::move(part), cards.take());
}

}  // namespace prismesh::mesh::deck::lsdyna
