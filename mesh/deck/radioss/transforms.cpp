#include "mesh/deck/radioss/transforms.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::radioss {
namespace {

using Eigen::Affine3d;
using Eigen::Vector3d;
using Kind = Transform::Kind;

/// Limit of the frames and nodes that all cards together visit. No real deck reaches it.
constexpr std::size_t kMaxWork = std::size_t{1} << 28;
constexpr int kMaxGroupDepth = 16;
constexpr double kMinScale = 1e-6;     ///< a smaller factor, or one above its inverse, is a mistake
constexpr double kOrthonormal = 1e-3;  ///< tolerance for a matrix to be a rotation or a reflection

Kind kind_of(std::string_view word) {
  if (word == "TRA") return Kind::translation;
  if (word == "ROT") return Kind::rotation;
  if (word == "SYM") return Kind::symmetry;
  if (word == "SCA") return Kind::scaling;
  if (word == "MATRIX") return Kind::matrix;
  if (word == "POSITION") return Kind::position;
  return Kind::unknown;
}

/// Reads a transformation's cards.
class CardReader {
 public:
  CardReader(const Block& block, const DeckTables& tables, double unit, Transform& out)
      : tables_(tables),
        block_(block),
        unit_(unit),
        lines_(tables.files, block),
        width_(tables.contexts[block.context].field_width()),
        out_(out) {}

  void run() {
    if (!lines_.next(line_) || !next()) return;
    out_.group = id(0, tables_.contexts[block_.context].added.set);
    if (out_.kind == Kind::position) return read_position();
    const std::int64_t node_offset = tables_.contexts[block_.context].added.node;
    out_.submodel = id(9, 0);
    if (out_.kind == Kind::matrix) return read_matrix();
    out_.nodes[0] = id(7, node_offset);
    if (out_.kind != Kind::scaling) out_.nodes[1] = id(8, node_offset);
    out_.points[0] = vector(1) * (out_.kind == Kind::scaling ? 1 : unit_);
    if (out_.kind != Kind::rotation && out_.kind != Kind::symmetry) return;
    if (!next()) return;
    out_.points[1] = vector(1) * unit_;
    if (out_.kind == Kind::rotation) out_.angle_degrees = real(7);
  }

 private:
  bool next() {
    const bool there = lines_.next(line_);
    out_.readable &= there;
    return there;
  }
  double real(std::size_t first) {
    const auto value = tables_.parameters.real(field(line_.text, width_, first, 2), tables_.contexts, block_.context);
    out_.readable &= value.has_value();
    return value.value_or(0);
  }
  std::int64_t id(std::size_t first, std::int64_t added) {
    const auto value = tables_.parameters.integer(field(line_.text, width_, first), tables_.contexts, block_.context);
    out_.readable &= value.has_value();
    return value && *value > 0 ? *value + added : 0;
  }
  Vector3d vector(std::size_t first) { return {real(first), real(first + 2), real(first + 4)}; }

  void read_matrix() {
    for (std::size_t row = 0; row < 3; ++row) {
      if (row > 0 && !next()) return;
      out_.points[row] = vector(1);
      out_.points[3][static_cast<Eigen::Index>(row)] = real(7) * unit_;
    }
  }

  /// Six nodes, or six points on cards of their own, each of three numbers.
  void read_position() {
    for (std::size_t n = 0; n < 6; ++n) out_.nodes[n] = id(1 + n, tables_.contexts[block_.context].added.node);
    for (std::size_t f = 7; f < 10; ++f)
      if (const std::int64_t submodel = id(f, 0); submodel > 0) out_.submodel = submodel;
    if (std::all_of(out_.nodes.begin(), out_.nodes.end(), [](std::int64_t n) { return n > 0; })) return;
    for (Vector3d& point : out_.points) {
      if (!next()) return;
      std::string_view rest = trim(line_.text);
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        const std::size_t end = std::min(rest.find_first_of(" \t"), rest.size());
        const auto value = tables_.parameters.real(rest.substr(0, end), tables_.contexts, block_.context);
        out_.readable &= value.has_value() && end > 0;
        point[axis] = value.value_or(0) * unit_;
        rest = trim(rest.substr(end));
      }
      out_.readable &= rest.empty();
    }
  }

  const DeckTables& tables_;
  const Block& block_;
  double unit_;
  BlockLines lines_;
  std::size_t width_;
  Transform& out_;
  Line line_;
};

/// Orthonormal axes with the first along a-b and the third normal to the plane of the points. nullopt: the points are collinear.
std::optional<Eigen::Matrix3d> axes_of(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const Vector3d x = (b - a).normalized();
  const Vector3d z = x.cross((c - a).normalized());
  if (!x.allFinite() || !z.allFinite() || z.norm() < 1e-9) return std::nullopt;
  Eigen::Matrix3d out;
  out << x, z.normalized().cross(x), z.normalized();
  return out;
}

