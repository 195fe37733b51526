#include "kiosk/tools/mesh_operations/by_hand.h"

#include "kiosk/toolkit/seen_shell.h"

namespace prismesh::kiosk::tools::mesh_operations {

namespace {

using input::Pixel;

using ipc::SnapshotArray;
using mesh::NodeIndex;
using mesh::ShellNodes;
using mesh::repair::Operation;
using render::ModelSource;

constexpr double kEdgeShare = 0.2;  ///< of the way from an edge to the middle: nearer means the edge

struct SeenEdge {
  NodeIndex a, b;
  double nearness = 0;  ///< 0 on the edge, 1 in the shell's middle
};

std::optional<SeenEdge> nearest_edge(const ModelSource& model, const stereo::Aim& aim, const ShellNodes& shell, const Pixel& pixel) {
  const auto corners = static_cast<std::size_t>(shell.corners());
  std::vector<Pixel> seen;
  Pixel middle = Pixel::Zero();
  for (std::size_t k = 0; k < corners; ++k) {
    const auto at = stereo::pixel_of(aim, model.at<mesh::Vec3>(SnapshotArray::positions, shell.node[k].value));
    if (!at) return std::nullopt;
    seen.push_back(*at);
    middle += *at / static_cast<double>(corners);
  }
  std::optional<SeenEdge> nearest;
  double least = 0;
  for (std::size_t k = 0; k < corners; ++k) {
    const std::size_t next = (k + 1) % corners;
    if (shell.node[k] == shell.node[next]) continue;
    const double pixels = toolkit::pixels_from_line(seen[k], seen[next], pixel),
                 deep = toolkit::pixels_from_line(seen[k], seen[next], middle);
    if (nearest && pixels >= least) continue;
    least = pixels;
    nearest = SeenEdge{shell.node[k], shell.node[next], deep > 0 ? pixels / deep : 0};
  }
  return nearest;
}

bool has_edge(const ShellNodes& shell, NodeIndex a, NodeIndex b) {
  const auto corners = static_cast<std::size_t>(shell.corners());
  for (std::size_t k = 0; k < corners; ++k) {
    const NodeIndex from = shell.node[k], to = shell.node[(k + 1) % corners];
    if ((from == a && to == b) || (from == b && to == a)) return true;
  }
  return false;
}

/// The shell first, then the others at the edge.
std::vector<mesh::ShellIndex> shells_at(const ModelSource& model, mesh::ShellIndex shell, const SeenEdge& edge) {
  std::vector<mesh::ShellIndex> shells{shell};
  std::size_t first = 0;
  for (std::size_t c = 0; c < model.chunk_count(SnapshotArray::shell_nodes); ++c)
    for (const ShellNodes& other : model.chunk<ShellNodes>(SnapshotArray::shell_nodes, c)) {
      if (first != shell.value && has_edge(other, edge.a, edge.b)) shells.emplace_back(first);
      ++first;
    }
  return shells;
}

}  // namespace

std::optional<HandTarget> hand_target(const ModelSource& model, const stereo::Aim& aim, Operation operation, mesh::ShellIndex shell,
                                      const Pixel& pixel) {
  if (shell.value >= model.size(SnapshotArray::shell_nodes)) return std::nullopt;
  const auto nodes = model.at<ShellNodes>(SnapshotArray::shell_nodes, shell.value);
  if (!toolkit::is_whole(model, nodes)) return std::nullopt;
  const std::optional<SeenEdge> edge = nearest_edge(model, aim, nodes, pixel);
  if (!edge) return std::nullopt;
  if (operation == Operation::collapse) return HandTarget{{}, {edge->a, edge->b}};
  if (operation == Operation::split && edge->nearness > kEdgeShare) return HandTarget{{shell}, {}};
  HandTarget target{shells_at(model, shell, *edge), {}};
  if (operation == Operation::split && target.shells.size() != 2) target.shells = {shell};
  return target;
}

}  // namespace prismesh::kiosk::tools::mesh_operations
