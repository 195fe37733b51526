#include "mesh/document/drag.h"

#include <algorithm>
#include <cmath>

#include "base/parallel_for.h"
#include "mesh/document/contact_rule.h"
#include "mesh/document/motion.h"
#include "mesh/document/plan_motion.h"
#include "mesh/quality/judge.h"
#include "mesh/quality/shell_properties.h"

namespace prismesh::mesh::document {

namespace {

constexpr std::size_t kDragGrain = 1024;  ///< of a parallel range: some 100 microseconds
constexpr float kFeltComposite = 0.5F;    ///< a worse shell's badness is above 0
constexpr float kWorseBy = 0.005F;        ///< composites that differ by less are the same
constexpr double kTrialStep = 0.01;       ///< of a derivative, in the shell's longest side

/// The source of each corner's coordinates: >= 0 the index of the moving node, < 0 the complement of the fixed point's index.
class Corners {
 public:
  Corners(const Model& model, const NodeSet& moving) : model_(model), moving_(moving) {
    if (moving.size() < model.node_count() / 16) return;
    table_.assign(model.node_count(), -1);
    for (std::size_t i = 0; i < moving.size(); ++i) table_[moving[i].value] = static_cast<std::int32_t>(i);
  }

  std::int32_t operator()(NodeIndex node, std::vector<Vec3>& fixed) const {
    const std::int32_t found = find(node);
    if (found >= 0) return found;
    fixed.push_back(model_.position(node));
    return ~static_cast<std::int32_t>(fixed.size() - 1);
  }

 private:
  std::int32_t find(NodeIndex node) const {
    if (!table_.empty()) return table_[node.value];
    const auto found = std::lower_bound(moving_.begin(), moving_.end(), node);
    return found != moving_.end() && *found == node ? static_cast<std::int32_t>(found - moving_.begin()) : -1;
  }

