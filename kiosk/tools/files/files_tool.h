// Opens and saves decks: keys, dialogs for paths, and questions before anything is lost or replaced.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "kiosk/tools/files/deck_files.h"
#include "kiosk/tools/files/path_box.h"
#include "kiosk/tools/tool.h"
#include "kiosk/tools/tool_context.h"

namespace prismesh::kiosk::tools::files {

std::span<const KeyBinding> keys();
/// Ends the kiosk; asks first, if there are unsaved edits.
Command quit_command();

class FilesTool final : public Tool {
 public:
  explicit FilesTool(ToolContext& context) : context_(context), deck_files_(context.link, context.trace) {}

  std::string_view name() const override;
  void command(std::uint8_t number, const Pointer& pointer) override;
  Result<void> prepare() override;
  void draw_dialog(int kind, bool opened, PanelLayout& layout) override;
  bool dialog_covers(int) const override { return true; }
  const Question* question() const override { return deck_files_.question() ? &*deck_files_.question() : nullptr; }
  void reply(Reply reply) override;

 private:
  std::string save_remark() const;
  void enter(PathDialog dialog, const std::string& path);

  ToolContext& context_;
  DeckFiles deck_files_;
  PathEntry entry_;
};

}  // namespace prismesh::kiosk::tools::files
