#include "mesh/deck/lsdyna/element_writer.h"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "mesh/deck/lsdyna/block_lines.h"
#include "mesh/deck/lsdyna/field_line.h"
#include "mesh/deck/lsdyna/keyword.h"
#include "mesh/deck/lsdyna/mesh_cards.h"
#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::lsdyna {
namespace {

constexpr std::array<int, 10> kWrittenElementWidths = {8, 8, 8, 8, 8, 8, 8, 8, 8, 8};
constexpr std::size_t kFirstNode = 2;
constexpr std::size_t kThirdNode = 4;

std::optional<std::int64_t> whole_number(std::string_view text) {
  std::int64_t value = 0;
  return parse_integer(text, value) ? std::optional(value) : std::nullopt;
}

/// The first id on a line by its first characters: most lines of a long block aren't wanted.
std::int64_t id_on(std::string_view line, Columns columns) {
  const FieldLine fields(line.substr(0, static_cast<std::size_t>(2 * field_width(8, columns))), std::array{8, 8}, columns);
  return whole_number(fields.text(0)).value_or(0);
}

struct Wanted {
  CardKind kind = CardKind::beam;
  std::int64_t id = 0;                  ///< as in the text
  std::span<const std::int64_t> nodes;  ///< as in the model
  std::int64_t node_offset = 0;
};

/// Whether a solid's card has ids only, so that its nodes stand on those that follow.
bool has_ids_only(const FieldLine& fields) {
  for (std::size_t n = kFirstNode; n < kWrittenElementWidths.size(); ++n)
    if (!fields.is_blank_or_zero(n)) return false;
  return true;
}

bool has_nodes(std::string_view line, Columns columns, std::size_t first, const Wanted& wanted) {
  const FieldLine fields(line, kWrittenElementWidths, columns);
  for (std::size_t n = 0; n < wanted.nodes.size(); ++n)
    if (whole_number(fields.text(first + n)).value_or(0) + wanted.node_offset != wanted.nodes[n]) return false;
  return true;
}

/// Looks through a block for the wanted card, and for the largest id.
void search_block(std::string_view text, const Block& block, const CardForm& form, const Wanted& wanted, std::int64_t& largest,
                  std::optional<ElementPlace>& found, std::string& keyword) {
  const std::vector<EncryptedPart> encrypted = encrypted_parts(text, block.begin, block.end);
  BlockLines lines(text, block.begin, block.end, encrypted);
  Line line;
  while (lines.next(line)) {
    if (trim(line.text).empty()) continue;
    const std::int64_t id = id_on(line.text, block.columns);
    largest = std::max(largest, id);
    std::size_t end = line.offset + line.text.size();
    int node_lines = form.node_lines;
    if (form.kind == CardKind::solid && node_lines == 0 && has_ids_only(FieldLine(line.text, kWrittenElementWidths, block.columns)))
      node_lines = 1;
    Line nodes = line, further;
    for (int i = 0; i < node_lines + form.extra_lines; ++i)
      if (lines.next(further)) {
        end = further.offset + further.text.size();
        if (i == 0 && node_lines > 0) nodes = further;
      }
    if (found || id != wanted.id || !has_nodes(nodes.text, block.columns, node_lines > 0 ? 0 : kFirstNode, wanted)) continue;
    found = ElementPlace{0, line.offset, end, static_cast<std::uint16_t>(block.columns), 0};
    keyword = block.name;
  }
}

/// A solid's card with other numbers: the nodes stand on the line of the ids, or on the example's last line.
std::string solid_like(std::string_view text, const ElementPlace& example, const ElementCard& element) {
  const auto columns = static_cast<Columns>(example.style);
  const std::size_t end = end_of_line(text, example.offset);
  FieldLine ids(text.substr(example.offset, end - example.offset), kWrittenElementWidths, columns);
  const bool ids_only = has_ids_only(ids);
  ids.set(0, std::to_string(element.id));
  const auto set_nodes = [&](FieldLine& line, std::size_t first) {
    for (std::size_t n = 0; n < element.nodes.size(); ++n) line.set(first + n, std::to_string(element.nodes[n]));
  };
  if (!ids_only) {
    set_nodes(ids, kFirstNode);
    return ids.str();
  }
  const std::size_t begin = text.rfind('\n', example.end - 1) + 1;
  FieldLine nodes(text.substr(begin, example.end - begin), kWrittenElementWidths, columns);
  set_nodes(nodes, 0);
  return ids.str() + std::string(text.substr(end, begin - end)) + nodes.str();
}

}  // namespace

