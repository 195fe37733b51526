// An Abaqus deck of sheets that lie on each other, with and without a solid that new ones can be like.
#pragma once

#include <cstdio>
#include <string>

namespace prismesh::mesh::document {

/// Two sheets of 24 x 4 quads of 5, 1.5 thick, their middles 1.8 apart: the element sets "lower" and "upper". `more`: cards behind them.
inline std::string abaqus_flange(const std::string& more = "", bool with_step = true) {
  std::string nodes, shells;
  char line[128];
  for (int part = 1; part <= 2; ++part) {
    shells += part == 1 ? "*ELEMENT, TYPE=S4, ELSET=lower\n" : "*ELEMENT, TYPE=S4, ELSET=upper\n";
    for (int j = 0; j <= 4; ++j)
      for (int i = 0; i <= 24; ++i) {
        std::snprintf(line, sizeof line, "%d, %g, %g, %g\n", 1000 * part + 1 + i + 25 * j, 5.0 * i, 5.0 * j, 1.8 * (part - 1));
        nodes += line;
      }
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 24; ++i) {
        const int corner = 1000 * part + 1 + i + 25 * j;
        std::snprintf(line, sizeof line, "%d, %d, %d, %d, %d\n", 1000 * part + 1 + i + 24 * j, corner, corner + 1, corner + 26,
                      corner + 25);
        shells += line;
      }
  }
  return "*NODE\n" + nodes + shells +
         "*SHELL SECTION, ELSET=lower, MATERIAL=steel\n1.5,\n*SHELL SECTION, ELSET=upper, MATERIAL=steel\n1.5,\n"
         "*MATERIAL, NAME=steel\n*DENSITY\n7.85E-09\n*ELASTIC\n210000., 0.3\n" +
         more + (with_step ? "*STEP\n*STATIC\n*END STEP\n" : "");
}

/// A hexahedron at the flange's corner, whose section names a set that lists it. Its first face lies on the upper sheet.
inline const std::string kAbaqusBond =
    "*NODE\n80001, 1., 6., 0.75\n80002, 3., 6., 0.75\n80003, 3., 7., 0.75\n80004, 1., 7., 0.75\n80005, 1., 6., 1.05\n80006, 3., 6., "
    "1.05\n80007, 3., 7., 1.05\n80008, 1., 7., 1.05\n"
    "*ELEMENT, TYPE=C3D8R\n   90001,  80005,  80008,  80007,  80006,  80001,  80004,  80003,  80002\n"
    "*ELSET, ELSET=glued\n90001\n*SOLID SECTION, ELSET=glued, MATERIAL=glue\n,\n*MATERIAL, NAME=glue\n*ELASTIC\n2000., 0.4\n"
    "*SURFACE, NAME=up\nglued, S1\n*SURFACE, NAME=on_upper\nupper, SNEG\n*TIE, NAME=t1\nup, on_upper\n";

}  // namespace prismesh::mesh::document