std::optional<Affine3d> finite(const Affine3d& map) { return map.matrix().allFinite() ? std::optional(map) : std::nullopt; }

}  // namespace

Transform read_transform(const Block& block, const Keyword& keyword, const DeckTables& tables) {
  Transform out;
  out.kind = kind_of(keyword.word(1));
  out.file = block.file;
  out.offset = block.offset;
  out.points.fill(Vector3d::Zero());
  const std::optional<Units> units = tables.units(block.context, keyword.number(1));
  const std::optional<Units> main = tables.units(0, 0);
  out.readable = units && main && out.kind != Kind::unknown;
  CardReader(block, tables, units && main ? units->length / main->length : 1, out).run();
  return out;
}

std::optional<Affine3d> affine_of(const Transform& t, const std::array<std::optional<Vector3d>, 6>& at) {
  if (!t.readable) return std::nullopt;
  for (std::size_t n = 0; n < 6; ++n)
    if (t.nodes[n] > 0 && !at[n]) return std::nullopt;
  std::array<Vector3d, 6> points = t.points;
  const bool two_nodes = t.nodes[0] > 0 && t.nodes[1] > 0;
  if ((t.nodes[0] > 0) != (t.nodes[1] > 0) && t.kind != Kind::scaling) return std::nullopt;
  if (t.kind == Kind::translation) return finite(Affine3d(Eigen::Translation3d(two_nodes ? Vector3d(*at[1] - *at[0]) : points[0])));
  if (two_nodes && t.kind != Kind::position) points[0] = *at[0], points[1] = *at[1];
  const Vector3d axis = (points[1] - points[0]).normalized();
  switch (t.kind) {
    case Kind::rotation: {
      if (!(points[0] != points[1]) || !axis.allFinite()) return std::nullopt;
      const Eigen::AngleAxisd turn(t.angle_degrees * (std::numbers::pi / 180), axis);
      return finite(Affine3d(Eigen::Translation3d(points[0]) * turn * Eigen::Translation3d(-points[0])));
    }
    case Kind::symmetry: {
      if (!(points[0] != points[1]) || !axis.allFinite()) return std::nullopt;
      Affine3d mirror = Affine3d::Identity();
      mirror.linear() -= 2 * axis * axis.transpose();
      mirror.translation() = 2 * axis * axis.dot(points[0]);
      return finite(mirror);
    }
    case Kind::scaling: {
      if (!(t.points[0].cwiseAbs().minCoeff() > kMinScale) || !(t.points[0].cwiseAbs().maxCoeff() < 1 / kMinScale)) return std::nullopt;
      const Vector3d centre = t.nodes[0] > 0 ? *at[0] : Vector3d(Vector3d::Zero());
      return finite(Affine3d(Eigen::Translation3d(centre) * Eigen::Scaling(t.points[0]) * Eigen::Translation3d(-centre)));
    }
    case Kind::matrix: {
      Affine3d map = Affine3d::Identity();
      for (Eigen::Index row = 0; row < 3; ++row) map.linear().row(row) = points[static_cast<std::size_t>(row)].transpose();
      map.translation() = points[3];
      if (!(map.linear() * map.linear().transpose()).isIdentity(kOrthonormal)) return std::nullopt;
      return finite(map);
    }
    case Kind::position: {
      const bool by_nodes = std::all_of(t.nodes.begin(), t.nodes.end(), [](std::int64_t n) { return n > 0; });
      for (std::size_t n = 0; n < 6 && by_nodes; ++n) points[n] = *at[n];
      const auto from = axes_of(points[0], points[1], points[2]);
      const auto to = axes_of(points[3], points[4], points[5]);
      if (!from || !to) return std::nullopt;
      Affine3d map = Affine3d::Identity();
      map.linear() = *to * from->transpose();
      map.translation() = points[3] - map.linear() * points[0];
      return finite(map);
    }
    default: return std::nullopt;
  }
}

bool Transformer::GroupMembers::has(std::int64_t id) const {
  if (std::binary_search(without.begin(), without.end(), id)) return false;
  if (std::binary_search(ids.begin(), ids.end(), id)) return true;
  return std::any_of(ranges.begin(), ranges.end(),
                     [&](const auto& range) { return range[0] <= id && id <= range[1] && (id - range[0]) % range[2] == 0; });
}