Result<ElementPlace> find_element(const Deck& deck, ElementClass element_class, std::int64_t id, std::span<const std::int64_t> nodes) {
  if (element_class != ElementClass::beam && element_class != ElementClass::solid)
    return fail("", "can't be an example: of the elements other than shells this version adds beams and solids to LS-DYNA decks");
  const CardKind kind = element_class == ElementClass::solid ? CardKind::solid : CardKind::beam;
  Columns columns = Columns::standard;
  for (std::uint32_t file = 0; file < deck.files.size(); ++file) {
    const std::string_view text = deck.files[file].bytes.text();
    const IdOffsets offsets = deck.offsets_in(file).value_or(IdOffsets());
    const Wanted wanted{kind, id - offsets.element, nodes, offsets.node};
    std::int64_t largest = 0;
    std::optional<ElementPlace> found;
    std::string keyword;
    Blocks blocks(text, columns);
    for (Block block; blocks.next(block);)
      if (const std::optional<CardForm> form = card_form(block.name); form && form->kind == wanted.kind)
        search_block(text, block, *form, wanted, largest, found, keyword);
    if (file == 0) columns = blocks.columns();
    if (!found) continue;
    if (has_word(keyword, "PID")) return fail("", "can't be an example: *" + keyword + " names the parts that each beam joins");
    if (kind == CardKind::solid && keyword != "ELEMENT_SOLID")
      return fail("", "can't be an example: *" + keyword + " gives a solid more than its nodes");
    found->file = file;
    found->last_in_file = largest;
    return *found;
  }
  return fail("", "can't be an example: its card isn't found, or parameters give its numbers");
}

Result<WrittenCard> element_like(std::string_view text, const ElementPlace& example, const ElementCard& element) {
  WrittenCard card;
  if (element.element_class == ElementClass::solid) {
    card.text = solid_like(text, example, element);
    return card;
  }
  const std::size_t end = end_of_line(text, example.offset);
  FieldLine line(text.substr(example.offset, end - example.offset), kWrittenElementWidths, static_cast<Columns>(example.style));
  if (!line.is_blank_or_zero(kThirdNode)) {
    const std::string_view third = line.text(kThirdNode);
    std::size_t same = 0;
    while (same < element.nodes.size() && line.text(kFirstNode + same) != third) ++same;
    if (same == element.nodes.size())
      return fail("", "would be like a beam with a node of its own for its orientation, which a new beam hasn't");
    line.set(kThirdNode, std::to_string(element.nodes[same]));
  }
  line.set(0, std::to_string(element.id));
  for (std::size_t n = 0; n < element.nodes.size(); ++n) line.set(kFirstNode + n, std::to_string(element.nodes[n]));
  card.text = line.str() + std::string(text.substr(end, example.end - end));
  return card;
}

std::size_t end_of_cards(std::string_view text) {
  Blocks blocks(text, Columns::standard);
  std::size_t last = 0;
  for (Block block; blocks.next(block);) last = block.end;
  return blocks.ended() || last > 0 ? last : text.size();
}

Result<WrittenCard> new_element(std::string_view text, ElementClass element_class, const ElementCard& element) {
  if (element_class != ElementClass::beam && element_class != ElementClass::solid) return fail("", "is neither a beam nor a solid");
  Blocks blocks(text, Columns::standard);
  Block block;
  while (blocks.next(block)) {
  }
  FieldLine line("", kWrittenElementWidths, blocks.columns());
  line.set(0, std::to_string(element.id));
  line.set(1, std::to_string(element.part));
  for (std::size_t n = 0; n < element.nodes.size(); ++n) line.set(kFirstNode + n, std::to_string(element.nodes[n]));
  if (element_class == ElementClass::beam) line.set(kThirdNode, "0");
  WrittenCard card;
  card.text = line.str();
  return card;
}

}  // namespace prismesh::mesh::deck::lsdyna
