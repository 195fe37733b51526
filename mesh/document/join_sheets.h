// What edits that join sheets have in common: welds and bonds. Private to mesh/document.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "base/error.h"
#include "mesh/connections/weld_spots.h"
#include "mesh/document/document.h"
#include "mesh/document/edit_report.h"
#include "mesh/model/topology_change.h"

namespace prismesh::mesh::document {

/// "part:7".
std::string sheet_part_words(const Model& model, PartIndex part);

/// "beam:9" as a class and an id.
struct NamedElement {
  ElementClass element_class = ElementClass::beam;
  std::int64_t id = 0;
};

/// `wanted` ends the error, as `a weld, as "beam:9"`; `who`, here and below, begins it: the edit's name.
Result<NamedElement> parse_element(const std::string& text, const std::string& who, const std::string& wanted);

/// The element's index in its class. Errors: there is none, or it is left out.
Result<std::uint32_t> index_of_element(const Document& document, const NamedElement& wanted, const std::string& who);

/// Where joints are already, by cells of a grid.
class PlacesTaken {
 public:
  /// `cell`: places nearer than this are near; 0: none is.
  explicit PlacesTaken(double cell) : cell_(cell) {}
  void add(const Vec3& at);
  bool near(const Vec3& at) const;

 private:
  std::array<std::int64_t, 3> cell_of(const Vec3& at) const;

  double cell_;
  std::map<std::array<std::int64_t, 3>, std::vector<Vec3>> cells_;
};

/// Errors: one of the parts is locked. `what` would be added to it.
Result<void> refuse_locked(const Generation& generation, const std::vector<PartIndex>& parts, const std::string& what,
                           const std::string& who);

/// The corner of the shell that the place is nearest to.
NodeOrigin corner_origin(const Model& model, const connections::SheetAtSpot& sheet);

/// Says which sheets no contact ties to the part that new elements join. `what` they are: "welds".
void note_untied(const Document& document, PartIndex part, const std::vector<PartIndex>& sheets, const std::string& what,
                 EditReport& report);

}  // namespace prismesh::mesh::document