void Transformer::run(const std::vector<Transform>& transforms) {
  find_named(transforms);
  for (const Transform& transform : transforms) {
    std::array<std::optional<Vector3d>, 6> at;
    for (std::size_t n = 0; n < 6; ++n)
      if (transform.nodes[n] > 0) at[n] = position(transform.nodes[n]);
    const std::optional<Affine3d> map = affine_of(transform, at);
    GroupMembers members;
    const bool by_group = transform.group > 0 && transform.submodel == 0;
    const bool known = by_group ? collect(transform.group, 0, members) : transform.submodel > 0 && transform.group == 0;
    work_ += by_group ? 1000 + members.ranges.size() : found_.frames.size();
    if (!map || !known || work_ > kMaxWork)
      hold(transform, by_group && known ? &members : nullptr);
    else if (by_group)
      move_group(members, *map);
    else
      move_submodel(transform, *map);
  }
  for (const NamedNode& named : named_)
    if (named.found) found_.cards[named.piece].holds.emplace_back(named.node, kHeldByFrame);
  for (PieceCards& cards : found_.cards) {
    std::sort(cards.holds.begin(), cards.holds.end());
    cards.holds.erase(std::unique(cards.holds.begin(), cards.holds.end()), cards.holds.end());
  }
}

void Transformer::find_named(const std::vector<Transform>& transforms) {
  for (const Transform& transform : transforms)
    for (const std::int64_t node : transform.nodes)
      if (node > 0) named_.push_back({node});
  std::sort(named_.begin(), named_.end(), [](const NamedNode& a, const NamedNode& b) { return a.id < b.id; });
  named_.erase(std::unique(named_.begin(), named_.end(), [](const NamedNode& a, const NamedNode& b) { return a.id == b.id; }),
               named_.end());
  if (named_.empty()) return;
  for (std::uint32_t p = 0; p < found_.cards.size(); ++p)
    for (std::uint32_t n = 0; n < found_.cards[p].node_id.size(); ++n) {
      const std::int64_t id = found_.cards[p].node_id[n];
      const auto named = std::lower_bound(named_.begin(), named_.end(), id, [](const NamedNode& a, std::int64_t b) { return a.id < b; });
      if (named != named_.end() && named->id == id && !named->found) *named = {id, p, n, true};
    }
}

/// The node's position after the cards so far.
std::optional<Vector3d> Transformer::position(std::int64_t node) const {
  const auto named = std::lower_bound(named_.begin(), named_.end(), node, [](const NamedNode& a, std::int64_t b) { return a.id < b; });
  if (named == named_.end() || named->id != node || !named->found) return std::nullopt;
  const PieceCards& cards = found_.cards[named->piece];
  const auto run = std::prev(std::upper_bound(cards.node_runs.begin(), cards.node_runs.end(), named->node,
                                              [](std::uint32_t value, const PieceRun& r) { return value < r.first; }));
  return found_.frames[run->frame].to_basic * cards.position[named->node];
}

bool Transformer::in_submodel(std::uint32_t frame, std::int64_t submodel) const {
  for (std::uint32_t context = frame_context_[frame]; context != 0; context = tables_.contexts[context].parent)
    if (tables_.contexts[context].id == submodel) return true;
  return false;
}

void Transformer::move_submodel(const Transform& transform, const Affine3d& map) {
  bool any = false;
  for (std::uint32_t f = 0; f < found_.frames.size(); ++f) {
    if (!in_submodel(f, transform.submodel)) continue;
    found_.frames[f].to_basic = map * found_.frames[f].to_basic;
    any = true;
  }
  if (!any)
    found_.warnings.note("empty-transform", transform.file, transform.offset,
                         "a transformation names submodel " + std::to_string(transform.submodel) + ", which has no nodes");
}

/// Cuts runs where membership changes. Runs of members get frames of their own.
void Transformer::move_group(const GroupMembers& members, const Affine3d& map) {
  std::map<std::uint32_t, std::uint32_t> moved;
  const std::uint64_t cost = 1 + members.ranges.size();
  for (PieceCards& cards : found_.cards) {
    work_ += cost * cards.node_id.size();
    std::vector<PieceRun> runs;
    for (std::size_t r = 0; r < cards.node_runs.size(); ++r) {
      const std::size_t end = r + 1 < cards.node_runs.size() ? cards.node_runs[r + 1].first : cards.node_id.size();
      PieceRun run = cards.node_runs[r];
      for (std::size_t n = run.first; n < end; ++n) {
        run.first = static_cast<std::uint32_t>(n);
        run.frame = cards.node_runs[r].frame;
        if (members.has(cards.node_id[n])) {
          const auto [at, added] = moved.try_emplace(run.frame, static_cast<std::uint32_t>(found_.frames.size()));
          if (added) {
            Frame frame = found_.frames[run.frame];
            frame.to_basic = map * frame.to_basic;
            found_.frames.push_back(frame);
            found_.id_offsets.push_back(IdOffsets(found_.id_offsets[run.frame]));
            frame_context_.push_back(std::uint32_t{frame_context_[run.frame]});
          }
          run.frame = at->second;
        }
        if (runs.empty() || runs.back().frame != run.frame || runs.back().style != run.style) runs.push_back(run);
      }
    }
    cards.node_runs = std::move(runs);
  }
}

