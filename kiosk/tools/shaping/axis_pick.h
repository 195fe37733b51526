// Picking the axis of a rotation: two nodes, an edge of the surface under the pointer, or a direction of the deck. Costs a pass over the
// shells where an edge is looked at.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "kiosk/render/model_source.h"
#include "kiosk/stereo/pointer.h"
#include "kiosk/tools/shaping/handle.h"

namespace prismesh::kiosk::tools::shaping {

/// The axis through two places; nothing if they are the same.
std::optional<Axis> axis_through(const Vec3& from, const Vec3& to);

struct EdgeAxis {
  Axis axis;
  std::string what;  ///< "free edge", "junction", "crease", "element edge"
};
/// The edge of the shell under the pointer that is nearest to it; free edges, junctions and creases sharper than `crease_degrees` within
/// reach go before edges between elements. Nothing where the shell isn't on the picture.
std::optional<EdgeAxis> edge_at(const render::ModelSource& model, const stereo::Aim& aim, mesh::ShellIndex shell, const input::Pixel& pixel,
                                double crease_degrees);
inline constexpr double kEdgeReachPixels = 40;

/// Two clicks on nodes. The view may move in between.
class AxisPick {
 public:
  bool active() const { return active_; }
  const std::optional<Vec3>& first() const { return first_; }
  void begin();
  void cancel() { *this = {}; }
  /// A node was clicked: the second different one makes the axis, and picking is over.
  std::optional<Axis> clicked(const Vec3& at);

 private:
  bool active_ = false;
  std::optional<Vec3> first_;
};

}  // namespace prismesh::kiosk::tools::shaping
