// Shows where parts cross or are too close: a list, an alerting texture on the shells, crossing curves, and the ways out of a region.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "kiosk/render/contact_picture.h"
#include "kiosk/toolkit/abilities.h"
#include "kiosk/toolkit/tool.h"
#include "kiosk/toolkit/tool_context.h"
#include "kiosk/tools/contact/contact_link.h"

namespace prismesh::kiosk::tools::contact {

std::span<const input::KeyBinding> keys();

/// What the renderer shows of an answer. `chosen`: the region with its ways out. `positions`: of a node, nothing if there is none such.
render::ContactPicture picture_of(const ipc::Contacts& contacts, const std::optional<std::size_t>& chosen,
                                  const std::function<std::optional<mesh::Vec3>(std::uint32_t)>& position);

class ContactTool final : public toolkit::Tool, public toolkit::InRail, public toolkit::HasOptions {
 public:
  explicit ContactTool(toolkit::ToolContext& context) : context_(context), link_(context.link) {}

  std::string_view name() const override;
  void command(std::uint8_t number, const toolkit::Pointer& pointer) override;
  Result<void> follow() override;
  void model_changed() override { shown_.reset(); }
  void document_changed() override;
  std::string_view panel_name() const override { return "contact"; }
  void draw_panel(panels::PanelLayout& layout) override;
  std::vector<toolkit::RailEntry> rail() const override;
  void draw_options(panels::OptionRow& row) override;
  std::string setting_words() const override;
  void panel_changed() override;

 private:
  /// Which marks the renderer has.
  struct Shown {
    std::uint64_t answers = 0;
    std::optional<std::size_t> chosen;
    bool operator==(const Shown&) const = default;
  };
  bool is_open() const { return context_.open.in_hand == this; }
  /// The regions are those of the state that the renderer draws.
  bool fits() const;
  void step(int by);
  void go_to(std::size_t region);
  Result<void> show();

  toolkit::ToolContext& context_;
  ContactLink link_;
  std::optional<std::size_t> chosen_;
  bool chosen_anew_ = false;
  std::uint64_t told_ = 0;      ///< the last answer that was traced
  std::optional<Shown> shown_;  ///< nothing: must be given to the renderer again, or taken away
  bool marked_ = false;         ///< the renderer has marks
};

}  // namespace prismesh::kiosk::tools::contact