/// Holds the nodes of a card whose map can't be computed. `members`: of its group; null: it has none, or they aren't known.
void Transformer::hold(const Transform& transform, const GroupMembers* members) {
  found_.warnings.note("unread-transform", transform.file, transform.offset,
                       "a transformation can't be worked out; what it moves is shown where its cards put it and can't be moved");
  // Beyond the limit of work all nodes are held, which costs one pass.
  const std::int64_t submodel = work_ > kMaxWork ? 0 : transform.submodel;
  if (work_ > kMaxWork) members = nullptr;
  if (held_.contains(0) || (!members && !held_.insert(submodel).second)) return;
  for (PieceCards& cards : found_.cards)
    for (std::size_t r = 0; r < cards.node_runs.size(); ++r) {
      work_ += cards.node_id.size();
      const PieceRun& run = cards.node_runs[r];
      const std::size_t end = r + 1 < cards.node_runs.size() ? cards.node_runs[r + 1].first : cards.node_id.size();
      const bool concerned = submodel == 0 || in_submodel(run.frame, submodel);
      for (std::size_t n = run.first; n < end && concerned; ++n)
        if (!members || members->has(cards.node_id[n])) cards.holds.emplace_back(static_cast<std::uint32_t>(n), kHeldByFrame);
    }
}

/// Collects the members of a group. False: it isn't defined, or is of a kind whose members aren't computed here.
bool Transformer::collect(std::int64_t group, int depth, GroupMembers& members) {
  const auto at = groups_.find(group);
  if (at == groups_.end() || depth > kMaxGroupDepth || work_ > kMaxWork) return false;
  const Block& block = *at->second;
  work_ += 100 + block.body.end - block.body.begin;
  const Keyword keyword = keyword_at(tables_.files[block.file].bytes.text(), block.offset);
  const std::string_view kind = keyword.word(1);
  const Context& context = tables_.contexts[block.context];
  const std::int64_t added = kind == "PART" ? context.added.part : kind == "GRNOD" ? context.added.set : context.added.node;
  if (kind != "NODE" && kind != "NODENS" && kind != "GENE" && kind != "GEN_INCR" && kind != "PART" && kind != "GRNOD") return false;
  std::vector<std::int64_t> numbers;
  BlockLines lines(tables_.files, block);
  Line line;
  if (!lines.next(line)) return true;
  const std::size_t per = kind == "GENE" ? 2 : kind == "GEN_INCR" ? 3 : 1;
  while (lines.next(line)) {
    std::array<std::int64_t, 10> on_line{};
    for (std::size_t f = 0; f < on_line.size(); ++f) {
      const auto number = tables_.parameters.integer(field(line.text, context.field_width(), f), tables_.contexts, block.context);
      if (!number) return false;
      on_line[f] = *number;
    }
    for (std::size_t f = 0; f + per <= on_line.size(); f += per) {
      const std::int64_t id = on_line[f];
      if (id == 0) continue;
      if (per == 1)
        numbers.push_back(id > 0 ? id + added : id - added);
      else
        members.ranges.push_back({id + added, on_line[f + 1] + added, per == 3 ? std::max<std::int64_t>(on_line[f + 2], 1) : 1});
    }
  }
  if (kind == "PART") {
    collect_parts(numbers, members);
  } else if (kind == "GRNOD") {
    for (const std::int64_t inner : numbers)
      if (inner < 0 || !collect(inner, depth + 1, members)) return false;
  } else {
    for (const std::int64_t id : numbers) (id > 0 ? members.ids : members.without).push_back(std::abs(id));
  }
  if (depth == 0) {
    std::sort(members.ids.begin(), members.ids.end());
    std::sort(members.without.begin(), members.without.end());
  }
  return true;
}

void Transformer::collect_parts(const std::vector<std::int64_t>& parts, GroupMembers& members) {
  std::vector<std::int64_t> wanted = parts;
  std::sort(wanted.begin(), wanted.end());
  for (const PieceCards& cards : found_.cards) {
    work_ += cards.shells.id.size();
    for (std::size_t s = 0; s < cards.shells.id.size(); ++s)
      if (std::binary_search(wanted.begin(), wanted.end(), cards.shells.part[s]))
        members.ids.insert(members.ids.end(), cards.shells.nodes[s].begin(), cards.shells.nodes[s].end());
    for (const RawElements& elements : cards.elements) {
      work_ += elements.id.size();
      for (std::size_t e = 0; e < elements.id.size(); ++e)
        if (std::binary_search(wanted.begin(), wanted.end(), elements.part[e]))
          members.ids.insert(members.ids.end(), elements.nodes.begin() + elements.first_node[e],
                             elements.nodes.begin() + elements.first_node[e + 1]);
    }
  }
}

}  // namespace prismesh::mesh::deck::radioss
