// The haptic pen in the picture: shows where it is and what it touches, and moves what it takes.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "kiosk/toolkit/abilities.h"
#include "kiosk/toolkit/tool.h"
#include "kiosk/toolkit/tool_context.h"
#include "kiosk/tools/pen/pen_hand.h"

namespace prismesh::kiosk::tools::pen {

std::span<const input::KeyBinding> keys();

class PenTool final : public toolkit::Tool,
                      public toolkit::HasHandle,
                      public toolkit::Drags,
                      public toolkit::Watches,
                      public toolkit::TracesPicture,
                      public toolkit::HasStatus,
                      public toolkit::InRail {
 public:
  explicit PenTool(toolkit::ToolContext& context) : context_(context) {}

  std::string_view name() const override;
  void command(std::uint8_t number, const toolkit::Pointer& pointer) override;
  input::Under under(const input::Pixel&) const override { return input::Under::picture; }
  toolkit::HandlePart part_at(const input::Pixel&) const override { return {}; }
  bool pulling() const override { return hand_.holds(); }
  bool dragging() const override { return hand_.holds(); }
  void cancel_gesture() override;
  void watch(std::int64_t now_ns) override;
  void document_changed() override;
  void add_to_picture(render::Picture& picture) const override { picture.pen = shown_; }
  void trace_picture() override;
  void draw_status(panels::PanelLayout& layout) override;
  std::vector<toolkit::RailEntry> rail() const override;

 private:
  void take_words();
  void act(PenHand::Act act, const ipc::PenState& state, const PenPose& pose);
  void press(const ipc::PenState& state, const PenPose& pose);
  std::optional<mesh::NodeIndex> node_for(const ipc::PenState& state, const PenPose& pose) const;
  std::optional<mesh::ShellIndex> touched(const ipc::PenState& state) const;
  render::Pen drawn(const ipc::PenState& state, const PenPose& pose) const;
  void show(const std::optional<render::Pen>& pen);
  Vec3 shaft(const PenPose& pose) const;

  toolkit::ToolContext& context_;
  PenHand hand_;
  std::optional<render::Pen> shown_;
  std::uint64_t words_ = 0;  ///< of the link, followed so far
  std::string traced_;
};

}  // namespace prismesh::kiosk::tools::pen
