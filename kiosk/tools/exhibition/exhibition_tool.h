// The exhibition: a show until somebody comes, visits that end by themselves, and no way out without the PIN (docs/exhibition.md).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kiosk/toolkit/abilities.h"
#include "kiosk/toolkit/eyes_facts.h"
#include "kiosk/toolkit/tool.h"
#include "kiosk/toolkit/tool_context.h"
#include "kiosk/tools/exhibition/exhibition_panels.h"
#include "kiosk/tools/exhibition/pin_gate.h"
#include "kiosk/tools/exhibition/show_clock.h"
#include "kiosk/tools/exhibition/show_script.h"

namespace prismesh::kiosk::tools::exhibition {

/// Whether the tracker sees a face; nothing: there is no tracker, or it doesn't say.
std::optional<bool> face_seen(const std::optional<toolkit::EyesFacts>& eyes);

/// Does nothing unless the options say that this is an exhibition.
class ExhibitionTool final : public toolkit::Tool,
                             public toolkit::Watches,
                             public toolkit::GuardsInput,
                             public toolkit::DrawsOverPicture,
                             public toolkit::HasDialogs {
 public:
  explicit ExhibitionTool(toolkit::ToolContext& context);

  std::string_view name() const override;
  void watch(std::int64_t now_ns) override;
  bool takes_input(bool fresh) override;
  bool allow_command(const input::Command& command) override;
  std::int64_t next_ns(std::int64_t now_ns) const override;
  void draw_over_picture(panels::PanelLayout& layout) override;
  void draw_dialog(int kind, bool opened, panels::PanelLayout& layout) override;

 private:
  bool on() const { return context_.options.exhibition.has_value(); }
  bool locked() const { return on() && clock_.stage() != Stage::unlocked; }
  void follow_stage();
  void drop_notices();
  void restore_deck();
  bool shows_deck() const;
  void restored();
  void begin_visit();
  void play(std::int64_t now_ns);
  void begin_step(std::int64_t now_ns);
  void ask_pin();
  void enter_pin(const std::string& pin);

  toolkit::ToolContext& context_;
  ShowClock clock_;
  PinGate gate_;
  std::vector<ShowStep> show_;
  std::int64_t taken_until_ns_ = 0;  ///< what comes before it belongs to the touch that ended the show or the warning
  std::uint64_t connection_ = 0;     ///< to the model server; 0: there was none yet
  Stage traced_ = Stage::over;
  bool restoring_ = false;       ///< the deck isn't open as it lies on the disk yet
  std::int64_t restore_ns_ = 0;  ///< when that is asked for at the earliest
  bool asked_ = false;           ///< for that, after what was open was closed
  bool tour_due_ = false;        ///< a visit has begun: the tour begins with the deck
  // The show.
  std::optional<std::size_t> step_;  ///< nothing: the first one begins with the deck
  std::int64_t step_ns_ = 0;         ///< when it began
  double played_ = 0;                ///< share of the step's way that the view has gone
  ShowCard card_;
  PinEntry pin_;
};

}  // namespace prismesh::kiosk::tools::exhibition
