#include "kiosk/tools/shaping/axis_pick.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>

#include "kiosk/toolkit/seen_shell.h"

namespace prismesh::kiosk::tools::shaping {

namespace {

using ipc::SnapshotArray;
using mesh::NodeIndex;
using mesh::ShellNodes;
using render::ModelSource;

struct Edge {
  NodeIndex a, b;
  double pixels = 0;  ///< from the pointer
  /// Unit normals of the shells at the edge, turned as if these ran against each other along it.
  std::vector<Vec3> normals;
};

Vec3 position(const ModelSource& model, NodeIndex node) { return model.at<Vec3>(SnapshotArray::positions, node.value); }

Vec3 normal_of(const ModelSource& model, const ShellNodes& shell) {
  const Vec3 normal = (position(model, shell.node[2]) - position(model, shell.node[0]))
                          .cross(position(model, shell.node[3]) - position(model, shell.node[1]));
  const double length = normal.norm();
  return length > 0 ? Vec3(normal / length) : normal;
}

/// +1: the shell runs from a to b; -1: from b to a; 0: it hasn't got the edge.
int sense_of(const ShellNodes& shell, const Edge& edge) {
  for (std::size_t i = 0; i < 4; ++i) {
    if (shell.node[i] == edge.a && shell.node[(i + 1) % 4] == edge.b) return 1;
    if (shell.node[i] == edge.b && shell.node[(i + 1) % 4] == edge.a) return -1;
  }
  return 0;
}

std::string what_is(const Edge& edge, double crease_degrees) {
  if (edge.normals.size() < 2) return "free edge";
  if (edge.normals.size() > 2) return "junction";
  const double cosine = std::clamp(edge.normals[0].dot(edge.normals[1]), -1.0, 1.0);
  return std::acos(cosine) * 180 / std::numbers::pi > crease_degrees ? "crease" : "element edge";
}

}  // namespace

std::optional<Axis> axis_through(const Vec3& from, const Vec3& to) {
  const Vec3 way = to - from;
  const double length = way.norm();
  if (!(length > 0) || !std::isfinite(length)) return std::nullopt;
  return Axis{from, way / length};
}

std::optional<EdgeAxis> edge_at(const ModelSource& model, const stereo::Aim& aim, mesh::ShellIndex shell, const input::Pixel& pixel,
                                double crease_degrees) {
  if (shell.value >= model.size(SnapshotArray::shell_nodes)) return std::nullopt;
  const auto nodes = model.at<ShellNodes>(SnapshotArray::shell_nodes, shell.value);
  if (!toolkit::is_whole(model, nodes)) return std::nullopt;
  std::vector<Edge> edges;
  for (std::size_t i = 0; i < 4; ++i) {
    Edge edge{nodes.node[i], nodes.node[(i + 1) % 4], 0, {}};
    const auto from = stereo::pixel_of(aim, position(model, edge.a)), to = stereo::pixel_of(aim, position(model, edge.b));
    if (edge.a == edge.b || !from || !to) continue;  // a triangle has its last corner twice
    edge.pixels = toolkit::pixels_from_line(*from, *to, pixel);
    edges.push_back(edge);
  }
  for (std::size_t c = 0; c < model.chunk_count(SnapshotArray::shell_nodes); ++c)
    for (const ShellNodes& each : model.chunk<ShellNodes>(SnapshotArray::shell_nodes, c))
      for (Edge& edge : edges)
        if (const int sense = sense_of(each, edge); sense != 0 && toolkit::is_whole(model, each))
          edge.normals.push_back(normal_of(model, each) * sense * (edge.normals.empty() ? 1 : -1));
  const Edge* best = nullptr;
  double best_rank = 0;
  for (const Edge& edge : edges) {
    const bool plain = what_is(edge, crease_degrees) == "element edge";
    const double rank = edge.pixels - (!plain && edge.pixels <= kEdgeReachPixels ? 2 * kEdgeReachPixels : 0);
    if (best == nullptr || rank < best_rank) best = &edge, best_rank = rank;
  }
  if (best == nullptr) return std::nullopt;
  const std::optional<Axis> axis = axis_through(position(model, best->a), position(model, best->b));
  return axis ? std::optional(EdgeAxis{*axis, what_is(*best, crease_degrees)}) : std::nullopt;
}

void AxisPick::begin() {
  active_ = true;
  first_.reset();
}

std::optional<Axis> AxisPick::clicked(const Vec3& at) {
  if (!active_) return std::nullopt;
  if (!first_) {
    first_ = at;
    return std::nullopt;
  }
  const std::optional<Axis> axis = axis_through(*first_, at);
  if (axis) cancel();
  return axis;
}

}  // namespace prismesh::kiosk::tools::shaping
