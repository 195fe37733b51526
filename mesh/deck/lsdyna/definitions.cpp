#include "mesh/deck/lsdyna/definitions.h"

#include <algorithm>
#include <initializer_list>

#include "mesh/deck/lsdyna/card.h"
#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::lsdyna {
namespace {

/// More of them in one block are only the same mistake again.
constexpr std::size_t kMaxBadFields = 1000;

bool has_option(std::string_view keyword, std::string_view option) { return keyword.find(option) != std::string_view::npos; }

/// The data lines of a block, up to an encrypted part.
class Cards {
 public:
  Cards(std::string_view text, const Block& block) : lines_(text, block.begin, block.end), columns_(block.columns) {}

  bool next(std::string_view& title) {
    Line line;
    if (!lines_.next(line) || line.text.starts_with(kEncryptedBegin)) return false;
    title = trim(line.text);
    return true;
  }
  bool next(Card& card) {
    Line line;
    if (!lines_.next(line) || line.text.starts_with(kEncryptedBegin)) return false;
    card.cut(line.text, columns_);
    offset_ = line.offset;
    return true;
  }
  std::size_t offset() const { return offset_; }  ///< of the last card
  bool skip(int cards) {
    Line line;
    while (cards > 0 && lines_.next(line)) --cards;
    return cards <= 0;
  }

 private:
  Lines lines_;
  Columns columns_;
  std::size_t offset_ = 0;
};

/// `offset`: of the include's ids.
std::optional<std::int64_t> id_or_none(std::optional<std::int64_t> id, std::int64_t offset = 0) {
  return id && *id > 0 ? std::optional(*id + offset) : std::nullopt;
}

/// Removes one of `options` from the begin of the keyword's rest. False: it begins with none.
bool cut_option(std::string_view& rest, std::initializer_list<std::string_view> options) {
  for (const std::string_view option : options)
    if (rest.starts_with(option) && (rest.size() == option.size() || rest[option.size()] == '_')) {
      rest.remove_prefix(option.size());
      return true;
    }
  return false;
}

/// Whether it is *PART with any of its options. *PART_MOVE, _ANNEAL, _SENSOR and so on name parts that others define.
bool defines_parts(std::string_view keyword) {
  if (!keyword.starts_with("PART")) return false;
  keyword.remove_prefix(4);
  while (cut_option(keyword, {"_INERTIA", "_REPOSITION", "_CONTACT", "_PRINT", "_ATTACHMENT_NODES", "_AVERAGED", "_FIELD"})) continue;
  return keyword.empty();
}

/// The number of cards of a part besides the two that all have. `inertia`: the first card of _INERTIA; null: not read yet.
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

/// The card of _CONTACT and those behind it.
int cards_from_contact(std::string_view keyword) {
  int cards = 1;
  for (const std::string_view option : {"_PRINT", "_ATTACHMENT_NODES", "_FIELD"})
    if (has_option(keyword, option)) ++cards;
  return cards;
}

/// The number of cards for `values`, eight each. Limited to what a solver accepts.
int cards_of_eight(double values) { return static_cast<int>((std::clamp(values, 0.0, 10000.0) + 7) / 8); }

}  // namespace

bool Definitions::read(std::string_view text, const Block& block, const Parameters& parameters, const IncludeContext& context) {
  const std::string_view name = block.name;
  context_ = &context;
  if (name.starts_with("PART_COMPOSITE")) {
    read_composite_part(text, block, parameters);
  } else if (defines_parts(name)) {
    read_parts(text, block, parameters);
  } else if (name.starts_with("SECTION_SHELL")) {
    read_shell_sections(text, block, parameters);
  } else if (name.starts_with("MAT_") && !name.starts_with("MAT_ADD") && !name.starts_with("MAT_NONLOCAL")) {
    read_material(text, block, parameters);
  } else if (name == "CONTROL_TIMESTEP") {
    read_time_step(text, block, parameters);
  } else {
    return contacts_.read(text, block, parameters, context);
  }
  return true;
}

