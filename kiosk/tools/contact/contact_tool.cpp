#include "kiosk/tools/contact/contact_tool.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "kiosk/input/key_table.h"
#include "kiosk/toolkit/open_panels.h"
#include "kiosk/toolkit/picking.h"
#include "kiosk/toolkit/view_glide.h"
#include "kiosk/tools/contact/contact_keys.h"
#include "kiosk/tools/contact/contact_panel.h"
#include "kiosk/tools/contact/contact_words.h"

namespace prismesh::kiosk::tools::contact {

using panels::PanelLayout;

namespace {

constexpr double kRegionPixels = 200;  ///< of a region's size on the screen, where the view goes to it

/// What a place covers: where it is worst, the curve where parts cross, and its shells.
stereo::Box box_of(const ipc::ContactRegion& place, const ipc::SnapshotView& shown) {
  stereo::Box box;
  box.add(mesh::Vec3(place.at[0], place.at[1], place.at[2]));
  for (const std::array<double, 6>& segment : place.curve)
    for (const std::size_t end : {0U, 3U}) box.add(mesh::Vec3(segment[end], segment[end + 1], segment[end + 2]));
  for (const auto shell : place.shells) {
    if (shell >= shown.shell_count()) continue;  // of a newer state
    for (const mesh::NodeIndex node : shown.shell(shell).node)
      if (node.valid() && node.value < shown.node_count() && shown.position(node.value).allFinite()) box.add(shown.position(node.value));
  }
  return box;
}

}  // namespace

std::span<const input::KeyBinding> keys() { return kKeys; }

render::ContactPicture picture_of(const ipc::Contacts& contacts, const std::optional<std::size_t>& chosen,
                                  const std::function<std::optional<mesh::Vec3>(std::uint32_t)>& position) {
  render::ContactPicture picture;
  for (std::size_t r = 0; r < contacts.regions.size(); ++r) {
    const ipc::ContactRegion& region = contacts.regions[r];
    for (const std::uint32_t shell : region.shells) (chosen == r ? picture.chosen : picture.shells).emplace_back(shell);
    for (const auto& s : region.curve) picture.curve.push_back({mesh::Vec3(s[0], s[1], s[2]), mesh::Vec3(s[3], s[4], s[5])});
    if (chosen != r) continue;
    for (const ipc::ContactVector& vector : region.vectors)
      if (const auto from = position(vector.node)) picture.vectors.push_back({*from, mesh::Vec3(vector.to[0], vector.to[1], vector.to[2])});
  }
  return picture;
}

std::string_view ContactTool::name() const { return kName; }

void ContactTool::command(std::uint8_t number, const toolkit::Pointer&) {
  switch (static_cast<ContactCommand>(number)) {
    case ContactCommand::panel: toolkit::toggle_in_hand(context_, this); break;
    case ContactCommand::next: step(1); break;
    case ContactCommand::previous: step(-1); break;
    case ContactCommand::search:
      if (!is_open()) toolkit::take_in_hand(context_, this);
      if (context_.shown.snapshot) link_.want(context_.shown.snapshot->info().generation, true);
      break;
  }
}

bool ContactTool::fits() const {
  return is_open() && !context_.shown.older && context_.shown.snapshot && link_.contacts() != nullptr &&
         link_.contacts()->generation == context_.shown.snapshot->info().generation;
}

/// Regions come while the panel is open. Marks of an older state would lie beside the shells: they go until the new ones are here.
Result<void> ContactTool::follow() {
  if (!is_open() || !context_.shown.snapshot) {
    link_.forget();
    chosen_.reset();
    return show();
  }
  link_.want(context_.shown.snapshot->info().generation);
  const ipc::Contacts* contacts = link_.contacts();
  if (contacts != nullptr && told_ != link_.answers()) {
    told_ = link_.answers();
    if (chosen_ && *chosen_ >= contacts->regions.size()) chosen_.reset();
    context_.trace.line(fmt::format("contact generation {} cross {} close {} gap {}", contacts->generation, contacts->perforations,
                                    contacts->penetrations, contacts->clearances));
  }
  return show();
}

Result<void> ContactTool::show() {
  if (!fits()) {
    shown_.reset();
    if (!std::exchange(marked_, false)) return {};
    context_.trace.line("contact marks 0");
    return context_.renderer.set_contact({});
  }
  const Shown wanted{link_.answers(), chosen_};
  if (shown_ == wanted) return {};
  shown_ = wanted;
  const auto& snapshot = *context_.shown.snapshot;
  const auto position = [&](std::uint32_t node) -> std::optional<mesh::Vec3> {
    return node < snapshot.node_count() ? std::optional(snapshot.position(node)) : std::nullopt;
  };
  render::ContactPicture picture = picture_of(*link_.contacts(), chosen_, position);
  const std::size_t shells = picture.chosen.size() + picture.shells.size(), curve = picture.curve.size(), ways = picture.vectors.size();
  if (Result<void> set = context_.renderer.set_contact(std::move(picture)); !set) return set;
  marked_ = true;
  ++context_.changes;
  context_.trace.line(fmt::format("contact marks {} curve {} ways {}", shells, curve, ways));
  return {};
}

void ContactTool::panel_changed() {
  if (!is_open()) chosen_.reset();
  context_.follow_soon = true;
}

void ContactTool::document_changed() {
  link_.forget();
  chosen_.reset();
}

void ContactTool::step(int by) {
  if (!context_.shown.snapshot) return;
  if (!is_open()) return toolkit::take_in_hand(context_, this);
  const ipc::Contacts* contacts = link_.contacts();
  if (contacts == nullptr || contacts->regions.empty()) return;
  const auto count = static_cast<std::ptrdiff_t>(contacts->regions.size());
  const std::ptrdiff_t from = chosen_ ? static_cast<std::ptrdiff_t>(*chosen_) : by > 0 ? -1 : count;
  go_to(static_cast<std::size_t>((from + by + count) % count));
}

void ContactTool::go_to(std::size_t region) {
  const ipc::Contacts* contacts = link_.contacts();
  if (contacts == nullptr || region >= contacts->regions.size()) return;
  chosen_ = region;
  chosen_anew_ = true;
  context_.follow_soon = true;
  const ipc::ContactRegion& place = contacts->regions[region];
  toolkit::PictureView& view = context_.view;
  const ipc::SnapshotInfo& info = context_.shown.snapshot->info();
  const stereo::Sphere sphere = stereo::sphere_around(box_of(place, *context_.shown.snapshot));
  const double scale = toolkit::scale_to_look_at(std::max(info.target_size, 2 * sphere.radius), view.view.mm_per_unit,
                                                 toolkit::aim(view).mm_per_pixel(), kRegionPixels);
  view.glide.begin(sphere.centre, scale, context_.clock.now_ns());
  context_.trace.line(fmt::format("contact {} of {} {}", region + 1, contacts->regions.size(), region_words(place, info.length_unit)));
}

std::vector<toolkit::RailEntry> ContactTool::rail() const {
  return {{toolkit::RailPlace::contact, "Contact", &input::binding_of(kKeys, command_of(ContactCommand::panel)), is_open()}};
}

void ContactTool::draw_options(panels::OptionRow& row) {
  const auto key = [](ContactCommand command) -> const input::KeyBinding& { return input::binding_of(kKeys, command_of(command)); };
  row.command("<", key(ContactCommand::previous));
  row.command(">", key(ContactCommand::next));
  row.command("look again", key(ContactCommand::search));
  if (link_.contacts() != nullptr) row.words(count_words(*link_.contacts()));
}

std::string ContactTool::setting_words() const { return "Contact"; }

void ContactTool::draw_panel(PanelLayout& layout) {
  ContactFacts facts;
  facts.contacts = link_.contacts();
  facts.asking = link_.asking();
  facts.stale = facts.contacts != nullptr && facts.contacts->generation != context_.shown.snapshot->info().generation;
  facts.problem = link_.problem();
  facts.length_unit = context_.shown.snapshot->info().length_unit;
  facts.chosen = chosen_;
  facts.chosen_anew = std::exchange(chosen_anew_, false);
  if (const std::optional<std::size_t> clicked = contact_panel(facts, layout)) layout.ask([this, region = *clicked] { go_to(region); });
}

}  // namespace prismesh::kiosk::tools::contact
