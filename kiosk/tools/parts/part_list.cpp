#include "kiosk/tools/parts/part_list.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "kiosk/panels/layout.h"
#include "kiosk/panels/text.h"
#include "kiosk/panels/widgets.h"
#include "kiosk/tools/parts/file_expression.h"
#include "mesh/select/expression.h"

namespace prismesh::kiosk::tools::parts {
namespace {

using mesh::document::VisibilityAction;
using panels::grouped;
using panels::kFaintInk;
using panels::kGrid;
using panels::kInk;
using panels::PanelLayout;
using panels::printable;

constexpr float kLowEms = 17;  ///< a lower list has its actions in a menu
constexpr unsigned kChosenRow = 0x50ecb468U, kHoveredRow = 0x18ffffffU;

struct Column {
  const char* name;
  SortBy by;
};
constexpr std::array<Column, 4> kColumns{
    {{"id", SortBy::id}, {"name", SortBy::name}, {"shells", SortBy::shells}, {"errors", SortBy::errors}}};

/// "812", "26k", "1.2M": a count in four signs.
std::string short_count(std::uint64_t count) {
  if (count < 10'000) return std::to_string(count);
  if (count < 1'000'000) return fmt::format("{}k", count / 1000);
  return count < 10'000'000 ? fmt::format("{:.1f}M", static_cast<double>(count) / 1e6) : fmt::format("{}M", count / 1'000'000);
}

/// Where the columns of a row begin, from the left end of the list.
struct Columns {
  float indent, name, end, shells_end, errors_end, lock;  ///< `end`: of the name

  Columns() {
    ImGui::PushFont(panels::small_font());
    const float gap = kGrid * 0.75F, line = ImGui::GetFontSize();
    lock = ImGui::GetContentRegionAvail().x - line;
    errors_end = lock - gap;
    shells_end = errors_end - ImGui::CalcTextSize("errors\u2193").x - gap;
    end = shells_end - ImGui::CalcTextSize("shells\u2193").x - gap;
    ImGui::PopFont();
    name = ImGui::GetFontSize() + gap;
    indent = ImGui::GetFontSize() * 0.9F;
  }
};

void text_to(float right, float top, unsigned colour, const std::string& text) {
  ImFont& small = *panels::small_font();
  const float width = small.CalcTextSizeA(small.FontSize, 1e9F, 0, text.c_str()).x;
  ImGui::GetWindowDrawList()->AddText(&small, small.FontSize, ImVec2(std::floor(right - width), top), colour, text.c_str());
}

/// A padlock, closed or (faint) open.
void draw_lock(float x0, float y0, float size, bool locked, bool lit) {
  const unsigned colour = locked || lit ? kInk : 0x60aaa6a2U;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float x = x0 + size * 0.25F, y = y0 + size * 0.5F, w = size * 0.5F;
  list.AddRectFilled(ImVec2(x, y), ImVec2(x + w, y + size * 0.38F), colour, 1);
  const float radius = w * 0.34F, cx = x + w / 2 + (locked ? 0 : w * 0.5F);
  list.PathArcTo(ImVec2(cx, y), radius, 3.14159F, 6.28318F, 12);
  list.PathStroke(colour, 0, size * 0.1F);
}

/// The part's colour: filled while it is shown, a frame while it is hidden, half of it while it is transparent.
void draw_swatch(float x, float y, float size, unsigned colour, bool hidden, bool transparent) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 low(x + size * 0.15F, y + size * 0.15F), high(x + size * 0.85F, y + size * 0.85F);
  if (!hidden && transparent) list.AddTriangleFilled(ImVec2(low.x, high.y), low, high, colour);
  if (!hidden && !transparent) list.AddRectFilled(low, high, colour, 2);
  if (hidden || transparent) list.AddRect(low, high, colour, 2, 0, 1.5F);
}

/// The worse count with its sign.
void draw_errors(const Errors& errors, float right, float top, float line) {
  const bool fails = errors.fail > 0;
  if (!fails && errors.warn == 0) return;
  const std::string text = short_count(fails ? errors.fail : errors.warn);
  const unsigned colour = fails ? panels::kFailColour : panels::kWarnColour;
  ImFont& small = *panels::small_font();
  const float half = small.FontSize * 0.28F, x = right - small.CalcTextSizeA(small.FontSize, 1e9F, 0, text.c_str()).x - 2.6F * half,
              y = top + line / 2;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  if (fails)
    list.AddRectFilled(ImVec2(x - half, y - half), ImVec2(x + half, y + half), colour);
  else
    list.AddTriangleFilled(ImVec2(x, y - half), ImVec2(x + half, y + half), ImVec2(x - half, y + half), colour);
  text_to(right, top + (line - small.FontSize) / 2, kInk, text);
}

/// False: its middle was left out.
bool draw_name(const std::string& text, float x, float end, float top, unsigned colour) {
  const std::string shown = panels::elide_middle(text, static_cast<double>(end - x), [](std::string_view piece) {
    return static_cast<double>(ImGui::CalcTextSize(piece.data(), piece.data() + piece.size()).x);
  });
  ImGui::GetWindowDrawList()->AddText(ImVec2(x, top), colour, shown.c_str());
  return shown == text;
}

std::string words_of(const Errors& errors) {
  return errors.fail + errors.warn == 0 ? "no errors" : fmt::format("{} fail, {} warn", grouped(errors.fail), grouped(errors.warn));
}

/// What a row shows, of a file or a part.
struct RowFacts {
  std::string item, name, tip;
  std::uint64_t shells = 0;
  Errors errors;
  bool hidden = false, locked = false, chosen = false;
};

class List {
 public:
  List(PartTree& tree, PanelLayout& layout) : tree_(tree), layout_(layout) {}