/// A number that a part needs. An undefined parameter is reported where it is read.
std::optional<double> Definitions::number(const Card& card, std::size_t offset, std::size_t field, const char* what,
                                          const Parameters& parameters) {
  const std::optional<double> value = card.real(field, parameters);
  const std::string_view text = card.text(field);
  if (!value && text.find_first_of("&<") == std::string_view::npos && bad_fields_.size() < kMaxBadFields)
    bad_fields_.push_back({offset, "expected the " + std::string(what) + " but found " + quoted(text)});
  return value;
}

void Definitions::add_part(std::int64_t id, Part part, std::string_view title) {
  if (id <= 0) return;
  part.id = id;
  part.name = context_->prefix + std::string(title) + context_->suffix;
  part.defined = true;
  parts_.try_emplace(id, std::move(part));
}

void Definitions::read_parts(std::string_view text, const Block& block, const Parameters& parameters) {
  Cards cards(text, block);
  std::string_view title;
  Card card;
  while (cards.next(title) && cards.next(card)) {
    const std::optional<std::int64_t> id = id_or_none(card.integer(0, parameters), context_->offsets.part);
    if (id) {
      Part part;
      part.section = id_or_none(card.integer(1, parameters), context_->offsets.other);
      part.material = id_or_none(card.integer(2, parameters), context_->offsets.material);
      add_part(*id, std::move(part), title);
    }
    int left = option_cards(block.name, nullptr, parameters);
    if (has_option(block.name, "_INERTIA") && left > 0) {
      if (!cards.next(card)) return;
      left = option_cards(block.name, &card, parameters) - 1;
    }
    if (id && has_option(block.name, "_CONTACT")) {
      const int before = left - cards_from_contact(block.name);
      if (!cards.skip(before) || !cards.next(card)) return;
      contacts_.read_part(*id, card, parameters, *context_);
      left -= before + 1;
    }
    if (!cards.skip(left)) return;
  }
}

/// A block has one part; its layers go on to the block's end. Layers of a thick shell give no thickness: its nodes do.
void Definitions::read_composite_part(std::string_view text, const Block& block, const Parameters& parameters) {
  Cards cards(text, block);
  std::string_view title;
  Card card;
  if (!cards.next(title) || !cards.next(card)) return;
  const std::optional<std::int64_t> id = id_or_none(card.integer(0, parameters), context_->offsets.part);
  if (!id) return;
  Part part;
  if (has_option(block.name, "_CONTACT")) {
    if (!cards.next(card)) return;
    contacts_.read_part(*id, card, parameters, *context_);
  }
  const std::size_t layers_a_card = has_option(block.name, "_LONG") ? 1 : 2;
  std::vector<Layer> layers;
  double thickness = 0;
  while (cards.next(card))
    for (std::size_t layer = 0; layer < layers_a_card; ++layer) {
      const std::optional<std::int64_t> material = id_or_none(card.integer(4 * layer, parameters), context_->offsets.material);
      const double height = card.real(4 * layer + 1, parameters).value_or(0);
      if (!part.material) part.material = material;
      if (!(height > 0)) continue;
      thickness += height;
      layers.push_back({material.value_or(0), height});
    }
  if (thickness > 0 && !has_option(block.name, "_TSHELL")) part.thickness = thickness * context_->length;
  if (!parts_.contains(*id)) layers_[*id] = std::move(layers);
  add_part(*id, std::move(part), title);
}

