// An LS-DYNA deck of parallel sheets and what is between them, for tests.
#pragma once

#include <cstdio>
#include <string>

namespace prismesh::mesh::document {

/// An LS-DYNA deck of sheets and what lies on them, written card by card.
class DeckText {
 public:
  void node(int id, double x, double y, double z) { add(nodes_, "%8d%16.6f%16.6f%16.6f\n", id, x, y, z); }
  /// 4 x 4 shells of 10 with nodes first .. first + 24 in the plane z.
  void sheet(int part, int first, double z) {
    for (int j = 0; j <= 4; ++j)
      for (int i = 0; i <= 4; ++i) node(first + i + 5 * j, 10.0 * i, 10.0 * j, z);
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 4; ++i) {
        const int corner = first + i + 5 * j;
        add(shells_, "%8d%8d%8d%8d%8d%8d\n", first + i + 4 * j, part, corner, corner + 1, corner + 6, corner + 5);
      }
    this->part(part);
  }
  /// Of the nodes first .. first + 3.
  void shell(int id, int part, int first) { add(shells_, "%8d%8d%8d%8d%8d%8d\n", id, part, first, first + 1, first + 2, first + 3); }
  void beam(int id, int part, int a, int b) { add(beams_, "%8d%8d%8d%8d%8d\n", id, part, a, b, 0); }
  void part(int id) { add(parts_, "*PART\npart %d\n%10d%10d%10d\n", id, id, 1, 1); }
  void cards(const std::string& text) { more_ += text; }
  std::string text() const {
    return "*KEYWORD\n" + parts_ + "*SECTION_SHELL\n         1         2\n       1.0       1.0       1.0       1.0\n" +
           "*MAT_ELASTIC\n         1    7.9E-9    210000       0.3\n*NODE\n" + nodes_ + "*ELEMENT_SHELL\n" + shells_ +
           (beams_.empty() ? "" : "*ELEMENT_BEAM\n" + beams_) + more_ + "*END\n";
  }

 private:
  template <class... Values>
  static void add(std::string& to, const char* format, Values... values) {
    char line[200];
    std::snprintf(line, sizeof line, format, values...);
    to += line;
  }
  std::string nodes_, shells_, beams_, parts_, more_;
};

}  // namespace prismesh::mesh::document