  PartWishes lay_out() {
    low_ = ImGui::GetContentRegionAvail().y < kLowEms * ImGui::GetFontSize();
    filter();
    acted_on();
    actions();
    header();
    rows();
    if (change_) change_();
    return std::move(wishes_);
  }

 private:
  void filter() {
    std::string text = tree_.filter();
    const float clear = text.empty() ? 0 : ImGui::GetFrameHeight() + kGrid / 2;
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - clear);
    if (ImGui::InputTextWithHint("##filter", "find by id, name or file", &text)) change_ = [this, text] { tree_.set_filter(text); };
    panels::note_item(layout_, "parts filter", printable(text));
    if (clear == 0) return;
    ImGui::SameLine(0, kGrid / 2);
    if (ImGui::Button("\u00d7", ImVec2(ImGui::GetFrameHeight(), 0))) change_ = [this] { tree_.set_filter({}); };
    panels::note_item(layout_, "parts clear", "");
  }

  /// What the actions below are for, in words.
  void acted_on() {
    const std::size_t all = tree_.facts().parts.size(), acted = tree_.acted_on().size();
    const auto hidden = std::ranges::count_if(tree_.facts().parts, &PartRow::hidden);
    std::string words = tree_.acts_on_chosen() ? fmt::format("{} chosen", grouped(acted))
                        : acted == all         ? (all == 1 ? std::string("the only part") : fmt::format("all {} parts", grouped(all)))
                                               : fmt::format("{} of {} match", grouped(acted), grouped(all));
    if (hidden > 0) words += fmt::format(", {} hidden", grouped(static_cast<std::uint64_t>(hidden)));
    ImGui::PushFont(panels::small_font());
    ImGui::AlignTextToFramePadding();
    const float buttons = (tree_.acts_on_chosen() ? 4.5F : 0) + (low_ ? 6 : 0);
    panels::elided_text(words, ImGui::GetContentRegionAvail().x - buttons * ImGui::GetFontSize());
    panels::note_item(layout_, "parts acted on", words);
    if (tree_.acts_on_chosen()) {
      ImGui::SameLine();
      if (ImGui::SmallButton("none")) change_ = [this] { tree_.choose_none(); };
      panels::note_item(layout_, "parts none", "");
    }
    if (low_) {
      ImGui::SameLine();
      if (ImGui::SmallButton("actions")) ImGui::OpenPopup("actions");
      panels::note_item(layout_, "parts actions", "");
    }
    ImGui::PopFont();
  }

  /// As a row of buttons, or where the list would have no room below it as a menu.
  void actions() {
    if (!low_) return action_buttons();
    if (!ImGui::BeginPopup("actions")) return;
    action_buttons();
    ImGui::EndPopup();
  }

