#include "mesh/contact/separation_check.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>

#include <Eigen/Geometry>

#include "base/counted.h"
#include "mesh/contact/find_penetrations.h"
#include "mesh/contact/meant_region.h"
#include "mesh/contact/near_shells.h"
#include "mesh/contact/sort_unique.h"

namespace prismesh::mesh::contact {

namespace {

constexpr double kMaxDeeperShare = 1e-3;  ///< of the mean thickness: rounding of what didn't change

bool is_worse(const Contact& after, const Contacts& contacts_before, const std::pair<ShellIndex, ShellIndex>& pair, double gap) {
  const auto before = contacts_before.find(pair);
  if (before != contacts_before.end() && before->second.crosses) return false;
  if (after.crosses) return true;
  if (after.depth - gap <= kMinDepthShare * after.mean_thickness) return false;  // only the gap makes it
  const double depth_before = before != contacts_before.end() ? before->second.depth : gap;
  return after.depth > depth_before + kMaxDeeperShare * after.mean_thickness;
}

bool has_shell(const ShellSet& shells, ShellIndex shell) { return std::binary_search(shells.begin(), shells.end(), shell); }

/// By the normals of the corners' triangles.
bool turned_over(const Model& before, const Model& after, ShellIndex shell) {
  const auto normals = [&](const Model& model) {
    std::vector<Vec3> found;
    const ShellNodes& nodes = model.shell(shell);
    const auto corners = static_cast<std::size_t>(nodes.corners());
    for (std::size_t i = 0; i < corners; ++i) {
      const Vec3& at = model.position(nodes.node[i]);
      const Vec3 to_next = model.position(nodes.node[(i + 1) % corners]) - at;
      const Vec3 to_last = model.position(nodes.node[(i + corners - 1) % corners]) - at;
      found.push_back(to_next.cross(to_last));
    }
    return found;
  };
  const std::vector<Vec3> was = normals(before), is = normals(after);
  for (std::size_t i = 0; i < was.size(); ++i)
    if (was[i].dot(is[i]) < 0) return true;
  return false;
}

std::string why_failing(const SeparatedModel& before, const SeparatedModel& after, const ShellSet& touched) {
  std::size_t failing = 0, turned = 0;
  for (const ShellIndex shell : touched) {
    const bool failed = before.states[shell.value].grade() == quality::Grade::fail;
    if (after.states[shell.value].grade() == quality::Grade::fail && !failed) ++failing;
    if (turned_over(before.model, after.model, shell)) ++turned;
  }
  if (turned > 0) return counted(turned, "shell") + " would turn over";
  if (failing > 0) return counted(failing, "shell") + " would fail: move less or repair";
  return {};
}

}  // namespace

FoundContacts find_contacts(const SeparationInput& input, const SeparationWish& wish, const Model& model, const spatial::BoxTree& tree,
                            const ShellSet* among) {
  FoundContacts found{find_shell_crossings(model, tree, among), {}};
  found.penetrations = find_penetrations(model, tree, input.thickness, found.crossings, {wish.gap, nullptr, among});
  return found;
}

Contacts by_pair(const FoundContacts& found, double gap) {
  Contacts contacts;
  for (const ShellCrossing& crossing : found.crossings) contacts[{crossing.a, crossing.b}].crosses = true;
  for (const Penetration& region : found.penetrations)
    for (const CloseShells& pair : region.pairs)
      contacts[{std::min(pair.a, pair.b), std::max(pair.a, pair.b)}] = {false, pair.depth, pair.distance + pair.depth - gap};
  return contacts;
}

Harm harm_of(const SeparationInput& input, const SeparationWish& wish, const SeparatedModel& before, SeparatedModel& after,
             const NodeSet& moved, const SidesToClear& sides) {
  const ShellSet touched = shells_touching(after.model, moved);
  quality::Counts unused;
  quality::rejudge(after.model, input.criteria, touched, after.states, unused);
  if (std::string why = why_failing(before, after, touched); !why.empty()) return {std::move(why), true, false, {}};
  after.tree.follow(after.model);
  ShellSet near = touched;
  for (const SeparatedModel* state : {&before, static_cast<const SeparatedModel*>(&after)})
    add_near_shells(state->tree, touched, before.reach, near);
  sort_unique(near);
  const Contacts now = by_pair(find_contacts(input, wish, after.model, after.tree, &near), wish.gap);
  Harm harm;
  for (const auto& [pair, contact] : now) {
    const auto& [a, b] = pair;
    const bool touches_a = has_shell(touched, a), touches_b = has_shell(touched, b);
    if (touches_a || touches_b) harm.at_moved[pair] = contact;
    const bool of_region =
        (has_shell(sides.upper, a) && has_shell(sides.lower, b)) || (has_shell(sides.upper, b) && has_shell(sides.lower, a));
    if (of_region && (contact.crosses || contact.depth > wish.allowed_depth + kMinDepthShare * contact.mean_thickness))
      return {"the way out isn't free of the other side", false, false, {}};
    if (of_region || !(touches_a || touches_b) || !harm.why.empty() || !is_worse(contact, before.contacts, pair, wish.gap)) continue;
    harm.by_surroundings = true;
    harm.why = "it would push " + part_name(after.model, after.model.shell_parts[(touches_a ? a : b).value]) + " into " +
               part_name(after.model, after.model.shell_parts[(touches_a ? b : a).value]);
  }
  return harm;
}

std::vector<std::pair<ShellIndex, ShellIndex>> worse_pairs(const Contacts& before, const Contacts& after, double gap) {
  std::vector<std::pair<ShellIndex, ShellIndex>> worse;
  for (const auto& [pair, contact] : after)
    if (is_worse(contact, before, pair, gap)) worse.push_back(pair);
  return worse;
}

}  // namespace prismesh::mesh::contact