  const Model& model_;
  const NodeSet& moving_;
  std::vector<std::int32_t> table_;  ///< by NodeIndex; used if a large share of the model moves
};

void add(quality::Counts& counts, quality::ShellState state, std::size_t one) {
  switch (state.grade()) {
    case quality::Grade::ok: counts.ok += one; break;
    case quality::Grade::warn: counts.warn += one; break;
    case quality::Grade::fail: counts.fail += one; break;
  }
}

quality::Counts total(quality::Counts sum, const std::vector<quality::Counts>& parts) {
  for (const quality::Counts& part : parts) {
    sum.ok += part.ok;
    sum.warn += part.warn;
    sum.fail += part.fail;
  }
  return sum;
}

}  // namespace

Result<Drag> Drag::begin(std::shared_ptr<const Generation> base, const Edit& edit, ContactSearch* search) {
  Result<Motion> motion = plan_motion(*base, edit, nullptr);
  if (!motion) return fail(motion.error());
  Drag drag;
  drag.motion_ = std::make_shared<const Motion>(std::move(*motion));
  drag.edit_ = edit;
  if (shaping_of(edit)->contact == ContactRule::keep_apart) drag.contacts_ = std::make_shared<const ContactsOf>(*base, search);
  drag.positions_ = drag.motion_->start;
  const Model& model = base->model;
  drag.shells_ = shells_touching(model, drag.nodes());
  drag.counts_elsewhere_ = base->counts;
  const Corners corners(model, drag.nodes());
  for (const ShellIndex shell : drag.shells_) {
    std::array<std::int32_t, 4> from{};
    const ShellNodes& nodes = model.shell(shell);
    for (std::size_t i = 0; i < 4; ++i) from[i] = i == 3 && nodes.is_triangle() ? from[2] : corners(nodes.node[i], drag.fixed_);
    drag.corners_.push_back(from);
    drag.properties_.push_back(quality::properties_of(model, shell));
    drag.states_.push_back(base->quality[shell.value]);
    add(drag.counts_elsewhere_, drag.states_.back(), static_cast<std::size_t>(-1));
  }
  drag.counts_ = base->counts;
  drag.base_ = std::move(base);
  return drag;
}

const NodeSet& Drag::nodes() const { return motion_->nodes; }
NodeIndex Drag::grab() const { return motion_->grab; }
const Vec3& Drag::normal() const { return motion_->normal; }

void Drag::step(const Displacement& displacement) {
  if (!displacement.by.allFinite() || !std::isfinite(displacement.distance) || !std::isfinite(displacement.degrees)) return;
  std::vector<Vec3> positions(positions_.size());
  const ContactRule rule = contacts_ != nullptr ? ContactRule::keep_apart : ContactRule::allow;
  const AllowedWay way = positions_under(rule, contacts_.get(), *motion_, displacement, positions);
  if (!std::all_of(positions.begin(), positions.end(), [](const Vec3& position) { return position.allFinite(); })) return;
  displacement_ = displacement;
  share_ = way.share;
  positions_ = std::move(positions);
  const quality::LimitsByPart limits = quality::limits_for(sized(*base_->judging));
  std::vector<quality::Counts> counts((corners_.size() + kDragGrain - 1) / kDragGrain);
  parallel_for(corners_.size(), kDragGrain, [&](std::size_t begin, std::size_t end) {
    const std::size_t count = end - begin;
    quality::judge_points({positions_, fixed_, std::span(corners_).subspan(begin, count), std::span(properties_).subspan(begin, count)},
                          limits, std::span(states_).subspan(begin, count));
    quality::Counts sum;
    for (std::size_t s = begin; s < end; ++s) add(sum, states_[s], 1);
    counts[begin / kDragGrain] = sum;
  });
  counts_ = total(counts_elsewhere_, counts);
}

std::vector<float> Drag::composites_at(std::span<const Vec3> positions) const {
  const quality::LimitsByPart limits = quality::limits_for(sized(*base_->judging));
  std::vector<float> composites(corners_.size());
  std::vector<quality::ShellState> states(corners_.size());
  parallel_for(corners_.size(), kDragGrain, [&](std::size_t begin, std::size_t end) {
    const std::size_t count = end - begin;
    quality::judge_points({positions, fixed_, std::span(corners_).subspan(begin, count), std::span(properties_).subspan(begin, count)},
                          limits, std::span(states).subspan(begin, count), std::span(composites).subspan(begin, count));
  });
  return composites;
}

Worsening Drag::worsening() {
  if (composites_before_.empty()) composites_before_ = composites_at(motion_->start);
  const std::vector<float>& before = composites_before_;
  const std::vector<float> now = composites_at(positions_);
  std::size_t worst = now.size();
  for (std::size_t s = 0; s < now.size(); ++s)
    if (now[s] < before[s] - kWorseBy && (worst == now.size() || now[s] < now[worst])) worst = s;
  if (worst == now.size() || now[worst] >= kFeltComposite) return {};
  const double badness = std::min(1.0, (kFeltComposite - static_cast<double>(now[worst])) / kFeltComposite);
  return {badness, worsening_direction(worst, now[worst])};
}

/// Moves on by a small step along each axis, and takes the shell's composites there.
Vec3 Drag::worsening_direction(std::size_t shell, float composite) const {
  if (motion_->kind != ShapingKind::translate && motion_->kind != ShapingKind::move) return Vec3::Zero();
  const std::array<std::int32_t, 4>& corners = corners_[shell];
  const auto at = [&](std::size_t corner) {
    const std::int32_t from = corners[corner];
    return from >= 0 ? positions_[static_cast<std::size_t>(from)] : fixed_[static_cast<std::size_t>(-1 - from)];
  };
  double longest = 0;
  for (std::size_t corner = 0; corner < 4; ++corner) longest = std::max(longest, (at((corner + 1) % 4) - at(corner)).norm());
  const double step = kTrialStep * longest;
  if (!(step > 0) || !std::isfinite(step)) return Vec3::Zero();

  const quality::LimitsByPart limits = quality::limits_for(sized(*base_->judging));
  std::vector<Vec3> positions(positions_.size());
  Vec3 slope;
  for (int axis = 0; axis < 3; ++axis) {
    Displacement moved = share_of(displacement_, share_);
    moved.by[axis] += step;
    positions_at(*motion_, moved, positions);
    quality::ShellState state;
    float there = composite;
    quality::judge_points({positions, fixed_, std::span(&corners, 1), std::span(&properties_[shell], 1)}, limits, std::span(&state, 1),
                          std::span(&there, 1));
    slope[axis] = static_cast<double>(there) - static_cast<double>(composite);
  }
  const double steepness = slope.norm();
  return steepness > 1e-6 ? Vec3(-slope / steepness) : Vec3(Vec3::Zero());
}

Edit Drag::edit() const {
  Edit edit = edit_;
  set_displacement(edit, displacement_);
  Shaping* shaping = shaping_of(edit);
  const Vec3& at = base_->model.position(grab());
  shaping->grab = base_->model.node_ids[grab().value];
  shaping->grab_at = std::array<double, 3>{at.x(), at.y(), at.z()};
  return edit;
}

}  // namespace prismesh::mesh::document
