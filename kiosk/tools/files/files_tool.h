// Opens and saves decks: keys, dialogs for paths, and questions before anything is lost or replaced.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "kiosk/toolkit/abilities.h"
#include "kiosk/toolkit/history_file.h"
#include "kiosk/toolkit/tool.h"
#include "kiosk/toolkit/tool_context.h"
#include "kiosk/tools/files/deck_files.h"
#include "kiosk/tools/files/path_box.h"
#include "kiosk/tools/files/report_writer.h"
#include "kiosk/tools/files/shelf.h"

namespace prismesh::kiosk::tools::files {

std::span<const input::KeyBinding> keys();
/// Ends the kiosk; asks first, if there are unsaved edits.
input::Command quit_command();
input::Command open_command();
input::Command save_command();

class FilesTool final : public toolkit::Tool, public toolkit::HasDialogs, public toolkit::AsksQuestions, public toolkit::Watches {
 public:
  explicit FilesTool(toolkit::ToolContext& context)
      : context_(context), deck_files_(context.link, context.trace), decks_(context.options.decks_opened) {}

  std::string_view name() const override;
  void command(std::uint8_t number, const toolkit::Pointer& pointer) override;
  Result<void> prepare() override;
  void document_changed() override;
  void draw_dialog(int kind, bool opened, panels::PanelLayout& layout) override;
  const panels::Question* question() const override { return deck_files_.question() ? &*deck_files_.question() : nullptr; }
  void reply(panels::Reply reply) override;
  void watch(std::int64_t now_ns) override;
  std::int64_t next_ns(std::int64_t now_ns) const override;

 private:
  void write_report();
  std::string save_remark() const;
  void enter(PathDialog dialog, const std::string& path);

  toolkit::ToolContext& context_;
  DeckFiles deck_files_;
  ReportWriter report_;
  toolkit::HistoryFile decks_;
  PathEntry entry_;
  std::vector<BrowseRow> shelf_;                             ///< as of when the box was opened
  std::vector<std::string> pairing_;                         ///< what is shown of a pairing code; empty: nothing
  std::string asked_;                                        ///< the path that was entered to be opened
  std::optional<link::WantedDeck::NotOpened> not_opened_{};  ///< shown in the box until another one is tried
};

}  // namespace prismesh::kiosk::tools::files
