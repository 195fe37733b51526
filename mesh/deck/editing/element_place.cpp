#include "mesh/deck/editing/element_place.h"

#include <vector>

#include "mesh/deck/editing/text_place.h"

namespace prismesh::mesh::deck {

Result<ElementPlace> place_of_element(const Deck& deck, const Model& model, const CardWriter& writer, ElementClass element_class,
                                      std::uint32_t element) {
  const ElementBlock& block = *model.elements[static_cast<std::size_t>(element_class)];
  std::vector<std::int64_t> nodes;
  for (std::size_t n = block.first_node[element]; n < block.first_node[element + 1]; ++n)
    nodes.push_back(block.nodes[n].valid() ? model.node_ids[block.nodes[n].value] : 0);
  const std::string name = element_name(model, element_class, element);
  Result<ElementPlace> place = writer.find_element(deck, element_class, block.id[element], nodes);
  if (!place) return fail(deck.files[0].path.string(), name + " " + place.error().message);
  const auto refuse = [&](const std::string& why) { return fail(error_at(deck, place->file, place->offset, name + " " + why)); };
  if (deck.is_held(place->file)) return refuse("stands in an include that is used twice, where nothing can be added");
  if (!deck.offsets_in(place->file))
    return refuse("stands in an include without nodes and shells, so that it isn't known by how much its ids are shifted");
  return place;
}

std::string element_name(const Model& model, ElementClass element_class, std::uint32_t element) {
  return std::string(name(element_class)) + " " + std::to_string(model.elements[static_cast<std::size_t>(element_class)]->id[element]);
}

}  // namespace prismesh::mesh::deck
