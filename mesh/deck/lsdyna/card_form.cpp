// The cards of keywords with nodes or elements (LS-DYNA keyword manual, volume I, *NODE and *ELEMENT).
#include <string>
#include <utility>

#include "mesh/deck/lsdyna/mesh_cards.h"

namespace prismesh::mesh::deck::lsdyna {
namespace {

/// Removes the first word of "THICKNESS_OFFSET" and returns it.
std::string_view next_word(std::string_view& options) {
  if (!options.empty() && options.front() == '_') options.remove_prefix(1);
  const std::size_t end = std::min(options.find('_'), options.size());
  const std::string_view word = options.substr(0, end);
  options.remove_prefix(end);
  return word;
}

std::optional<CardForm> shell_form(std::string_view options) {
  CardForm form{.kind = CardKind::shell};
  while (!options.empty()) {
    const std::string_view word = next_word(options);
    if (word == "MCID") form.coordinate_system = true;
    if (word == "DOF") form.scalar_nodes = true;
    if (word == "THICKNESS" || word == "BETA" || word == "MCID")
      form.thickness = true;
    else if (word == "OFFSET" || word == "DOF")
      ++form.extra_lines;
    else if (word == "COMPOSITE")
      form.composite = true;
    else if (word == "LONG" && form.composite)
      form.composite_long = true;
    else if (word != "SHL4" && word != "TO" && word != "SHL8")
      return std::nullopt;
  }
  return form;
}

std::optional<CardForm> beam_form(std::string_view options) {
  CardForm form{.kind = CardKind::beam, .node_fields = 2};
  while (!options.empty()) {
    const std::string_view word = next_word(options);
    for (const std::string_view known : {"THICKNESS", "SCALAR", "SCALR", "SECTION", "PID", "OFFSET", "ORIENTATION", "WARPAGE", "ELBOW"})
      if (word == known) {
        ++form.extra_lines;
        break;
      } else if (known == "ELBOW") {
        return std::nullopt;
      }
  }
  return form;
}

std::optional<CardForm> solid_form(std::string_view options) {
  constexpr std::pair<std::string_view, int> kNodeLines[] = {{"H20", 2}, {"T15", 2}, {"T20", 2}, {"H27", 3},
                                                             {"P21", 3}, {"P40", 4}, {"T35", 4}, {"H64", 7}};
  CardForm form{.kind = CardKind::solid};
  while (!options.empty()) {
    const std::string_view word = next_word(options);
    bool known = word == "TET4TOTET10" || word == "H8TOH20" || word == "H8TOH27" || word == "H8TOH64";
    if (word == "ORTHO") form.extra_lines += 2, known = true;
    if (word == "DOF") form.extra_lines += 1, known = true;
    for (const auto& [name, lines] : kNodeLines)
      if (word == name) form.node_lines = lines, known = true;
    if (!known) return std::nullopt;
  }
  return form;
}

std::optional<CardForm> tshell_form(std::string_view options) {
  CardForm form{.kind = CardKind::tshell};
  while (!options.empty()) {
    const std::string_view word = next_word(options);
    if (word == "BETA")
      ++form.extra_lines;
    else if (word == "COMPOSITE")
      form.composite = true;
    else
      return std::nullopt;
  }
  return form;
}

}  // namespace

std::optional<CardForm> card_form(std::string_view keyword) {
  if (keyword == "NODE") return CardForm{};
  constexpr std::string_view kElement = "ELEMENT_";
  if (keyword.substr(0, kElement.size()) != kElement) return std::nullopt;
  std::string_view options = keyword.substr(kElement.size());
  const std::string_view what = next_word(options);
  if (what == "SHELL") return shell_form(options);
  if (what == "BEAM") return beam_form(options);
  if (what == "SOLID") return solid_form(options);
  if (what == "TSHELL") return tshell_form(options);
  if (what == "DISCRETE" && (options.empty() || options == "_LCO"))
    return CardForm{.kind = CardKind::discrete, .extra_lines = options.empty() ? 0 : 1, .node_fields = 2};
  if (what == "MASS" && options.empty()) return CardForm{.kind = CardKind::mass};
  if (what == "MASS" && options == "_NODE_SET") return CardForm{.kind = CardKind::mass_of_set};
  if (what == "MASS" && (options == "_PART" || options == "_PART_SET")) return CardForm{.kind = CardKind::mass_of_part};
  if (what == "INERTIA" && (options.empty() || options == "_OFFSET"))
    return CardForm{.kind = CardKind::mass, .extra_lines = options.empty() ? 1 : 2};
  if (what == "SPH" && (options.empty() || options == "_VOLUME")) return CardForm{.kind = CardKind::sph};
  if (what == "SEATBELT" && options.empty()) return CardForm{.kind = CardKind::other, .node_fields = 2};
  if (what == "PLOTEL" && options.empty()) return CardForm{.kind = CardKind::other, .node_fields = 0};
  return std::nullopt;
}

std::uint16_t shell_style(const CardForm& form, Columns columns) {
  unsigned bits = static_cast<unsigned>(columns);
  bits |= form.thickness ? 4u : 0u;
  bits |= form.composite ? 8u : 0u;
  bits |= form.composite_long ? 16u : 0u;
  bits |= form.coordinate_system ? 32u : 0u;
  bits |= form.scalar_nodes ? 64u : 0u;
  return static_cast<std::uint16_t>(bits | static_cast<unsigned>(form.extra_lines) << 7);
}

CardForm shell_form_of(std::uint16_t style) {
  return {.kind = CardKind::shell,
          .thickness = (style & 4u) != 0,
          .composite = (style & 8u) != 0,
          .composite_long = (style & 16u) != 0,
          .coordinate_system = (style & 32u) != 0,
          .scalar_nodes = (style & 64u) != 0,
          .extra_lines = style >> 7};
}

}  // namespace prismesh::mesh::deck::lsdyna
