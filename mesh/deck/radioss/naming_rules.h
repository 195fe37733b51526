// The table of the keywords whose blocks name nodes, elements or parts.
// Source: Radioss Reference Guide, the pages of the keywords.
#pragma once

#include "mesh/deck/radioss/block.h"
#include "mesh/deck/radioss/naming_rule.h"

namespace prismesh::mesh::deck::radioss {

/// The rule whose words the keyword begins with; of several the one with the most words; one of `unknown` where there is none.
NamingRule naming_rule(const Keyword& keyword);

}  // namespace prismesh::mesh::deck::radioss