  void action_buttons() {
    const PartFacts& facts = tree_.facts();
    const std::vector<std::size_t>& acted = tree_.acted_on();
    const auto all_are = [&](bool PartRow::*flag) {
      return !acted.empty() && std::ranges::all_of(acted, [&](std::size_t p) { return facts.parts[p].*flag; });
    };
    const bool locked = all_are(&PartRow::locked), transparent = all_are(&PartRow::transparent);
    if (acted.empty()) ImGui::BeginDisabled();
    first_button_ = true;
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(kGrid * 0.75F, kGrid / 4));
    if (button("show", "show them, beside what is shown")) edit(VisibilityAction::show);
    if (button("hide", "hide them")) edit(VisibilityAction::hide);
    if (button("only", "show them only")) edit(VisibilityAction::only);
    if (button("reverse", "show those of them that are hidden, hide the others")) edit(VisibilityAction::reverse);
    if (button(locked ? "unlock" : "lock", locked ? "their nodes may move again" : "their nodes shall not move"))
      edit(locked ? VisibilityAction::unlock : VisibilityAction::lock);
    if (button(transparent ? "opaque" : "transparent", "see through them and pick what is behind, in this window only"))
      wishes_.paints.push_back({acted_ids(), !transparent, false, {}});
    if (button("colour", "their colour in this window")) ImGui::OpenPopup("colours");
    ImGui::PopStyleVar();
    if (acted.empty()) ImGui::EndDisabled();
    colours();
  }

  /// A button of the row, which goes on in the next line where there is no room.
  bool button(const char* label, const char* tip) {
    const float width = ImGui::CalcTextSize(label).x + 2 * ImGui::GetStyle().FramePadding.x;
    if (!first_button_ && !low_) {
      ImGui::SameLine(0, kGrid / 2);
      if (width > ImGui::GetContentRegionAvail().x) ImGui::NewLine();
    }
    first_button_ = false;
    const bool clicked = low_ ? ImGui::Selectable(label, false, ImGuiSelectableFlags_DontClosePopups) : ImGui::Button(label);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", tip);
    // Of the menu's entries only "colour" leads on.
    if (clicked && low_ && std::string_view(label) != "colour") ImGui::CloseCurrentPopup();
    panels::note_item(layout_, std::string("parts ") + label, "");
    return clicked;
  }

