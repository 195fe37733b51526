// The measures that stay, by the ids of their nodes. Knows no picture.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "mesh/measure/lengths.h"

namespace prismesh::kiosk::tools::measuring {

/// Between two nodes, or at three.
struct Measure {
  std::vector<std::int64_t> ids;
  std::vector<mesh::NodeIndex> nodes;                    ///< of the shown state; empty: one of them isn't there
  std::optional<mesh::measure::NodeMeasures> figures{};  ///< of `nodes`; nothing: not computed yet
};

/// The node with an id; nothing: it isn't there. `last`: where it was.
using FindNode = std::function<std::optional<mesh::NodeIndex>(std::int64_t id, std::optional<mesh::NodeIndex> last)>;

class MeasureList {
 public:
  const std::vector<Measure>& all() const { return all_; }
  /// The one that isn't complete.
  const Measure& begun() const { return begun_; }

  /// Adds a node to the measure that is begun, which is complete with so many nodes. A node twice in a row is ignored. True: a measure is
  /// complete.
  bool pick(std::int64_t id, mesh::NodeIndex node, std::size_t nodes);
  /// Gives up the measure that is begun; false: none was.
  bool give_up();
  void remove(std::size_t index);
  void clear();

  /// Another state is shown: finds the nodes again; no figures are known.
  void follow(const FindNode& find);
  /// Computes what isn't known. `model`: the shown state; `hidden`: by PartIndex, 1 = hidden. True: something was.
  bool compute(const mesh::Model& model, mesh::OutOfSight hidden);

 private:
  std::vector<Measure> all_;
  Measure begun_;
};

/// "nodes 1 → 31".
std::string measure_title(const Measure& measure);
/// What stands beside it in the picture: "22.36 mm", "90° R 11.18 mm".
std::string measure_label(const Measure& measure, const std::string& unit);
/// What else is known, a line each: "x 20, y 0, z 10 mm", "along the surface 30 mm".
std::vector<std::string> measure_details(const Measure& measure, const std::string& unit);

}  // namespace prismesh::kiosk::tools::measuring
