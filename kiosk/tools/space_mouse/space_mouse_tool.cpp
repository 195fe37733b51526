#include "kiosk/tools/space_mouse/space_mouse_tool.h"

#include <limits>

#include <fmt/format.h>

#include "kiosk/panels/layout.h"
#include "kiosk/panels/text.h"
#include "kiosk/toolkit/model_boxes.h"
#include "kiosk/toolkit/selected_nodes.h"
#include "kiosk/toolkit/tool_set.h"

namespace prismesh::kiosk::tools::space_mouse {
namespace {

using ipc::SnapshotArray;
using Act = SpaceMouseHand::Act;
using Mode = SpaceMouseHand::Mode;

/// The selected node nearest to the middle of all selected ones. Costs two passes over the marks.
std::optional<std::size_t> middle_node(const render::ModelSource& model) {
  const std::optional<Vec3> middle = toolkit::selection_centre(model);
  if (!middle) return std::nullopt;
  std::optional<std::size_t> nearest;
  double least = std::numeric_limits<double>::infinity();
  toolkit::for_each_selected(model, [&](std::size_t node) {
    if (node >= model.size(SnapshotArray::node_ids)) return;
    const double far = (model.at<Vec3>(SnapshotArray::positions, node) - *middle).squaredNorm();
    if (far >= least) return;
    least = far;
    nearest = node;
  });
  return nearest;
}

}  // namespace

// --- following the devices ---

void SpaceMouseTool::watch(std::int64_t now_ns) {
  if (context_.space_mice == nullptr) return;
  take_words();
  // modeld has ended the drag, or has ended itself.
  if (hand_.holds() && context_.link.drag.running() == nullptr) hand_.let_go();
  const Mode before = hand_.mode();
  const SpaceMouseHand::Answer answer = hand_.turn(given(), context_.view.view, toolkit::room_of_view_mm(context_.view).y(), now_ns);
  context_.view.steered = answer.act == Act::steer;
  act(answer);
  if (hand_.mode() != before) ++context_.changes;
}

void SpaceMouseTool::take_words() {
  if (context_.space_mice->changes() == words_) return;
  words_ = context_.space_mice->changes();
  ++context_.changes;
}

/// What the hand does counts only where the picture has a model, and no guard takes it.
SpaceMouseHand::Given SpaceMouseTool::given() {
  drivers::space_mouse::SpaceMice& mice = *context_.space_mice;
  SpaceMouseHand::Given given{mice.motion(), mice.take_presses(), mice.any()};
  const bool moves = !given.motion.at_rest(), began = moves && !std::exchange(moved_before_, moves);
  moved_before_ = moves;
  const bool taken = (moves || given.pressed != 0) && context_.tools.takes_input(began || given.pressed != 0);
  if (!taken && context_.shown.snapshot) return given;
  given.motion = {};
  given.pressed = 0;
  return given;
}

void SpaceMouseTool::act(const SpaceMouseHand::Answer& answer) {
  link::RemoteDrag& drag = context_.link.drag;
  switch (answer.act) {
    case Act::none: break;
    case Act::steer:
      if (answer.view == context_.view.view) break;
      context_.view.view = answer.view;
      context_.tools.view_moved();
      ++context_.changes;
      break;
    case Act::take: take(); break;
    case Act::pull: drag.pull({hand_.by()}); break;
    case Act::commit:
      drag.pull({hand_.by()});
      drag.commit();
      ++context_.changes;
      break;
    case Act::cancel:
      drag.cancel();
      ++context_.changes;
      break;
  }
  if (!answer.fits || context_.tools.asking() != nullptr || !context_.tools.allow_command(context_.options.fit)) return;
  context_.tools.command(context_.options.fit, std::nullopt);
  context_.trace.line("space mouse fits");
}

void SpaceMouseTool::cancel_gesture() {
  if (!hand_.holds()) return;
  hand_.let_go();
  context_.link.drag.cancel();
  ++context_.changes;
}

// --- moving the selection ---

/// Another drag goes first, and so does what is being asked or typed.
bool SpaceMouseTool::may_move() const {
  return context_.link.drag.running() == nullptr && context_.tools.asking() == nullptr && context_.open.dialog.owner == nullptr &&
         !context_.shown.older;
}

void SpaceMouseTool::take() {
  if (!may_move()) return context_.trace.line("space mouse takes nothing");
  const render::ModelSource& model = *context_.renderer.model();
  const std::optional<std::size_t> node = middle_node(model);
  if (!node) {
    context_.notices.say(notices::Notice::Kind::information,
                         "Nothing is selected: the SpaceMouse moves what is. Its second button has it move the view again.");
    ++context_.changes;
    return context_.trace.line("space mouse takes nothing");
  }
  if (!context_.tools.allow_edit()) return;
  const auto id = model.at<std::int64_t>(SnapshotArray::node_ids, *node);
  mesh::document::Translate move;
  move.shaping = context_.tools.shaping(id, context_.selection.centre.value_or(model.at<Vec3>(SnapshotArray::positions, *node)));
  if (context_.tools.hold(move, false)) return;
  context_.tools.leave_previews();
  context_.tools.edit_begins();
  context_.link.drag.begin(move);
  if (context_.link.drag.running() == nullptr) return;
  hand_.hold();
  context_.trace.line(fmt::format("space mouse takes {}", id));
  ++context_.changes;
}

// --- what is told ---

std::string SpaceMouseTool::does() const { return hand_.mode() == Mode::move ? "moves the selection" : "moves the view"; }

std::string SpaceMouseTool::live_words() const {
  if (!hand_.holds() || !context_.shown.snapshot) return {};
  return "SpaceMouse " + panels::length_text(hand_.by().norm(), context_.shown.snapshot->info().length_unit);
}

std::optional<toolkit::Light> SpaceMouseTool::light() const {
  if (context_.space_mice == nullptr) return std::nullopt;
  if (context_.space_mice->any())
    return toolkit::Light{hand_.mode() == Mode::move ? "SpaceMouse: selection" : "SpaceMouse: view", does(), true};
  if (!context_.space_mice->trouble().empty()) return toolkit::Light{"SpaceMouse: no access", context_.space_mice->trouble(), false};
  return std::nullopt;
}

void SpaceMouseTool::draw_status(panels::PanelLayout& layout) {
  if (context_.space_mice == nullptr) return;
  const drivers::space_mouse::SpaceMice& mice = *context_.space_mice;
  if (!mice.any() && mice.trouble().empty()) return;
  panels::section("SpaceMouse");
  if (mice.any()) panels::fact(panels::printable(mice.names()).c_str(), does());
  const std::string advice = !mice.trouble().empty()      ? mice.trouble()
                             : hand_.holds()              ? "Let it rest, or press button 1, to keep the move; Esc takes it back."
                             : hand_.mode() == Mode::move ? "Button 2: it moves the view."
                                                          : "Button 1 fits the view; button 2: it moves the selection.";
  ImGui::PushFont(panels::small_font());
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(panels::printable(advice).c_str());
  panels::note_item(layout, "SpaceMouse", advice);
  ImGui::PopTextWrapPos();
  ImGui::PopFont();
}

void SpaceMouseTool::trace_picture() {
  if (context_.space_mice == nullptr) return;
  const drivers::space_mouse::SpaceMice& mice = *context_.space_mice;
  std::string text = "space mouse none";
  if (mice.any()) text = fmt::format("space mouse {} {}", hand_.mode() == Mode::move ? "move" : "view", mice.names());
  if (text != traced_) context_.trace.line(traced_ = text);
}

}  // namespace prismesh::kiosk::tools::space_mouse
