// Reads *DEFINE_TRANSFORMATION and composes its steps, which move an include's nodes, to one affine map (LS-DYNA keyword manual, volume I).
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include "mesh/deck/data/deck.h"
#include "mesh/deck/lsdyna/keyword.h"
#include "mesh/deck/lsdyna/parameters.h"

namespace prismesh::mesh::deck::lsdyna {

/// One card of a transformation.
struct TransformStep {
  enum class Kind : std::uint8_t {
    translate,
    translate_along_nodes,
    rotate,
    rotate_about_nodes,
    scale,
    mirror,
    point,
    by_points,
    by_nodes,
    matrix,
    unknown
  };
  Kind kind = Kind::unknown;
  std::array<double, 16> a{};  ///< the card's numbers; a matrix by rows. Node ids are those of the model
  bool readable = true;        ///< false: a field isn't a number, or an unknown parameter
  std::string word;            ///< as the card spells it
};

struct Transformation {
  std::uint32_t file = 0;
  std::size_t offset = 0;  ///< of its keyword
  std::vector<TransformStep> steps;
};

/// Transformations by id. Of equal ids the first counts.
class Transformations {
 public:
  /// Reads a block. `offsets`: of the include it stands in.
  void read(std::string_view text, std::uint32_t file, const Block& block, const Parameters& parameters, const IdOffsets& offsets);
  const Transformation* find(std::int64_t id) const;
  /// The ids of all nodes that any of them names.
  const std::vector<std::int64_t>& nodes() const { return nodes_; }

 private:
  std::map<std::int64_t, Transformation> by_id_;
  std::vector<std::int64_t> nodes_;
};

/// Returns a node's position in the system that the transformation leads to. `so_far`: the steps before the one that names the node, which
/// apply to nodes of the include itself.
using NodePlace = std::function<std::optional<Eigen::Vector3d>(std::int64_t id, const Eigen::Affine3d& so_far)>;

struct ComposedTransformation {
  Eigen::Affine3d map = Eigen::Affine3d::Identity();
  std::string problem;  ///< the first step that couldn't be computed, as the end of a sentence about the transformation; empty: none
};

/// Composes the steps; the first is applied first. A POINT is moved by all steps before the one that names it, wherever it is defined.
ComposedTransformation compose(const Transformation& transformation, const NodePlace& place_of);

}  // namespace prismesh::mesh::deck::lsdyna
