#include "mesh/deck/assembly/undefined_node.h"

#include <string>

namespace prismesh::mesh::deck {

void note_undefined_node(Warnings& warnings, const UndefinedNode& undefined) {
  warnings.note("undefined-node", undefined.file, undefined.offset,
                std::string(undefined.element_class) + " " + std::to_string(undefined.element) + " names node " +
                    std::to_string(undefined.node) + ", which isn't defined; it is left out");
}

}  // namespace prismesh::mesh::deck
