// The proxy: a point that stays on its side of all shells while the pen goes through them. The pen is pulled toward it.
//
// Why it never passes a shell. The proxy carries a proved clearance: no shell is nearer than that. A step from p to q is taken only if the
// clearances of both together are longer than the step. A point of the step at a way t from p lies closer to p than p's clearance, or
// closer to q than q's; so no shell is there. It doesn't matter which shells there are, so it holds for edges, corners, holes and
// junctions, from either side. Where the contact distance is 1.5 spacings and steps are at most half a spacing, the bound of the field
// (field.h) leaves a clearance of 0.63 spacings, so the condition always holds within a brick and the proxy never gets stuck by it.
//
// Between two generations of the mesh the shells move on straight lines. If no corner moves as far as the clearance, the proxy stays where
// it is. Else it is carried through the motion in parts of time, each so short that the clearance lasts, and is pushed ahead of what comes
// near. Where nothing is proved any more (it is pinched between shells, or data is missing), the proxy lets go: no force, until the pen is
// clear of shells by itself.
//
// After the god-object and the virtual proxy [Zilles 1995] [Ruspini 1997], on a distance field instead of a mesh: the time of a tick
// doesn't depend on the mesh.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

#include "base/haptic_field.h"
#include "drivers/haptics/field.h"

namespace prismesh::drivers::haptics {

inline constexpr double kContactSpacings = 1.5;  ///< the proxy stays so far from shells
inline constexpr double kStepSpacings = 0.5;     ///< max. length of a step
inline constexpr int kMaxProxySteps = 64;        ///< a tick
inline constexpr int kMaxCarrySteps = 128;       ///< parts of a motion

/// Every place of the proxy in a tick, for tests.
struct ProxyPath {
  std::array<Eigen::Vector3d, 2 * (kMaxProxySteps + kMaxCarrySteps) + 8> places_mm;
  std::array<double, 2 * (kMaxProxySteps + kMaxCarrySteps) + 8> part;  ///< of the shells' motion at that place
  std::size_t count = 0;
};

struct ProxyContact {
  bool attached = false;  ///< the proxy is in use; false: outside of the field, or let go
  bool touching = false;  ///< shells hold it back
  bool let_go = false;    ///< in this tick
  Eigen::Vector3d proxy_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< away from the shells that hold it; a unit vector where it touches
  std::int32_t element = -1;                         ///< what it touches: the mesh's index
  int steps = 0;
};

class Proxy {
 public:
  /// Moves the proxy toward the pen. `field` null or unusable: lets go. `friction`: Coulomb's coefficient between proxy and shells, 0 and
  /// more. Constant time.
  ProxyContact step(const HapticField* field, const Eigen::Vector3d& pen_mm, double friction, ProxyPath* path = nullptr);
  void let_go() { attached_ = false; }

 private:
  bool follow_field(const HapticField& field, ProxyPath* path);
  bool carry(const HapticField& field, ProxyPath* path);
  bool push_away(const HapticField& field, double part, double hold_mm, MovedNearest& nearest, ProxyPath* path);
  void attach(const HapticField& field, const Eigen::Vector3d& pen_mm);
  bool try_step(const HapticField& field, const Eigen::Vector3d& to_mm, FieldSample* there);
  void rise_to_contact(const HapticField& field);
  bool walk_step(const HapticField& field, const Eigen::Vector3d& pen_mm, double friction, ProxyContact& contact);
  bool slide(const HapticField& field, const Eigen::Vector3d& pen_mm, const Eigen::Vector3d& normal, double friction);
  static void note(ProxyPath* path, const Eigen::Vector3d& place_mm, double part);

  bool attached_ = false;
  Eigen::Vector3d place_mm_ = Eigen::Vector3d::Zero();
  FieldSample here_;         ///< of the field at the place
  double clearance_mm_ = 0;  ///< proved
  double static_mm_ = 0;     ///< while shells move: proved for those that don't
  std::uint64_t generation_ = 0, placement_ = 0, number_ = 0;
};

}  // namespace prismesh::drivers::haptics
