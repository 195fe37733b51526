#include "daemon/modeld/contacts_answer.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

namespace prismesh::modeld {

namespace {

/// The first entries of a list, as many as there is still room for.
template <class List>
auto within(const List& list, std::size_t& room) {
  const std::size_t taken = std::min(list.size(), room);
  room -= taken;
  return std::span(list).first(taken);
}

std::array<double, 3> point_of(const mesh::Vec3& at) { return {at.x(), at.y(), at.z()}; }

}  // namespace

ipc::Contacts contacts_answer(std::uint64_t generation, const mesh::document::Contacts& found, const ipc::ContactLimits& limits) {
  ipc::Contacts answer;
  answer.generation = generation;
  answer.perforations = found.perforations;
  answer.penetrations = found.penetrations;
  answer.clearances = found.clearances;
  answer.without_thickness = found.without_thickness;
  ipc::ContactLimits room = limits;
  for (const mesh::document::ContactRegion& region : within(found.regions, room.regions)) {
    ipc::ContactRegion told;
    told.kind = region.kind;
    told.a = region.a, told.b = region.b;
    told.name_a = region.name_a, told.name_b = region.name_b;
    told.shells_a = region.shells_a.size(), told.shells_b = region.shells_b.size();
    told.length = region.length;
    told.max_depth = region.max_depth;
    told.mean_depth = region.mean_depth;
    told.area = region.area;
    told.at = point_of(region.at);
    told.worst_a = region.worst_a, told.worst_b = region.worst_b;
    told.joined = region.joined;
    told.why = region.why;
    told.thickness_from = region.thickness_from;
    told.contact = region.contact;
    for (const mesh::ShellSet* side : {&region.shells_a, &region.shells_b})
      for (const mesh::ShellIndex shell : within(*side, room.shells)) told.shells.push_back(shell.value);
    for (const mesh::contact::CurveSegment& s : within(region.curve, room.segments))
      told.curve.push_back({s.from.x(), s.from.y(), s.from.z(), s.to.x(), s.to.y(), s.to.z()});
    for (const mesh::document::ContactVector& vector : within(region.vectors, room.vectors))
      told.vectors.push_back({vector.node.value, point_of(vector.to)});
    answer.regions.push_back(std::move(told));
  }
  return answer;
}

}  // namespace prismesh::modeld
