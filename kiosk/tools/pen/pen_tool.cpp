#include "kiosk/tools/pen/pen_tool.h"

#include <fmt/format.h>

#include "kiosk/input/key_table.h"
#include "kiosk/toolkit/picking.h"
#include "kiosk/toolkit/tool_set.h"
#include "kiosk/tools/pen/pen_keys.h"
#include "kiosk/tools/pen/pen_section.h"
#include "kiosk/tools/pen/touched.h"
#include "mesh/document/generation.h"

namespace prismesh::kiosk::tools::pen {
namespace {

using notices::Notice;

constexpr double kGrabReachMm = 4;     ///< of the pen's space: so near a node is taken without touching
constexpr double kTouchReachMm = 2.5;  ///< the proxy is some 1.1 mm before the shell that it touches
constexpr double kStillMm = 0.05;      ///< of the pen's space: a smaller motion needs no new picture

}  // namespace

std::span<const input::KeyBinding> keys() { return kKeys; }

std::string_view PenTool::name() const { return kName; }

void PenTool::command(std::uint8_t number, const toolkit::Pointer&) {
  if (static_cast<PenCommand>(number) != PenCommand::arm) return;
  link::PenLink& pen = context_.pen;
  if (!pen.has_pen())
    return context_.notices.say(Notice::Kind::information, pen.is_connected()
                                                               ? "No haptic pen is configured: see [haptic_pen] in prismesh.toml."
                                                               : "The pen's process doesn't run: prismesh-deviced --only pen.");
  if (pen.info()->state == ipc::name(ipc::PenStage::armed))
    pen.disarm();
  else
    pen.arm();
}

// --- following the pen ---

void PenTool::watch(std::int64_t now_ns) {
  take_words();
  // modeld has ended the drag, or has ended itself.
  if (hand_.holds() && context_.link.drag.running() == nullptr) hand_.let_go();
  const std::optional<ipc::PenState> state = context_.pen.state();
  if (!state || !context_.shown.snapshot) {
    act(hand_.leave() ? PenHand::Act::cancel : PenHand::Act::none, {}, {});
    return show(std::nullopt);
  }
  const PenPose pose = pose_of(*state, now_ns);
  const PenHand::Act what = hand_.turn(pose, place_in_view(context_.view.view, context_.pen.info()->workspace_scale));
  context_.pen.place(told_place(hand_.place(), context_.shown.document_number));
  if (what != PenHand::Act::none && context_.tools.takes_input(true))
    act(hand_.leave() ? PenHand::Act::cancel : PenHand::Act::none, {}, {});
  else
    act(what, *state, pose);
  show(can_be_shown(*state, now_ns) ? std::optional(drawn(*state, pose)) : std::nullopt);
}

void PenTool::take_words() {
  if (std::string refusal = context_.pen.take_refusal(); !refusal.empty())
    context_.notices.say(Notice::Kind::warning, "The pen: " + refusal);
  if (context_.pen.changes() == words_) return;
  words_ = context_.pen.changes();
  ++context_.changes;
}

void PenTool::act(PenHand::Act act, const ipc::PenState& state, const PenPose& pose) {
  link::RemoteDrag& drag = context_.link.drag;
  switch (act) {
    case PenHand::Act::none: break;
    case PenHand::Act::press: press(state, pose); break;
    case PenHand::Act::pull: drag.pull(hand_.pulled()); break;
    case PenHand::Act::release:
      drag.pull(hand_.pulled());
      drag.commit();
      ++context_.changes;
      break;
    case PenHand::Act::cancel:
      drag.cancel();
      ++context_.changes;
      break;
  }
}

void PenTool::cancel_gesture() {
  if (!hand_.holds()) return;
  hand_.let_go();
  context_.link.drag.cancel();
  ++context_.changes;
}

void PenTool::document_changed() {
  cancel_gesture();
  hand_.forget_clutch();
}

// --- taking hold ---

std::optional<mesh::ShellIndex> PenTool::touched(const ipc::PenState& state) const {
  if (!state.touching) return std::nullopt;
  const Placement& place = hand_.place();
  return touched_shell(*context_.renderer.model(), state.element, place.to_model(Vec3(state.proxy_mm.data())), kTouchReachMm / place.scale);
}

std::optional<mesh::NodeIndex> PenTool::node_for(const ipc::PenState& state, const PenPose& pose) const {
  const Placement& place = hand_.place();
  const render::ModelSource& model = *context_.renderer.model();
  if (const auto shell = touched(state)) return nearest_corner(model, *shell, place.to_model(Vec3(state.proxy_mm.data())));
  return nearest_node(model, place.to_model(pose.position_mm), kGrabReachMm / place.scale);
}

Vec3 PenTool::shaft(const PenPose& pose) const { return hand_.place().turn.transpose() * shaft_of(pose, context_.pen.info()->left_handed); }

void PenTool::press(const ipc::PenState& state, const PenPose& pose) {
  using ipc::SnapshotArray;
  if (context_.link.drag.running() != nullptr || !context_.tools.allow_edit()) return;
  const render::ModelSource& model = *context_.renderer.model();
  const std::optional<mesh::NodeIndex> node = node_for(state, pose);
  if (!node || node->value >= model.size(SnapshotArray::node_ids)) return context_.trace.line("pen takes nothing");
  const auto id = model.at<std::int64_t>(SnapshotArray::node_ids, node->value);
  const bool selected = (model.at<std::uint8_t>(SnapshotArray::node_marks, node->value) & mesh::document::kSelected) != 0;
  mesh::document::Move move;
  move.point = model.at<Vec3>(SnapshotArray::positions, node->value);
  move.axis = shaft(pose);
  move.shaping = context_.tools.shaping(id, selected ? context_.selection.centre.value_or(move.point) : move.point);
  if (!selected) move.shaping.on = context_.tools.region(id);
  if (context_.tools.hold(move, false)) return;
  context_.tools.leave_previews();
  context_.tools.edit_begins();
  context_.link.drag.begin(move);
  if (context_.link.drag.running() == nullptr) return;
  hand_.hold(move.axis);
  context_.trace.line(fmt::format("pen takes {}", id));
  ++context_.changes;
}

// --- the picture ---

render::Pen PenTool::drawn(const ipc::PenState& state, const PenPose& pose) const {
  render::Pen pen;
  pen.tip = hand_.place().to_model(Vec3(state.position_mm.data()));
  pen.shaft = shaft(pose);
  pen.busy = hand_.holds();
  if (hand_.holds() || context_.shown.older) return pen;
  const std::optional<mesh::ShellIndex> shell = touched(state);
  if (!shell) return pen;
  const render::ModelSource& model = *context_.renderer.model();
  pen.busy = true;
  pen.shell = edges_of(model, *shell);
  const mesh::NodeIndex node = nearest_corner(model, *shell, hand_.place().to_model(Vec3(state.proxy_mm.data())));
  pen.node = model.at<Vec3>(ipc::SnapshotArray::positions, node.value);
  return pen;
}

void PenTool::show(const std::optional<render::Pen>& pen) {
  if (pen == shown_) return;
  if (pen && shown_) {
    const bool at_rest = (pen->tip - shown_->tip).norm() * hand_.place().scale < kStillMm && (pen->shaft - shown_->shaft).norm() < 0.005;
    if (at_rest && pen->busy == shown_->busy && pen->shell == shown_->shell && pen->node == shown_->node) return;
  }
  shown_ = pen;
  ++context_.changes;
}

void PenTool::trace_picture() {
  std::string text = "pen tip none";
  if (const auto tip = shown_ ? stereo::pixel_of(toolkit::aim(context_.view), shown_->tip) : std::nullopt)
    text = fmt::format("pen tip {:.1f} {:.1f} {}", tip->x(), tip->y(), hand_.holds() ? "holds" : shown_->busy ? "touches" : "free");
  if (text != traced_) context_.trace.line(traced_ = text);
}

void PenTool::draw_status(panels::PanelLayout&) {
  if (context_.pen.has_pen()) pen_section(*context_.pen.info(), hand_.holds());
}

std::vector<toolkit::RailEntry> PenTool::rail() const {
  if (!context_.pen.has_pen()) return {};
  return {{toolkit::RailPlace::pen, "Pen", &input::binding_of(kKeys, command_of(PenCommand::arm)), hand_.holds()}};
}

}  // namespace prismesh::kiosk::tools::pen
