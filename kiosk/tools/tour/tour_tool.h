// A tour of a first edit: a card says what to do next, and goes on when it was done.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "kiosk/toolkit/abilities.h"
#include "kiosk/toolkit/tool.h"
#include "kiosk/toolkit/tool_context.h"

namespace prismesh::kiosk::tools::tour {

std::span<const input::KeyBinding> keys();

/// A step of the tour. The key that its words name first stands in `key`, as the key tables write it.
struct TourStep {
  std::string_view title, words;
  std::string_view key;      ///< empty: they name none
  std::string_view place{};  ///< the item on the screen that it is about, or kAtHandle; a frame is drawn around it. Empty: the whole view
};
inline constexpr std::string_view kAtHandle = "handle";
std::span<const TourStep> tour_steps();

class TourTool final : public toolkit::Tool, public toolkit::MovesView, public toolkit::DrawsOverPicture {
 public:
  explicit TourTool(toolkit::ToolContext& context) : context_(context) {}

  std::string_view name() const override;
  void command(std::uint8_t number, const toolkit::Pointer& pointer) override;
  /// Moves nothing: it looks whether the user has.
  void look(std::int64_t now_ns) override;
  Result<void> follow() override;
  void model_changed() override { context_.follow_soon = true; }
  void draw_over_picture(panels::PanelLayout& layout) override;

 private:
  /// Whether what the step asks for was done since it began.
  bool done() const;
  void go_to(std::size_t step);
  void end();
  void mark_place(panels::PanelLayout& layout) const;

  toolkit::ToolContext& context_;
  std::optional<std::size_t> step_;  ///< nothing: no tour
  std::uint64_t began_ = 0;          ///< generation at the step's beginning
  stereo::View seen_;                ///< the view then
  bool unsaved_ = false;             ///< the document had unsaved edits then
};

}  // namespace prismesh::kiosk::tools::tour
