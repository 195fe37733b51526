// *DEFINE_TRANSFORMATION: steps that move an include's nodes, put together to one affine map (LS-DYNA keyword manual, volume I).
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
  std::array<double, 16> a{};  ///< as the card gives them; a matrix by rows. Ids of nodes are those of the model
  bool readable = true;        ///< false: a field isn't a number, or an unknown parameter
  std::string word;            ///< as the card spells it
};

struct Transformation {
  std::uint32_t file = 0;
  std::size_t offset = 0;  ///< of its keyword
  std::vector<TransformStep> steps;
};

/// By id; of equal ids the first counts.
class Transformations {
 public:
  /// `offsets` are those of the include it stands in.
  void read(std::string_view text, std::uint32_t file, const Block& block, const Parameters& parameters, const IdOffsets& offsets);
  const Transformation* find(std::int64_t id) const;
  /// All nodes that any of them names.
  const std::vector<std::int64_t>& nodes() const { return nodes_; }

 private:
  std::map<std::int64_t, Transformation> by_id_;
  std::vector<std::int64_t> nodes_;
};

/// A node's place in the system that the transformation leads to, given the steps before the one that names it (which count for nodes of
/// the include itself).
using NodePlace = std::function<std::optional<Eigen::Vector3d>(std::int64_t id, const Eigen::Affine3d& so_far)>;

struct ComposedTransformation {
  Eigen::Affine3d map = Eigen::Affine3d::Identity();
  std::string problem;  ///< what couldn't be worked out, as the end of a sentence about the transformation; empty: nothing
};

/// The steps one after the other, the first one first. A POINT is moved by all steps before the one that names it, wherever it is defined.
ComposedTransformation compose(const Transformation& transformation, const NodePlace& place_of);

}  // namespace prismesh::mesh::deck::lsdyna
