// The two sides of a region: which of their shells can meet, the way out, and how much of it is missing. Private to mesh/contact.
#pragma once

#include <array>
#include <map>

#include "mesh/contact/meant_region.h"
#include "mesh/contact/separation.h"
#include "mesh/contact/shell_triangles.h"
#include "mesh/contact/spread_lifts.h"
#include "mesh/spatial/box_tree.h"
#include "mesh/spatial/closest_point.h"

namespace prismesh::mesh::contact {

/// How far each node of the two sides is moved: the upper side's along the directions, the lower side's against them.
struct SideLifts {
  Lifts upper, lower;
};

class FacingSides {
 public:
  /// `model` and `tree`: as they are before the region is separated; they must outlive it. `each_its_own`: every node has the direction of
  /// the surface above which it is; else all go along one direction.
  FacingSides(const SeparationInput& input, const SeparationWish& wish, const Model& model, const spatial::BoxTree& tree,
              const MeantRegion& region, bool each_its_own);

  /// Adds to `needed` what the sides miss as they stand in `moved`, where they have been moved by `now`. The upper side takes its share.
  /// Returns the longest lift that is missing.
  double add_missing(const Model& moved, const SideLifts& now, double upper_share, SideLifts& needed);

  /// Adds to `needed` what each node of the two sides misses by itself, as they stand before: less than add_missing() does, which moves all
  /// corners of a triangle as far as its worst point must go. Nodes that stay are left out.
  void add_missing_of_nodes(double upper_share, SideLifts& needed) const;

  const ShellSet& upper() const { return upper_; }
  const ShellSet& lower() const { return lower_; }
  double reach() const { return reach_; }               ///< the greatest least distance
  const Vec3& direction() const { return direction_; }  ///< the mean
  /// Whether a shell of the region, or one at a node that enters, stands steeply on the way out: more than 60 degrees from facing it.
  bool any_stands() const;
  double cos_of_wish() const { return cos_of_wish_; }  ///< between the wished direction and the mean; 1 without a wish
  /// The least distance of two shells.
  double least(ShellIndex a, ShellIndex b) const;

 private:
  struct OwnWay {
    Vec3 direction;
    double weight = 0;
  };
  struct CornerLift {
    double length = 0;
    std::array<bool, 3> corners{true, true, true};  ///< which move
  };
  OwnWay way_at(const spatial::ShellTree& lower, NodeIndex node) const;
  Vec3 mean_way(const spatial::ShellTree& lower, const NodeSet& nodes) const;
  void grow_lower(const Vec3& direction);
  void find_own_ways();
  Vec3 way_of(NodeIndex node) const;
  bool is_entering(NodeIndex node) const;
  CornerLift lift_of(const ShellTriangle& moving, const ShellTriangle& fixed, const Vec3& way, double apart) const;
  void add_missing_of_nodes(const ShellSet& moving, const ShellSet& fixed, double sign, double share, Lifts& needed) const;
  double lift_upper(const Model& moved, const SideLifts& now, double upper_share, SideLifts& needed);
  double lift_shell(const Model& moved, const SideLifts& now, double upper_share, ShellIndex shell, SideLifts& needed);

  const SeparationInput& input_;
  const SeparationWish& wish_;
  const Model& model_;
  const spatial::BoxTree& tree_;
  const MeantRegion& region_;
  ShellSet upper_, lower_;  ///< ascending
  double reach_ = 0;
  double top_ = 0;  ///< how far the lower side reaches along the direction
  Vec3 direction_ = Vec3::UnitZ();
  double cos_of_wish_ = 1;
  double lower_moved_ = 0;              ///< the farthest of its nodes, in the current measurement
  std::map<NodeIndex, Vec3> own_ways_;  ///< empty: all have the mean one
};

}  // namespace prismesh::mesh::contact
