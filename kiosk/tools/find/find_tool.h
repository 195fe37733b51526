// Finds commands by what they do and carries them out; goes to a node, shell or part by id, and marks it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "kiosk/toolkit/abilities.h"
#include "kiosk/toolkit/history_file.h"
#include "kiosk/toolkit/tool.h"
#include "kiosk/toolkit/tool_context.h"
#include "kiosk/tools/find/find_box.h"
#include "kiosk/tools/find/typed_id.h"

namespace prismesh::kiosk::tools::find {

std::span<const input::KeyBinding> keys();
/// Opens the box.
input::Command find_command();

class FindTool final : public toolkit::Tool, public toolkit::HasDialogs, public toolkit::TakesBack {
 public:
  explicit FindTool(toolkit::ToolContext& context) : context_(context), used_(context.options.commands_used) {}

  std::string_view name() const override;
  void command(std::uint8_t number, const toolkit::Pointer& pointer) override;
  void model_changed() override;
  void document_changed() override { gone_to_.reset(); }
  void add_to_picture(render::Picture& picture) const override;
  std::string guidance() const override;
  bool take_back() override;
  void draw_dialog(int kind, bool opened, panels::PanelLayout& layout) override;

 private:
  struct Place {
    TypedId::Kind kind = TypedId::Kind::node;
    std::int64_t id = 0;
    std::size_t index = 0;  ///< in the shown model
  };
  struct Hit {
    std::variant<const input::KeyBinding*, Place> what;
    FindRow row;
  };
  /// What was found for a text, in a state of the model.
  struct Found {
    std::string text;
    std::uint64_t generation = 0;
    std::vector<Hit> hits;
    std::string problem;
  };

  void find();
  void find_places(std::string_view text);
  void add_place(const Place& place, const std::string& words);
  void take(const Hit& hit);
  void go_to(const Place& place);
  std::string words_of(const Place& place) const;

  toolkit::ToolContext& context_;
  toolkit::HistoryFile used_;
  FindEntry entry_;
  std::optional<Found> found_;
  std::optional<Place> gone_to_;
};

}  // namespace prismesh::kiosk::tools::find
