#include "mesh/contact/new_contacts.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <map>
#include <tuple>
#include <utility>

#include "base/readable_number.h"
#include "mesh/contact/changed_shells.h"
#include "mesh/contact/contacts_about.h"
#include "mesh/contact/find_penetrations.h"
#include "mesh/contact/meant_region.h"
#include "mesh/contact/near_shells.h"
#include "mesh/contact/shell_crossings.h"
#include "mesh/contact/sort_unique.h"

namespace prismesh::mesh::contact {

namespace {

constexpr double kMaxDeeperBySliding = 1e-3;  ///< of the mean thickness: rounding
constexpr double kSamePlace = 0.1;            ///< of the mean thickness: within it a shell of the part was at a place
constexpr int kDigitsOfDepth = 3;

/// A pair of shells that cross or are too close, and where.
struct PlacedContact {
  bool crosses = false;
  double depth = 0, mean_thickness = 0;
  Vec3 on_a = Vec3::Zero(), on_b = Vec3::Zero();
};
using PlacedContacts = std::map<std::pair<ShellIndex, ShellIndex>, PlacedContact>;  ///< the lower index first

bool has_shell_of(const ShellSet& shells, const std::pair<ShellIndex, ShellIndex>& pair) {
  return std::binary_search(shells.begin(), shells.end(), pair.first) || std::binary_search(shells.begin(), shells.end(), pair.second);
}

void add_close(const std::vector<Penetration>& regions, PlacedContacts& contacts) {
  for (const Penetration& region : regions)
    for (CloseShells pair : region.pairs) {
      if (pair.b < pair.a) std::swap(pair.a, pair.b), std::swap(pair.on_a, pair.on_b);
      contacts.try_emplace({pair.a, pair.b}, PlacedContact{false, pair.depth, pair.distance + pair.depth, pair.on_a, pair.on_b});
    }
}

/// What crosses or is too close among the shells of whole regions, those of perforations included.
PlacedContacts contacts_in(const ContactState& state, double reach, const ShellSet& whole) {
  const ShellSet among = shells_about(state, reach, whole);
  const std::vector<ShellCrossing> crossings = find_shell_crossings(state.model, state.tree, &among);
  PlacedContacts contacts;
  for (const ShellCrossing& crossing : crossings) {
    const Vec3 at = (crossing.segments.front().from + crossing.segments.front().to) / 2;
    contacts[{crossing.a, crossing.b}] = {true, 0, 0, at, at};
  }
  add_close(find_penetrations(state.model, state.tree, state.thickness, crossings, {0, nullptr, &among}), contacts);
  if (!crossings.empty())  // its shells that are too close don't count as penetrations
    add_close(find_penetrations(state.model, state.tree, state.thickness, {}, {0, nullptr, &among}), contacts);
  std::erase_if(contacts, [&](const auto& entry) { return !has_shell_of(whole, entry.first); });
  return contacts;
}

/// Two states, and what changed from one to the other.
struct Compared {
  ContactState before, after;
  double reach;
  ShellSet changed;

  bool has_changed(ShellIndex shell) const { return std::binary_search(changed.begin(), changed.end(), shell); }

  /// The shells that stood before for one of `after` at a place.
  ShellSet were(ShellIndex shell, const Vec3& at, double tolerance) const {
    ShellSet shells{shell};
    if (!has_changed(shell) || !can_decide(at)) return shells;
    before.tree.near_box(at, at, tolerance, [&](ShellIndex other, const spatial::FloatBox&) {
      if (before.model.shell_parts[other.value] == after.model.shell_parts[shell.value]) shells.push_back(other);
      return true;
    });
    return shells;
  }

  bool is_worse(const std::pair<ShellIndex, ShellIndex>& pair, const PlacedContact& contact, const PlacedContacts& contacts_before) const {
    const auto& of_shell = after.thickness.of_shell;
    const double mean_thickness = (of_shell[pair.first.value] + of_shell[pair.second.value]) / 2;
    double depth_before = 0;
    for (const ShellIndex a : were(pair.first, contact.on_a, kSamePlace * mean_thickness))
      for (const ShellIndex b : were(pair.second, contact.on_b, kSamePlace * mean_thickness)) {
        const auto found = contacts_before.find({std::min(a, b), std::max(a, b)});
        if (found == contacts_before.end()) continue;
        if (found->second.crosses) return false;
        depth_before = std::max(depth_before, found->second.depth);
      }
    return contact.crosses || contact.depth > depth_before + kMaxDeeperBySliding * mean_thickness;
  }

  ShellSet makers_of(const std::pair<ShellIndex, ShellIndex>& pair) const {
    ShellSet makers;
    for (const ShellIndex shell : {pair.first, pair.second})
      if (has_changed(shell)) makers.push_back(shell);
    if (!makers.empty()) return makers;
    ShellSet near;
    for (const ContactState* state : {&before, &after})
      add_near_shells(state->tree, {pair.first, pair.second}, kMinPathInLeastDistances * reach, near);
    sort_unique(near);
    std::set_intersection(near.begin(), near.end(), changed.begin(), changed.end(), std::back_inserter(makers));
    return makers.empty() ? changed : makers;
  }
};

}  // namespace

ContactsBefore::ContactsBefore(const Model& model, const spatial::BoxTree& tree, std::shared_ptr<const ContactThickness> thickness)
    : model_(model), tree_(tree), thickness_(std::move(thickness)) {
  for (const double each : thickness_->of_shell) max_thickness_ = std::max(max_thickness_, each);
}

std::vector<NewContact> ContactsBefore::new_in(const Model& after, const ContactThickness& thickness) const {
  ShellSet changed = changed_shells(model_, after);
  if (changed.empty()) return {};
  spatial::BoxTree tree = tree_;
  tree.follow(after);
  double reach = max_thickness_;
  for (const ShellIndex shell : changed)
    if (shell.value < after.shell_count()) reach = std::max(reach, thickness.of_shell[shell.value]);
  const Compared compared{{model_, tree_, *thickness_}, {after, tree, thickness}, reach, std::move(changed)};
  const ShellSet whole = shells_of_changed_regions(compared.before, compared.after, 0, reach, compared.changed, {});
  const PlacedContacts now = contacts_in(compared.after, reach, whole);
  if (now.empty()) return {};
  const PlacedContacts before = contacts_in(compared.before, reach, whole);
  std::vector<NewContact> found;
  for (const auto& [pair, contact] : now)
    if (compared.is_worse(pair, contact, before))
      found.push_back({pair.first, pair.second, contact.crosses, contact.depth, compared.makers_of(pair)});
  return found;
}

std::string in_words(const Model& model, const std::vector<NewContact>& contacts) {
  const NewContact& worst = *std::max_element(contacts.begin(), contacts.end(), [](const NewContact& x, const NewContact& y) {
    return std::tie(x.crosses, x.depth) < std::tie(y.crosses, y.depth);
  });
  const std::string a = part_name(model, model.shell_parts[worst.a.value]), b = part_name(model, model.shell_parts[worst.b.value]);
  const std::string both = a == b ? "two folds of " + a : a + " and " + b;
  return both + (worst.crosses ? " would cross" : " would be too close, " + readable(worst.depth, kDigitsOfDepth) + " deep");
}

}  // namespace prismesh::mesh::contact
