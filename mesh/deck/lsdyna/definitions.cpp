#include "mesh/deck/lsdyna/definitions.h"

#include <algorithm>

#include "mesh/deck/lsdyna/card.h"
#include "mesh/deck/lsdyna/number.h"

namespace prismesh::mesh::deck::lsdyna {
namespace {

bool starts_with(std::string_view text, std::string_view start) { return text.substr(0, start.size()) == start; }
bool has_option(std::string_view keyword, std::string_view option) { return keyword.find(option) != std::string_view::npos; }

/// Data lines of a block; an encrypted block inside ends it.
class Cards {
 public:
  Cards(std::string_view text, const Block& block) : lines_(text, block.begin, block.end), columns_(block.columns) {}

  bool next(std::string_view& title) {
    Line line;
    if (!lines_.next(line) || starts_with(line.text, kEncryptedBegin)) return false;
    title = trim(line.text);
    return true;
  }
  bool next(Card& card) {
    Line line;
    if (!lines_.next(line) || starts_with(line.text, kEncryptedBegin)) return false;
    card.cut(line.text, columns_);
    return true;
  }
  bool skip(int cards) {
    Line line;
    while (cards > 0 && lines_.next(line)) --cards;
    return cards <= 0;
  }

 private:
  Lines lines_;
  Columns columns_;
};

std::optional<std::int64_t> id_or_none(std::optional<std::int64_t> id) { return id && *id > 0 ? id : std::nullopt; }

/// Cards of the options of *PART besides the two that all have.
int option_cards(std::string_view keyword, const Card* inertia, const Parameters& parameters) {
  int cards = 0;
  if (has_option(keyword, "_INERTIA")) {
    cards += 3;
    // A local coordinate system for the inertia takes one more card.
    if (inertia && inertia->integer(4, parameters).value_or(0) == 1) ++cards;
  }
  for (const std::string_view option : {"_REPOSITION", "_CONTACT", "_PRINT", "_ATTACHMENT_NODES", "_FIELD"})
    if (has_option(keyword, option)) ++cards;
  return cards;
}

}  // namespace

bool Definitions::read(std::string_view text, const Block& block, const Parameters& parameters) {
  const std::string_view name = block.name;
  if (starts_with(name, "PART_COMPOSITE")) {
    read_composite_part(text, block, parameters);
  } else if (name == "PART" || starts_with(name, "PART_INERTIA") || starts_with(name, "PART_CONTACT") || starts_with(name, "PART_PRINT") ||
             starts_with(name, "PART_REPOSITION") || starts_with(name, "PART_ATTACHMENT_NODES") || starts_with(name, "PART_FIELD") ||
             starts_with(name, "PART_AVERAGED")) {
    if (!has_option(name, "_AVERAGED")) read_parts(text, block, parameters);
  } else if (starts_with(name, "SECTION_SHELL")) {
    read_shell_sections(text, block, parameters);
  } else if (starts_with(name, "MAT_") && !starts_with(name, "MAT_ADD")) {
    read_material(text, block, parameters);
  } else if (name == "CONTROL_TIMESTEP") {
    read_time_step(text, block, parameters);
  } else {
    return false;
  }
  return true;
}

void Definitions::read_parts(std::string_view text, const Block& block, const Parameters& parameters) {
  Cards cards(text, block);
  std::string_view title;
  Card card;
  while (cards.next(title) && cards.next(card)) {
    const std::optional<std::int64_t> id = id_or_none(card.integer(0, parameters));
    if (id) {
      Part part;
      part.id = *id;
      part.name = title;
      part.defined = true;
      part.section = id_or_none(card.integer(1, parameters));
      part.material = id_or_none(card.integer(2, parameters));
      parts_.try_emplace(*id, std::move(part));
    }
    int left = option_cards(block.name, nullptr, parameters);
    if (has_option(block.name, "_INERTIA") && left > 0) {
      if (!cards.next(card)) return;
      left = option_cards(block.name, &card, parameters) - 1;
    }
    if (!cards.skip(left)) return;
  }
}

/// One part a keyword: its layers go on to the end of the block.
void Definitions::read_composite_part(std::string_view text, const Block& block, const Parameters& parameters) {
  Cards cards(text, block);
  std::string_view title;
  Card card;
  if (!cards.next(title) || !cards.next(card)) return;
  const std::optional<std::int64_t> id = id_or_none(card.integer(0, parameters));
  if (!id) return;
  Part part;
  part.id = *id;
  part.name = title;
  part.defined = true;
  if (has_option(block.name, "_CONTACT") && !cards.skip(1)) return;
  const bool one_a_card = has_option(block.name, "_LONG");
  double thickness = 0;
  while (cards.next(card)) {
    if (!part.material) part.material = id_or_none(card.integer(0, parameters));
    thickness += card.real(1, parameters).value_or(0);
    if (!one_a_card) thickness += card.real(5, parameters).value_or(0);
  }
  if (thickness > 0) part.thickness = thickness;
  parts_.try_emplace(*id, std::move(part));
}

void Definitions::read_shell_sections(std::string_view text, const Block& block, const Parameters& parameters) {
  const bool titled = has_option(block.name, "_TITLE");
  // Other options bring cards of their own after the first section's.
  const bool repeats = block.name == "SECTION_SHELL" || block.name == "SECTION_SHELL_TITLE";
  Cards cards(text, block);
  std::string_view title;
  Card card;
  while ((!titled || cards.next(title)) && cards.next(card)) {
    const std::optional<std::int64_t> id = id_or_none(card.integer(0, parameters));
    const std::int64_t formulation = card.integer(1, parameters).value_or(0);
    const double points = card.real(3, parameters).value_or(0);
    const bool layered = card.integer(6, parameters).value_or(0) == 1;
    if (!cards.next(card)) return;
    double sum = 0;
    const double first = card.real(0, parameters).value_or(0);
    for (std::size_t corner = 0; corner < 4; ++corner) {
      const double given = card.real(corner, parameters).value_or(0);
      sum += given > 0 ? given : first;
    }
    if (id && sum > 0) section_thickness_.try_emplace(*id, sum / 4);
    // User-defined formulations bring cards of their own as well.
    if (!repeats || formulation > 100) return;
    if (layered && !cards.skip(static_cast<int>((std::clamp(points, 1.0, 1000.0) + 7) / 8))) return;
  }
}

void Definitions::read_material(std::string_view text, const Block& block, const Parameters& parameters) {
  Cards cards(text, block);
  std::string_view title;
  Card card;
  if (has_option(block.name, "_TITLE") && !cards.next(title)) return;
  if (!cards.next(card)) return;
  const std::optional<std::int64_t> id = id_or_none(card.integer(0, parameters));
  if (!id) return;
  const MaterialFields fields = material_fields(block.name);
  const auto positive = [&](int field) -> std::optional<double> {
    if (field == 0) return std::nullopt;
    const std::optional<double> value = card.real(static_cast<std::size_t>(field - 1), parameters);
    return value && *value > 0 ? value : std::nullopt;
  };
  Material material;
  material.density = positive(fields.density);
  material.youngs_modulus = positive(fields.youngs_modulus);
  if (material.youngs_modulus && fields.poissons_ratio > 0)
    material.poissons_ratio = card.real(static_cast<std::size_t>(fields.poissons_ratio - 1), parameters);
  material.limits_time_step = fields.limits_time_step;
  materials_.try_emplace(*id, material);
}

void Definitions::read_time_step(std::string_view text, const Block& block, const Parameters& parameters) {
  Cards cards(text, block);
  Card card;
  if (!cards.next(card)) return;
  if (const double scale = card.real(1, parameters).value_or(0); scale > 0) time_step_.scale = scale;
  time_step_.shell_option = static_cast<int>(std::clamp<std::int64_t>(card.integer(2, parameters).value_or(0), -100, 100));
  time_step_.mass_scaled = card.real(4, parameters).value_or(0);
}

std::vector<Part> Definitions::parts() const {
  std::vector<Part> out;
  for (const auto& [id, defined] : parts_) {
    Part part = defined;
    if (part.section)
      if (const auto section = section_thickness_.find(*part.section); section != section_thickness_.end())
        part.thickness = section->second;
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

}  // namespace prismesh::mesh::deck::lsdyna