void Definitions::read_shell_sections(std::string_view text, const Block& block, const Parameters& parameters) {
  std::string_view options = std::string_view(block.name).substr(std::string_view("SECTION_SHELL").size());
  const bool titled = has_option(options, "_TITLE");
  // Each of these options adds one card.
  int option_cards = 0;
  while (cut_option(options, {"_EFG", "_THERMAL", "_XFEM", "_MISC"})) ++option_cards;
  cut_option(options, {"_TITLE"});
  const bool repeats = options.empty();
  Cards cards(text, block);
  std::string_view title;
  Card card;
  while ((!titled || cards.next(title)) && cards.next(card)) {
    const std::optional<std::int64_t> id = id_or_none(card.integer(0, parameters), context_->offsets.other);
    const std::int64_t formulation = card.integer(1, parameters).value_or(0);
    const double points = card.real(3, parameters).value_or(0);
    const bool layered = card.integer(6, parameters).value_or(0) == 1;
    if (!cards.next(card)) return;
    double sum = 0;
    bool is_known = true;
    std::optional<double> first;
    for (std::size_t corner = 0; corner < 4; ++corner) {
      const std::optional<double> given = number(card, cards.offset(), corner, "thickness of a *SECTION_SHELL", parameters);
      if (corner == 0) first = given;
      is_known &= given.has_value();
      sum += given.value_or(0) > 0 ? *given : first.value_or(0);
    }
    if (id && is_known && sum > 0) section_thickness_.try_emplace(*id, sum / 4 * context_->length);
    if (id) contacts_.read_section(*id, card, parameters);
    if (!repeats || !cards.skip((layered ? cards_of_eight(std::max(points, 1.0)) : 0) + option_cards)) return;
    // User-defined formulations have a card of counts, one card for each integration point, then their constants.
    if (formulation < 101 || formulation > 105) continue;
    if (!cards.next(card)) return;
    const std::int64_t own_points = std::clamp<std::int64_t>(card.integer(0, parameters).value_or(0), 0, 10000);
    const int constants = cards_of_eight(card.real(5, parameters).value_or(0));
    if (!cards.skip(static_cast<int>(own_points) + constants)) return;
  }
}

void Definitions::read_material(std::string_view text, const Block& block, const Parameters& parameters) {
  Cards cards(text, block);
  std::string_view title;
  Card card;
  if (has_option(block.name, "_TITLE") && !cards.next(title)) return;
  if (!cards.next(card)) return;
  const std::optional<std::int64_t> id = id_or_none(card.integer(0, parameters), context_->offsets.material);
  if (!id) return;
  const MaterialFields fields = material_fields(block.name);
  const auto positive = [&](int field, const char* what) -> std::optional<double> {
    if (field == 0) return std::nullopt;
    const std::optional<double> value = number(card, cards.offset(), static_cast<std::size_t>(field - 1), what, parameters);
    return value && *value > 0 ? value : std::nullopt;
  };
  Material material;
  const IncludeContext& c = *context_;
  if (const auto density = positive(fields.density, "density of a material"))
    material.density = *density * c.mass / (c.length * c.length * c.length);
  if (const auto modulus = positive(fields.youngs_modulus, "modulus of a material"))
    material.youngs_modulus = *modulus * c.mass / (c.length * c.time * c.time);
  if (material.youngs_modulus && fields.poissons_ratio > 0)
    material.poissons_ratio =
        number(card, cards.offset(), static_cast<std::size_t>(fields.poissons_ratio - 1), "Poisson's ratio of a material", parameters);
  material.limits_time_step = fields.limits_time_step;
  materials_.try_emplace(*id, material);
}

void Definitions::read_time_step(std::string_view text, const Block& block, const Parameters& parameters) {
  Cards cards(text, block);
  Card card;
  if (!cards.next(card)) return;
  if (const double scale = card.real(1, parameters).value_or(0); scale > 0) time_step_.scale = scale;
  time_step_.shell_option = static_cast<int>(std::clamp<std::int64_t>(card.integer(2, parameters).value_or(0), -100, 100));
  time_step_.mass_scaled = card.real(4, parameters).value_or(0) * context_->time;
}

/// The mean over the thickness; nullopt: the density of a layer isn't known.
std::optional<double> Definitions::density_of(const std::vector<Layer>& layers) const {
  double mass = 0;
  double thickness = 0;
  for (const Layer& layer : layers) {
    const auto material = materials_.find(layer.material);
    if (material == materials_.end() || !material->second.density) return std::nullopt;
    mass += layer.thickness * *material->second.density;
    thickness += layer.thickness;
  }
  return thickness > 0 ? std::optional(mass / thickness) : std::nullopt;
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
    if (const auto layers = layers_.find(id); layers != layers_.end())
      if (const auto density = density_of(layers->second)) part.density = density;
    out.push_back(std::move(part));
  }
  return out;
}

}  // namespace prismesh::mesh::deck::lsdyna