  void colours() {
    if (!ImGui::BeginPopup("colours")) return;
    const float size = std::round(1.4F * ImGui::GetFontSize());
    const std::vector<render::Colour> all = choosable_colours();
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (i % 7 != 0) ImGui::SameLine(0, kGrid / 2);
      ImGui::PushID(static_cast<int>(i));
      const ImVec2 at = ImGui::GetCursorScreenPos();
      const bool clicked = ImGui::InvisibleButton("colour", ImVec2(size, size));
      ImGui::GetWindowDrawList()->AddRectFilled(at, ImVec2(at.x + size, at.y + size), packed(all[i]), 2);
      if (ImGui::IsItemHovered()) ImGui::GetWindowDrawList()->AddRect(at, ImVec2(at.x + size, at.y + size), kInk, 2, 0, 2);
      panels::note_item(layout_, fmt::format("parts colour {}", i), "");
      ImGui::PopID();
      if (clicked) paint(all[i]);
    }
    if (ImGui::Button("their own")) paint(std::nullopt);
    panels::note_item(layout_, "parts own colour", "");
    ImGui::EndPopup();
  }

  void paint(const std::optional<render::Colour>& colour) {
    wishes_.paints.push_back({acted_ids(), std::nullopt, true, colour});
    ImGui::CloseCurrentPopup();
  }

  std::vector<std::int64_t> acted_ids() const {
    std::vector<std::int64_t> ids;
    for (const std::size_t p : tree_.acted_on()) ids.push_back(tree_.facts().parts[p].id);
    return ids;
  }
  void edit(VisibilityAction action) { wishes_.edits.push_back({mesh::select::to_expression(acted_ids()), action}); }

  void header() {
    // As wide as the rows, which leave room for the bar that scrolls.
    const Columns columns = columns_less(ImGui::GetStyle().ScrollbarSize);
    ImGui::PushFont(panels::small_font());
    const float left = ImGui::GetCursorPosX(), top = ImGui::GetCursorPosY();
    float x = columns.name;
    for (const Column& column : kColumns) {
      const bool sorted = tree_.sorted_by() == column.by;
      const std::string label = std::string(column.name) + (!sorted ? "" : tree_.descending() ? "\u2193" : "\u2191");
      const float width = ImGui::CalcTextSize(label.c_str()).x;
      if (column.by == SortBy::shells) x = columns.shells_end - width;
      if (column.by == SortBy::errors) x = columns.errors_end - width;
      ImGui::SetCursorPos(ImVec2(left + x, top));
      const ImVec2 at = ImGui::GetCursorScreenPos();
      if (ImGui::InvisibleButton(column.name, ImVec2(width, ImGui::GetFontSize() + kGrid / 2)))
        change_ = [this, by = column.by] { tree_.sort(by); };
      if (ImGui::IsItemHovered()) ImGui::SetTooltip("sort by it; again: the other way round");
      ImGui::GetWindowDrawList()->AddText(at, sorted || ImGui::IsItemHovered() ? kInk : kFaintInk, label.c_str());
      panels::note_item(layout_, std::string("parts sort ") + column.name, !sorted ? "" : tree_.descending() ? "descending" : "ascending");
      x += ImGui::CalcTextSize("id\u2193").x + 2 * kGrid;
    }
    ImGui::PopFont();
    ImGui::SetCursorPos(ImVec2(left, top + panels::small_font()->FontSize + kGrid / 2));
  }

  static Columns columns_less(float width) {
    Columns columns;
    for (float Columns::*each : {&Columns::end, &Columns::shells_end, &Columns::errors_end, &Columns::lock}) columns.*each -= width;
    return columns;
  }

  void rows() {
    const Columns columns = columns_less(ImGui::GetStyle().ScrollbarSize);
    ImGui::BeginChild("list");
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(0, 0));
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(tree_.rows().size()), std::round(1.45F * ImGui::GetFontSize()));
    while (clipper.Step())
      for (int r = clipper.DisplayStart; r < clipper.DisplayEnd; ++r) row(static_cast<std::size_t>(r), columns);
    if (tree_.rows().empty()) ImGui::TextDisabled("no part matches");
    ImGui::PopStyleVar();
    ImGui::EndChild();
  }

  RowFacts facts_of(const TreeRow& at) const {
    if (at.is_file()) {
      const FileRow& file = tree_.facts().files[at.file];
      const std::string name = printable(file.name);
      return {"file " + name,
              name,
              fmt::format("{}\n{} parts, {} shells, {}", name, grouped(file.parts.size()), grouped(file.shells), words_of(file.errors)),
              file.shells,
              file.errors,
              file.hidden,
              file.locked,
              false};
    }
    const PartRow& part = tree_.facts().parts[at.part];
    const std::string name = part.name.empty() ? fmt::format("part {}", part.id) : fmt::format("{}  {}", part.id, printable(part.name));
    return {fmt::format("part {}", part.id),
            name,
            fmt::format("{}\n{} shells, {}\ndouble click: only this part", name, grouped(part.shells), words_of(part.errors)),
            part.shells,
            part.errors,
            part.hidden,
            part.locked,
            tree_.chosen(at.part)};
  }

  void row(std::size_t r, const Columns& columns) {
    const TreeRow at = tree_.rows()[r];
    const RowFacts facts = facts_of(at);
    const float line = ImGui::GetFontSize(), height = std::round(1.45F * line), width = columns.lock + line;
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImGui::PushID(static_cast<int>(at.file & 0x7fffffffU));
    ImGui::PushID(static_cast<int>(at.part & 0x7fffffffU));
    const bool clicked = ImGui::InvisibleButton("row", ImVec2(width, height));
    const bool hovered = ImGui::IsItemHovered(), twice = hovered && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left);
    ImGui::PopID();
    ImGui::PopID();
    note(at, facts);
    const float pointer = ImGui::GetIO().MousePos.x - corner.x;
    const float indent = at.is_file() || at.file == TreeRow::kNone ? 0 : columns.indent;
    const bool on_sign = pointer < indent + columns.name, on_lock = pointer >= columns.lock;
    const bool whole = draw_row(at, facts, columns, corner, {indent, hovered, hovered && on_lock});
    if (hovered && on_sign) ImGui::SetTooltip("%s", at.is_file() ? "fold or unfold" : facts.hidden ? "show" : "hide");
    if (hovered && on_lock) ImGui::SetTooltip("%s", facts.locked ? "locked: its nodes don't move" : "lock: its nodes shall not move");
    // It covers the rows below: only where the row doesn't say as much.
    if (hovered && !on_sign && !on_lock && (!whole || pointer > columns.end)) ImGui::SetTooltip("%s", facts.tip.c_str());
    const std::string on = at.is_file() ? file_expression(tree_.facts().files[at.file].name) : std::to_string(part_id(at));
    if (twice && !on_sign && !on_lock) wishes_.edits.push_back({on, VisibilityAction::only});
    if (!clicked) return;
    if (on_lock) {
      wishes_.edits.push_back({on, facts.locked ? VisibilityAction::unlock : VisibilityAction::lock});
    } else if (on_sign && at.is_file()) {
      change_ = [this, file = at.file] { tree_.fold(file); };
    } else if (on_sign) {
      wishes_.edits.push_back({on, facts.hidden ? VisibilityAction::show : VisibilityAction::hide});
    } else {
      const ImGuiIO& io = ImGui::GetIO();
      const Choice choice = io.KeyShift ? Choice::up_to : io.KeyCtrl ? Choice::other : Choice::only;
      change_ = [this, r, choice] { tree_.choose(r, choice); };
    }
  }

  std::int64_t part_id(const TreeRow& at) const { return tree_.facts().parts[at.part].id; }

  void note(const TreeRow& at, const RowFacts& facts) {
    std::string state = facts.hidden ? "hidden" : "shown";
    if (facts.locked) state += " locked";
    if (at.is_file() && tree_.folded(at.file)) state += " folded";
    if (!at.is_file() && tree_.facts().parts[at.part].transparent) state += " transparent";
    if (facts.chosen) state += " chosen";
    panels::note_item(layout_, facts.item, std::move(state));
  }

  struct Hover {
    float indent;
    bool row, lock;
  };
  /// False: the name is cut.
  bool draw_row(const TreeRow& at, const RowFacts& facts, const Columns& columns, ImVec2 corner, const Hover& hover) {
    const float line = ImGui::GetFontSize(), height = std::round(1.45F * line), x = corner.x + hover.indent;
    const float top = corner.y + std::floor((height - line) / 2), small_top = corner.y + (height - panels::small_font()->FontSize) / 2;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    if (facts.chosen || hover.row)
      list.AddRectFilled(corner, ImVec2(corner.x + columns.lock + line, corner.y + height), facts.chosen ? kChosenRow : kHoveredRow, 2);
    if (at.is_file())
      list.AddText(ImVec2(x, top), kInk, tree_.folded(at.file) ? "\u25b8" : "\u25be");
    else
      draw_swatch(x, top, line, tree_.facts().parts[at.part].colour, facts.hidden, tree_.facts().parts[at.part].transparent);
    const bool whole = draw_name(facts.name, x + columns.name, corner.x + columns.end, top, facts.hidden ? kFaintInk : kInk);
    text_to(corner.x + columns.shells_end, small_top, kFaintInk, short_count(facts.shells));
    draw_errors(facts.errors, corner.x + columns.errors_end, corner.y, height);
    if (facts.locked || hover.row) draw_lock(corner.x + columns.lock, top, line, facts.locked, hover.lock);
    return whole;
  }

  PartTree& tree_;
  PanelLayout& layout_;
  PartWishes wishes_;
  std::function<void()> change_;  ///< of the tree, after its rows are laid out
  bool first_button_ = true, low_ = false;
};

}  // namespace

PartWishes part_list(PartTree& tree, panels::PanelLayout& layout) { return List(tree, layout).lay_out(); }

std::vector<render::Colour> choosable_colours() {
  const auto& parts = render::part_colours();
  std::vector<render::Colour> all(parts.begin(), parts.begin() + 7);
  all.insert(all.end(), parts.begin() + 14, parts.begin() + 21);
  for (const float grey : {0.75F, 0.58F, 0.42F, 0.28F}) all.emplace_back(grey, grey, grey);
  return all;
}

unsigned packed(const render::Colour& colour) {
  const auto byte = [](float value) { return static_cast<unsigned>(std::lround(std::clamp(value, 0.0F, 1.0F) * 255)); };
  return 0xff000000U | byte(colour.z()) << 16 | byte(colour.y()) << 8 | byte(colour.x());
}

}  // namespace prismesh::kiosk::tools::parts
