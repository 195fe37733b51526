// Decks of sheets that lie on each other, with and without a weld that new ones can be like.
#pragma once

#include <cstdio>
#include <string>

#include "tests/mesh/document/document_fixture.h"

namespace prismesh::mesh::document {

/// A sheet of 24 x 4 quads of 5 at a height; its ids begin behind 1000 times its part's.
inline void add_sheet(int part, double z, std::string& nodes, std::string& shells) {
  char line[128];
  for (int j = 0; j <= 4; ++j)
    for (int i = 0; i <= 24; ++i) {
      std::snprintf(line, sizeof line, "%8d%16.6f%16.6f%16.6f\n", 1000 * part + 1 + i + 25 * j, 5.0 * i, 5.0 * j, z);
      nodes += line;
    }
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 24; ++i) {
      const int corner = 1000 * part + 1 + i + 25 * j;
      std::snprintf(line, sizeof line, "%8d%8d%8d%8d%8d%8d\n", 1000 * part + 1 + i + 24 * j, part, corner, corner + 1, corner + 26,
                    corner + 25);
      shells += line;
    }
}

inline constexpr const char* kPartsOfSheets =
    "*PART\nlower\n         1         1         1\n*PART\nupper\n         2         1         1\n*PART\nthird\n         3         1        "
    " 1\n"
    "*SECTION_SHELL\n         1         2\n       1.5       1.5       1.5       1.5\n"
    "*MAT_ELASTIC\n         1  7.85E-09    210000       0.3\n";

/// `sheets` sheets of 1.5 at distances of 1.5, parts 1 and on, a flange of 120 x 20; a set of all nodes of the lowest. `welds`: more cards
/// before *END.
inline std::string flange_deck(int sheets = 2, const std::string& welds = "") {
  std::string nodes, shells;
  for (int sheet = 0; sheet < sheets; ++sheet) add_sheet(1 + sheet, 1.5 * sheet, nodes, shells);
  return "*KEYWORD\n*NODE\n" + nodes + "*ELEMENT_SHELL\n" + shells + kPartsOfSheets +
         "*SET_NODE_LIST\n         7\n      1001      1002      1026      1027\n" + welds + "*END\n";
}

/// A weld at (5, 10) with everything that it needs, of part 90.
inline const std::string kOneWeld =
    "*NODE\n   80001             5.0            10.0             0.0\n   80002             5.0            10.0             1.5\n"
    "*ELEMENT_BEAM\n   90001      90   80001   80002       0       0       0       0       0       2\n"
    "*PART\nspot welds\n        90        90        90\n"
    "*SECTION_BEAM\n        90         9       1.0         2\n       6.0       6.0\n"
    "*MAT_SPOTWELD\n        90  7.85E-09  210000.0       0.3     300.0    2100.0\n"
    "*SET_PART_LIST\n        90\n        90\n"
    "*CONTACT_SPOTWELD\n        90         1         2         0\n\n\n\n";

inline Document open_deck(const std::filesystem::path& path, const std::string& text) {
  put_content(path, text);
  OpenOptions options;
  options.length_unit = LengthUnit::mm;
  return open(path, options).value();
}

}  // namespace prismesh::mesh::document
