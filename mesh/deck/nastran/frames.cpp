#include "mesh/deck/nastran/frames.h"

#include <algorithm>

namespace prismesh::mesh::deck::nastran {
namespace {

/// Two directions are parallel if their cross product is below this share of the product of their lengths.
constexpr double kParallel = 1e-10;

std::optional<Frame> frame_through(Frame::Kind kind, const std::array<Vec3, 3>& points) {
  const Vec3 axis = points[1] - points[0], across = points[2] - points[0];
  const Vec3 y = axis.cross(across);
  if (!points[0].allFinite() || !y.allFinite() || !(y.norm() > kParallel * axis.norm() * across.norm())) return std::nullopt;
  Frame frame;
  frame.kind = kind;
  const Vec3 z = axis.normalized();
  frame.to_basic.linear().col(1) = y.normalized();
  frame.to_basic.linear().col(2) = z;
  frame.to_basic.linear().col(0) = y.normalized().cross(z);
  frame.to_basic.translation() = points[0];
  return frame;
}

}  // namespace

bool read_systems(const Card& card, std::size_t offset, std::vector<SystemCard>& systems, bool& bad) {
  const std::string_view name = card.name();
  if (name.size() != 6 || name.substr(0, 4) != "CORD" || (name[4] != '1' && name[4] != '2')) return false;
  SystemCard system;
  system.offset = offset;
  system.by_grids = name[4] == '1';
  switch (name[5]) {
    case 'R': break;
    case 'C': system.kind = Frame::Kind::cylindrical; break;
    case 'S': system.kind = Frame::Kind::spherical; break;
    default: return false;
  }
  bad = false;
  if (system.by_grids) {
    for (const std::size_t first : {std::size_t{0}, std::size_t{4}}) {
      system.id = card.integer_or_zero(first);
      for (std::size_t i = 0; i < 3; ++i) system.grids[i] = card.integer_or_zero(first + 1 + i);
      if (system.id > 0) systems.push_back(system);
    }
    return true;
  }
  system.id = card.integer_or_zero(0);
  system.reference = card.integer_or_zero(1);
  bad = system.id <= 0 || !card.integer(1);
  for (std::size_t i = 0; i < 9; ++i) {
    const std::optional<double> value = card.real(2 + i);
    bad |= !value;
    system.points[i / 3][static_cast<Eigen::Index>(i % 3)] = value.value_or(0);
  }
  if (!bad) systems.push_back(system);
  return true;
}

Systems::Systems(std::vector<SystemCard> cards, const std::function<std::optional<GridPlace>(std::int64_t)>& grid) : grid_(grid) {
  std::stable_sort(cards.begin(), cards.end(), [](const SystemCard& a, const SystemCard& b) { return a.id < b.id; });
  for (const SystemCard& card : cards) {
    if (!entries_.empty() && entries_.back().card.id == card.id)
      duplicates_.push_back(card);
    else
      entries_.push_back({card, Resolution::waiting, {}});
  }
  for (Entry& entry : entries_) work_out(entry);
}

Systems::Entry* Systems::entry(std::int64_t id) {
  const auto at =
      std::lower_bound(entries_.begin(), entries_.end(), id, [](const Entry& e, std::int64_t wanted) { return e.card.id < wanted; });
  return at == entries_.end() || at->card.id != id ? nullptr : &*at;
}

/// Depth first with a stack instead of recursion: nothing limits how deep systems depend on each other.
void Systems::work_out(Entry& first) {
  std::vector<Entry*> waiting;
  if (first.resolution == Resolution::waiting) waiting.push_back(&first);
  while (!waiting.empty()) {
    Entry& top = *waiting.back();
    if (top.resolution == Resolution::waiting || top.resolution == Resolution::open) {
      top.resolution = Resolution::open;
      const std::size_t depth = waiting.size();
      settle(top, waiting);
      if (waiting.size() > depth) continue;
    }
    waiting.pop_back();
  }
}

/// Whether the system that an entry depends on is resolved. If not yet, it is pushed on the stack; if it can't be, `why` says so.
bool Systems::ready(std::int64_t system, std::vector<Entry*>& waiting, const char*& why) {
  if (system == 0) return true;
  Entry* other = entry(system);
  if (!other)
    why = "stands on a coordinate system that isn't defined";
  else if (other->resolution == Resolution::open)
    why = "stands on itself";
  else if (other->resolution == Resolution::bad)
    why = "stands on one that can't be worked out";
  else if (other->resolution == Resolution::waiting)
    waiting.push_back(other);
  return other && other->resolution == Resolution::done;
}

std::optional<Vec3> Systems::basic(const Vec3& place, std::int64_t system) const {
  if (system == 0) return place;
  const Entry* other = entry(system);
  if (!other || other->resolution != Resolution::done) return std::nullopt;
  return to_basic(other->frame, place);
}

/// Resolves the entry, or marks it bad, or pushes a system that it depends on on the stack.
void Systems::settle(Entry& entry, std::vector<Entry*>& waiting) {
  const char* why = nullptr;
  std::array<GridPlace, 3> places;
  for (std::size_t i = 0; i < 3 && !why; ++i) {
    if (!entry.card.by_grids) {
      places[i] = {entry.card.points[i], entry.card.reference};
    } else if (const std::optional<GridPlace> place = grid_(entry.card.grids[i])) {
      places[i] = *place;
    } else {
      why = "is spanned by a grid point that isn't defined";
    }
    if (!why && !ready(places[i].system, waiting, why) && !why) return;
  }
  if (!why) {
    std::array<Vec3, 3> points;
    for (std::size_t i = 0; i < 3; ++i) points[i] = *basic(places[i].position, places[i].system);
    if (const std::optional<Frame> frame = frame_through(entry.card.kind, points)) {
      entry.frame = *frame;
      entry.resolution = Resolution::done;
      return;
    }
    why = "has its three points on one line";
  }
  entry.resolution = Resolution::bad;
  bad_.push_back({&entry.card, why});
}

std::optional<Frame> Systems::find(std::int64_t id) const {
  const Entry* found = entry(id);
  if (!found || found->resolution != Resolution::done) return std::nullopt;
  return found->frame;
}

bool Systems::defined(std::int64_t id) const { return entry(id) != nullptr; }

}  // namespace prismesh::mesh::deck::nastran
