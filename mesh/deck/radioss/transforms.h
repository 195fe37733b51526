// Reads and applies /TRANSFORM, which moves the nodes of submodels and node groups when the solver starts. Frames show them there.
// Source: Radioss Reference Guide, "/TRANSFORM/TRA", "ROT", "SYM", "SCA", "MATRIX", "POSITION", "/GRNOD".
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "mesh/deck/assembly/deck_contents.h"
#include "mesh/deck/data/frame.h"
#include "mesh/deck/radioss/definitions.h"

namespace prismesh::mesh::deck::radioss {

/// A card of /TRANSFORM. Lengths are in the main file's unit, ids those of the model.
struct Transform {
  enum class Kind : std::uint8_t { translation, rotation, symmetry, scaling, matrix, position, unknown };
  Kind kind = Kind::unknown;
  std::int64_t group = 0;
  std::int64_t submodel = 0;
  std::array<std::int64_t, 6> nodes{};
  std::array<Eigen::Vector3d, 6> points{};  ///< translation and scaling: the first; matrix: its rows, then the translation
  double angle_degrees = 0;
  bool readable = true;
  std::uint32_t file = 0;
  std::size_t offset = 0;
};
Transform read_transform(const Block& block, const Keyword& keyword, const DeckTables& tables);

/// The map of a card whose nodes are at `at` (nullopt: the node isn't defined). nullopt: the map can't be computed.
std::optional<Eigen::Affine3d> affine_of(const Transform& transform, const std::array<std::optional<Eigen::Vector3d>, 6>& at);

/// Applies cards in their order: changes and adds frames, and gives runs of nodes other frames. Holds nodes whose position can't be
/// computed and nodes that a card's map depends on.
class Transformer {
 public:
  /// `frame_context`: the submodel of each frame. `groups`: /GRNOD blocks by id.
  Transformer(DeckContents& found, std::vector<std::uint32_t>& frame_context, const DeckTables& tables,
              const std::map<std::int64_t, const Block*>& groups)
      : found_(found), frame_context_(frame_context), tables_(tables), groups_(groups) {}
  void run(const std::vector<Transform>& transforms);

 private:
  /// A node that a card names, and where it was read.
  struct NamedNode {
    std::int64_t id = 0;
    std::uint32_t piece = 0;
    std::uint32_t node = 0;
    bool found = false;
  };
  /// GroupMembers of a node group.
  struct GroupMembers {
    std::vector<std::array<std::int64_t, 3>> ranges;  ///< first, last, step
    std::vector<std::int64_t> ids;                    ///< sorted at the end
    std::vector<std::int64_t> without;                ///< sorted at the end
    bool has(std::int64_t id) const;
  };
  void find_named(const std::vector<Transform>& transforms);
  std::optional<Eigen::Vector3d> position(std::int64_t node) const;
  void move_submodel(const Transform& transform, const Eigen::Affine3d& map);
  void move_group(const GroupMembers& members, const Eigen::Affine3d& map);
  void hold(const Transform& transform, const GroupMembers* members);
  bool in_submodel(std::uint32_t frame, std::int64_t submodel) const;
  bool collect(std::int64_t group, int depth, GroupMembers& members);
  void collect_parts(const std::vector<std::int64_t>& parts, GroupMembers& members);

  DeckContents& found_;
  std::vector<std::uint32_t>& frame_context_;
  const DeckTables& tables_;
  const std::map<std::int64_t, const Block*>& groups_;
  std::vector<NamedNode> named_;
  std::set<std::int64_t> held_;  ///< submodels whose nodes are all held; 0: all nodes are
  std::size_t work_ = 0;
};

}  // namespace prismesh::mesh::deck::radioss
