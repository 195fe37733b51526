// A SpaceMouse in the hand: moves the view or the selection, and says which of both.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "drivers/space_mouse/space_mice.h"
#include "kiosk/toolkit/abilities.h"
#include "kiosk/toolkit/tool.h"
#include "kiosk/toolkit/tool_context.h"
#include "kiosk/tools/space_mouse/space_mouse_hand.h"

namespace prismesh::kiosk::tools::space_mouse {

class SpaceMouseTool final : public toolkit::Tool,
                             public toolkit::HasHandle,
                             public toolkit::Drags,
                             public toolkit::Watches,
                             public toolkit::TracesPicture,
                             public toolkit::TellsLive,
                             public toolkit::HasStatus,
                             public toolkit::HasLight {
 public:
  explicit SpaceMouseTool(toolkit::ToolContext& context) : context_(context) {}

  std::string_view name() const override { return "space mouse"; }
  input::Under under(const input::Pixel&) const override { return input::Under::picture; }
  toolkit::HandlePart part_at(const input::Pixel&) const override { return {}; }
  bool pulling() const override { return hand_.holds(); }
  bool dragging() const override { return hand_.holds(); }
  void cancel_gesture() override;
  void watch(std::int64_t now_ns) override;
  void document_changed() override { cancel_gesture(); }
  void trace_picture() override;
  std::string live_words() const override;
  std::string value_at_hand() const override { return {}; }
  void draw_status(panels::PanelLayout& layout) override;
  std::optional<toolkit::Light> light() const override;

 private:
  void take_words();
  SpaceMouseHand::Given given();
  void act(const SpaceMouseHand::Answer& answer);
  void take();
  bool may_move() const;
  std::string does() const;

  toolkit::ToolContext& context_;
  SpaceMouseHand hand_;
  std::uint64_t words_ = 0;  ///< of the devices, followed so far
  bool moved_before_ = false;
  std::string traced_;
};

}  // namespace prismesh::kiosk::tools::space_mouse
