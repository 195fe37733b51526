#include "kiosk/tools/mesh_operations/mesh_operations_tool.h"

#include <array>
#include <utility>

#include <fmt/format.h>

#include "kiosk/input/key_table.h"
#include "kiosk/toolkit/edits.h"
#include "kiosk/toolkit/open_panels.h"
#include "kiosk/toolkit/picking.h"
#include "kiosk/toolkit/tool_set.h"

namespace prismesh::kiosk::tools::mesh_operations {
namespace {

using input::KeyBinding;
using input::Menu;
using toolkit::Pointer;

using display::letter;
using mesh::repair::Operation;

constexpr std::string_view kName = "mesh operations";

enum class OperationCommand : std::uint8_t { split, collapse, merge, swap, carry_out, take_in_hand };

constexpr input::Command command_of(OperationCommand command) { return {kName, static_cast<std::uint8_t>(command)}; }

constexpr std::array kKeys = {
    KeyBinding{display::Key::f3, false, false, command_of(OperationCommand::take_in_hand), Menu::mesh, "F3",
               "mesh: split, collapse, merge, swap single shells"},
    KeyBinding{letter('D'), true, false, command_of(OperationCommand::split), Menu::mesh, "Ctrl+D",
               "split: the shell under the pointer, or two at their edge", input::kAsksForEdit | input::kAtPointer},
    KeyBinding{letter('B'), true, false, command_of(OperationCommand::collapse), Menu::mesh, "Ctrl+B",
               "collapse the edge under the pointer to a point", input::kAsksForEdit | input::kAtPointer},
    KeyBinding{letter('M'), true, false, command_of(OperationCommand::merge), Menu::mesh, "Ctrl+M",
               "merge the triangles at the edge under the pointer", input::kAsksForEdit | input::kAtPointer},
    KeyBinding{letter('W'), true, false, command_of(OperationCommand::swap), Menu::mesh, "Ctrl+W", "swap the edge under the pointer",
               input::kAsksForEdit | input::kAtPointer},
    KeyBinding{display::Key::enter, false, false, command_of(OperationCommand::carry_out), Menu::mesh, "Enter",
               "do what is shown as a preview", input::kAsksForEdit},
};

std::string name_of(Operation operation) { return std::string(mesh::repair::name(operation)); }

}  // namespace

std::span<const KeyBinding> keys() { return kKeys; }

std::string_view MeshOperationsTool::name() const { return kName; }

void MeshOperationsTool::command(std::uint8_t number, const Pointer& pointer) {
  switch (static_cast<OperationCommand>(number)) {
    case OperationCommand::split: choose(Operation::split, pointer); break;
    case OperationCommand::collapse: choose(Operation::collapse, pointer); break;
    case OperationCommand::merge: choose(Operation::merge, pointer); break;
    case OperationCommand::swap: choose(Operation::swap, pointer); break;
    case OperationCommand::carry_out: context_.tools.carry_out_preview(); break;
    case OperationCommand::take_in_hand: toolkit::toggle_in_hand(context_, this); break;
  }
}

std::vector<toolkit::RailEntry> MeshOperationsTool::rail() const {
  return {{toolkit::RailPlace::mesh, "Mesh", &input::binding_of(kKeys, command_of(OperationCommand::take_in_hand)),
           context_.open.in_hand == this || in_mode()}};
}

void MeshOperationsTool::draw_options(panels::OptionRow& row) {
  constexpr std::array kOperations{std::pair{"split", Operation::split}, std::pair{"collapse", Operation::collapse},
                                   std::pair{"merge", Operation::merge}, std::pair{"swap", Operation::swap}};
  for (std::size_t i = 0; i < kOperations.size(); ++i)
    row.toggle(kOperations[i].first, chosen_.operation == kOperations[i].second,
               input::binding_of(kKeys, command_of(static_cast<OperationCommand>(i))));
  row.words("click a shell or an edge to see it, click again to do it");
}

std::string MeshOperationsTool::setting_words() const {
  return chosen_.operation ? "Mesh \u00b7 " + name_of(*chosen_.operation) : "Mesh \u00b7 choose an operation";
}

bool MeshOperationsTool::gesture(const input::Gesture& gesture) {
  if (!in_mode()) return false;
  if (const auto* node = std::get_if<input::NodeClicked>(&gesture))
    click(node->at);
  else if (const auto* region = std::get_if<input::RegionClicked>(&gesture))
    click(region->at);
  else
    return false;
  return true;
}

void MeshOperationsTool::choose(Operation operation, const Pointer& pointer) {
  if (!context_.shown.snapshot || context_.tools.pulling()) return;
  leave_preview();
  chosen_.operation = operation;
  context_.trace.line("operation " + name_of(operation));
  if (pointer) click(*pointer);
}

/// The first click shows what would be done, a second one on the same place does it.
void MeshOperationsTool::click(const input::Pixel& at) {
  const auto shell = toolkit::shell_at(context_, at);
  const auto target =
      shell ? hand_target(*context_.renderer.model(), toolkit::aim(context_.view), *chosen_.operation, *shell, at) : std::nullopt;
  if (!target) return;
  if (chosen_.target == target && preview_.previewed() && preview_.previewed()->would) {
    carry_out_preview();
    return;
  }
  const ipc::SnapshotView& shown = *context_.shown.snapshot;
  chosen_.target = target;
  mesh::document::Restructure edit;
  edit.operation = *chosen_.operation;
  for (const mesh::ShellIndex each : target->shells) edit.at.push_back(fmt::format("shell:{}", shown.shell_id(each.value)));
  for (const mesh::NodeIndex each : target->nodes) edit.at.push_back(fmt::format("node:{}", shown.node_id(each.value)));
  chosen_.edit = edit;
  chosen_.generation = shown.info().generation;
  preview_.ask(edit);
}

bool MeshOperationsTool::carry_out_preview() {
  if (!chosen_.edit || !preview_.previewed() || !preview_.previewed()->would) return false;
  toolkit::send(context_, *chosen_.edit);
  // The preview stays in the picture until the edit is done.
  const std::uint64_t generation = chosen_.generation;
  if (std::exchange(chosen_.shown, 0) != 0) kept_ = generation;
  forget();
  return true;
}

bool MeshOperationsTool::leave_mode() {
  if (!in_mode()) return false;
  leave_preview();
  return true;
}

void MeshOperationsTool::leave_preview() {
  if (chosen_.shown != 0 || std::exchange(kept_, std::nullopt)) context_.renderer.end_preview();
  forget();
}

void MeshOperationsTool::forget() {
  if (chosen_.operation) context_.trace.line("operation none");
  chosen_ = {};
  preview_.forget();
}

void MeshOperationsTool::end_kept_preview() {
  const auto& shown = context_.shown.snapshot;
  const bool in_doubt = context_.link.edits.under_way() || !context_.link.document.up_to_date();
  if (!kept_ || (shown && shown->info().generation == *kept_ && in_doubt)) return;
  kept_.reset();
  context_.renderer.end_preview();
}

/// Shows the preview when it has come; one of another generation would be wrong.
Result<void> MeshOperationsTool::follow() {
  end_kept_preview();
  if (!chosen_.edit) return {};
  if (!context_.shown.snapshot || context_.shown.snapshot->info().generation != chosen_.generation) {
    leave_preview();
    return {};
  }
  const auto& previewed = preview_.previewed();
  if (!previewed || previewed->number == chosen_.shown) return {};
  if (chosen_.shown != 0) context_.renderer.end_preview();
  chosen_.shown = previewed->number;
  if (previewed->would)
    show_preview(*previewed->would);
  else
    context_.trace.line("operation refused " + previewed->problem);
  return {};
}

void MeshOperationsTool::show_preview(const ipc::EditPreviewed& would) {
  render::MeshChange change;
  for (const auto& point : would.points) change.points.emplace_back(point[0], point[1], point[2]);
  for (const ipc::PreviewedShell& shell : would.shells) {
    if (shell.corners.size() != 4) continue;
    change.corners.push_back({shell.corners[0], shell.corners[1], shell.corners[2], shell.corners[3]});
    change.states.push_back({static_cast<std::uint16_t>(shell.warn), static_cast<std::uint16_t>(shell.fail)});
    change.clusters.push_back(static_cast<std::uint8_t>(shell.clusters));
  }
  for (const std::int64_t id : would.replaced)
    if (const auto shell = toolkit::shell_with_id(context_, id)) change.replaced.push_back(*shell);
  if (const Result<void> done = context_.renderer.show_change(change); !done)
    context_.notices.say(notices::Notice::Kind::error, done.error().text());
  context_.trace.line(
      fmt::format("operation previewed shells {} warn {} fail {}", would.shell_count, would.report.after.warn, would.report.after.fail));
}

std::string MeshOperationsTool::guidance() const {
  if (!chosen_.operation) return {};
  const std::string what = name_of(*chosen_.operation);
  if (!chosen_.edit) return what + ": click a shell or next to an edge, Esc gives up";
  std::string at;
  for (const std::string& each : chosen_.edit->at) at += (at.empty() ? " " : ", ") + each;
  const auto& previewed = preview_.previewed();
  if (!previewed) return what + at + " ..";
  if (!previewed->would) return what + at + ": " + previewed->problem + "   (another click, or Esc)";
  const mesh::document::EditReport& report = previewed->would->report;
  const std::string clusters = report.clusters_before == report.clusters_after
                                   ? std::string()
                                   : fmt::format(", clusters {} \u2192 {}", report.clusters_before, report.clusters_after);
  return fmt::format("{}{}: warn {} \u2192 {}, fail {} \u2192 {}{}   Enter or a click does it, Esc not", what, at, report.before.warn,
                     report.after.warn, report.before.fail, report.after.fail, clusters);
}

}  // namespace prismesh::kiosk::tools::mesh_operations
