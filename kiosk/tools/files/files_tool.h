// Opens and saves decks: keys, dialogs for paths, and questions before anything is lost or replaced.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "kiosk/toolkit/abilities.h"
#include "kiosk/toolkit/tool.h"
#include "kiosk/toolkit/tool_context.h"
#include "kiosk/tools/files/deck_files.h"
#include "kiosk/tools/files/path_box.h"

namespace prismesh::kiosk::tools::files {

std::span<const input::KeyBinding> keys();
/// Ends the kiosk; asks first, if there are unsaved edits.
input::Command quit_command();
input::Command save_command();

class FilesTool final : public toolkit::Tool, public toolkit::HasDialogs, public toolkit::AsksQuestions {
 public:
  explicit FilesTool(toolkit::ToolContext& context) : context_(context), deck_files_(context.link, context.trace) {}

  std::string_view name() const override;
  void command(std::uint8_t number, const toolkit::Pointer& pointer) override;
  Result<void> prepare() override;
  void draw_dialog(int kind, bool opened, panels::PanelLayout& layout) override;
  const panels::Question* question() const override { return deck_files_.question() ? &*deck_files_.question() : nullptr; }
  void reply(panels::Reply reply) override;

 private:
  std::string save_remark() const;
  void enter(PathDialog dialog, const std::string& path);

  toolkit::ToolContext& context_;
  DeckFiles deck_files_;
  PathEntry entry_;
};

}  // namespace prismesh::kiosk::tools::files
