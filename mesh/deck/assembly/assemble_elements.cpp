#include "mesh/deck/assembly/assemble_elements.h"

#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "mesh/deck/assembly/undefined_node.h"

namespace prismesh::mesh::deck {
namespace {

/// Nodes that every form of an element has. Beyond them a blank field is a mid-side node that isn't there.
constexpr std::uint32_t kMaxCorners = 8;

struct ElementPlace {
  std::uint32_t file = 0;
  std::size_t offset = 0;
};

/// The elements of one class, and where the card of each stands.
struct PlacedElements {
  ElementBlock block;
  std::vector<ElementPlace> places;
  std::vector<std::uint32_t> numberings;
};

/// Fills `nodes` with those of element e. Returns the first that nobody defines.
std::optional<std::int64_t> find_nodes(const RawElements& from, std::size_t e, const IdLookup& lookup, std::vector<NodeIndex>& nodes) {
  nodes.clear();
  for (std::uint32_t n = from.first_node[e]; n < from.first_node[e + 1]; ++n) {
    if (from.nodes[n] == 0 && n >= from.first_node[e] + kMaxCorners) continue;
    nodes.push_back(lookup.node(from.nodes[n]));
    if (!nodes.back().valid()) return from.nodes[n];
  }
  return std::nullopt;
}

void leave_out(const RawElements& from, std::size_t e, std::uint32_t file, ElementClass element_class, const IdLookup& lookup,
               LeftOutElements& left_out) {
  ++left_out.counts.of(element_class);
  left_out.ids.push_back(from.id[e]);
  std::vector<NodeIndex> nodes;
  for (std::uint32_t n = from.first_node[e]; n < from.first_node[e + 1]; ++n)
    if (const NodeIndex node = lookup.node(from.nodes[n]); node.valid()) nodes.push_back(node);
  left_out.nodes.insert(left_out.nodes.end(), nodes.begin(), nodes.end());
  hide({element_class, from.id[e], file, from.offset[e]}, nodes, left_out.hidden);
}

PlacedElements join_elements(std::span<PieceCards> cards, ElementClass element_class, const IdLookup& lookup, LeftOutElements& left_out,
                             Warnings& warnings) {
  PlacedElements out;
  std::vector<NodeIndex> nodes;
  const bool is_mesh = element_class == ElementClass::beam || element_class == ElementClass::solid || element_class == ElementClass::tshell;
  for (PieceCards& piece : cards) {
    const RawElements from = std::exchange(piece.elements[static_cast<std::size_t>(element_class)], {});
    for (std::size_t e = 0; e < from.id.size(); ++e) {
      if (const std::optional<std::int64_t> undefined = find_nodes(from, e, lookup, nodes)) {
        note_undefined_node(warnings, {name(element_class), from.id[e], *undefined, piece.file, from.offset[e]});
        leave_out(from, e, piece.file, element_class, lookup, left_out);
        if (is_mesh) left_out.undefined_nodes.push_back(*undefined);
        continue;
      }
      const bool has_no_part = from.part[e] == 0 && element_class == ElementClass::mass;
      out.places.push_back({piece.file, from.offset[e]});
      out.numberings.push_back(from.numbering.empty() ? 0 : from.numbering[e]);
      out.block.id.push_back(from.id[e]);
      out.block.part.push_back(has_no_part ? PartIndex() : lookup.part(from.part[e]));
      out.block.nodes.insert(out.block.nodes.end(), nodes.begin(), nodes.end());
      out.block.first_node.push_back(static_cast<std::uint32_t>(out.block.nodes.size()));
    }
  }
  return out;
}

/// Masses of parts and sets, for one, are numbered by themselves, and Radioss's trusses and beams. Other classes have one numbering.
bool may_have_numberings(ElementClass element_class) {
  return element_class == ElementClass::mass || element_class == ElementClass::other || element_class == ElementClass::beam;
}

/// For each element whether an earlier one has its id.
std::vector<std::uint8_t> find_repeated(const PlacedElements& elements, ElementClass element_class) {
  const std::vector<std::int64_t>& ids = elements.block.id;
  const IdIndex index(ids);
  if (index.duplicates().empty()) return {};
  std::vector<std::uint8_t> repeated(ids.size());
  if (!may_have_numberings(element_class)) {
    for (std::size_t e = 0; e < ids.size(); ++e) repeated[e] = index.find(ids[e]) != e;
    return repeated;
  }
  std::set<std::pair<std::uint32_t, std::int64_t>> known;
  for (std::size_t e = 0; e < ids.size(); ++e) repeated[e] = !known.emplace(elements.numberings[e], ids[e]).second;
  return repeated;
}

ElementBlock without_duplicates(PlacedElements elements, ElementClass element_class, LeftOutElements& left_out, Warnings& warnings) {
  ElementBlock& block = elements.block;
  const std::vector<std::uint8_t> repeated = find_repeated(elements, element_class);
  if (std::find(repeated.begin(), repeated.end(), 1) == repeated.end()) return std::move(block);
  ElementBlock kept;
  for (std::size_t e = 0; e < block.size(); ++e) {
    if (repeated[e]) {
      ++left_out.counts.of(element_class);
      warnings.note("duplicate-element", elements.places[e].file, elements.places[e].offset,
                    std::string(element_class == ElementClass::other ? "element" : name(element_class)) + " " +
                        std::to_string(block.id[e]) + " is defined again; its first definition counts");
      hide({element_class, block.id[e], elements.places[e].file, elements.places[e].offset},
           {block.nodes.data() + block.first_node[e], block.nodes.data() + block.first_node[e + 1]}, left_out.hidden);
      continue;
    }
    kept.id.push_back(block.id[e]);
    kept.part.push_back(block.part[e]);
    kept.nodes.insert(kept.nodes.end(), block.nodes.begin() + block.first_node[e], block.nodes.begin() + block.first_node[e + 1]);
    kept.first_node.push_back(static_cast<std::uint32_t>(kept.nodes.size()));
  }
  return kept;
}

}  // namespace

std::array<std::shared_ptr<const ElementBlock>, kElementClassCount> assemble_elements(std::span<PieceCards> cards, const IdLookup& lookup,
                                                                                      LeftOutElements& left_out, Warnings& warnings) {
  std::array<std::shared_ptr<const ElementBlock>, kElementClassCount> blocks;
  for (std::size_t c = 0; c < kElementClassCount; ++c) {
    const auto element_class = static_cast<ElementClass>(c);
    if (element_class == ElementClass::shell) continue;
    PlacedElements elements = join_elements(cards, element_class, lookup, left_out, warnings);
    blocks[c] = std::make_shared<const ElementBlock>(without_duplicates(std::move(elements), element_class, left_out, warnings));
  }
  return blocks;
}

}  // namespace prismesh::mesh::deck
