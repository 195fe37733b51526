// What the editor shows: the picture's content, the panels' data, and what a watching program is told.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "kiosk/editor.h"
#include "kiosk/render/palette.h"

namespace prismesh::kiosk {
namespace {

using tools::Under;

constexpr std::size_t kManyShells = 200'000;

unsigned packed(const render::Colour& colour) {
  const auto byte = [](float value) { return static_cast<unsigned>(std::lround(std::clamp(value, 0.0F, 1.0F) * 255)); };
  return 0xff000000U | byte(colour.z()) << 16 | byte(colour.y()) << 8 | byte(colour.x());
}

/// Whether all ids, of which there are some, are in a list; both ascend.
bool all_in(const std::vector<std::int64_t>& ids, const std::vector<std::int64_t>& list) {
  return !ids.empty() && std::includes(list.begin(), list.end(), ids.begin(), ids.end());
}

}  // namespace

bool Editor::large_model() const { return shown_ && shown_->shell_count() > kManyShells; }

/// View, eyes and display, without what stands in the picture.
render::Picture Editor::plain_picture() const {
  render::Picture picture;
  picture.view = view_;
  picture.profile = profile_;
  picture.between_eyes_mm = seen_.between_eyes_mm;
  picture.toward_right = seen_.toward_right;
  picture.eye_separation_mm = seen_.eye_separation_mm;
  picture.depth_share = seen_.depth_share;
  picture.mask_mm = seen_.mask_mm;
  picture.panel = panel_;
  return picture;
}

render::Picture Editor::picture() const {
  render::Picture picture = plain_picture();
  picture.colour = colour_;
  picture.handle = shown_handle();
  picture.rubber_band = rubber_band_;
  picture.lasso = lasso_way_;
  picture.shadows = shadows_;
  comparing_.dress(picture, pane_shift());
  picture.damaged_only = review_.damaged;
  picture.marked = review_.marked;
  return picture;
}

panels::PanelData Editor::panel_data() const {
  panels::PanelData data;
  data.connected = link_.connected();
  data.socket = link_.socket().string();
  data.selecting = {lasso_, through_, region_by_, region_angle_, region_across_welds_};
  data.shaping = shaping_;
  data.shaping_open = shaping_open_;
  data.tool = tool_;
  data.guidance = guidance();
  data.history_bytes = link_.history_bytes();
  data.history_cap = link_.history_cap();
  data.shadows = shadows_;
  data.colour_by_quality = colour_ == render::ColourMode::quality;
  data.colour_by_state = colour_ == render::ColourMode::part_states;
  data.compare = comparing_.facts(pane_shift());
  // Of the right one of two views: in the other nothing is pulled.
  for (panels::LegendFacts& legend : data.compare->legends)
    legend.before_pull = preview_shown_ && legend.pane == static_cast<std::size_t>(render::Pane::model);
  data.quality = quality_facts();
  data.profile = profile_.name;
  data.eyes = eyes_facts_;
  if (profile_.stereo()) data.depth = panels::DepthFacts{depth_.percent(), depth_.degrees(), depth_.keeps_selection()};
  data.signs = comparing_.coloured() ? "no signs while values are shown" : review_.damaged ? "signs only of what edits made worse" : "";
  data.glyphs_left_out = report_.glyphs_left_out;
  data.busy = link_.busy();
  data.busy_fraction = link_.busy_fraction();
  data.help = cover_ == Cover::help;
  data.menu = cover_ == Cover::menu;
  if (cover_ == Cover::warnings && shown_) data.warnings = &link_.warnings();
  data.mouse = &mouse_words_;
  data.dialog = dialog_;
  if (files_.question()) data.question = &*files_.question();
  if (dialog_ == panels::Dialog::expression) {
    panels::ExpressionFacts& facts = data.expression.emplace();
    facts.entered = &expressions_.entries();
    if (const auto& counted = link_.counted()) {
      facts.counted_for = counted->expr;
      if (counted->counted)
        facts.count = panels::ExpressionFacts::Count{counted->counted->nodes, counted->counted->shells, counted->counted->parts};
      if (counted->failed) facts.problem = Error{counted->failed->file, counted->failed->line, counted->failed->message}.text();
      if (counted->failed && counted->failed->file == "expression") facts.column = counted->failed->line;
    }
  }
  if (dialog_ == panels::Dialog::number) {
    panels::NumberFacts& facts = data.number.emplace();
    const bool pull = typing_.what == Typing::For::pull;
    facts.title = pull                                      ? std::string(tools::name_of(tool_))
                  : typing_.what == Typing::For::move_limit ? "No node moves farther than"
                                                            : "The mirror stands at";
    facts.hint = pull ? std::string(tools::typed_hint(tool_)) : "a number; nothing takes it away";
    facts.begun = typing_.begun;
    facts.problem = typing_.problem;
  }
  if (!notices_.empty()) {
    data.notice = notices_.front();
    data.more_notices = notices_.count() - 1;
  }
  if (!shown_) return data;
  data.document = document_facts();
  data.pull = pull_facts();
  return data;
}

/// What the hand is in the middle of, and which of two states is shown.
std::string Editor::guidance() const {
  if (axis_pick_.active())
    return axis_pick_.first() ? "Axis: click the second node, Esc gives up" : "Axis: click the first node, Esc gives up";
  if (by_hand_.operation) return operation_words();
  return before_after_.words();
}

panels::DocumentFacts Editor::document_facts() const {
  const ipc::SnapshotInfo& info = shown_->info();
  panels::DocumentFacts facts;
  facts.path = info.document;
  facts.nodes = info.nodes;
  facts.shells = info.counts.ok + info.counts.warn + info.counts.fail;  // the arrays hold removed ones too
  facts.generation = info.generation;
  facts.length_unit = info.length_unit;
  facts.target_size = info.target_size;
  if (const auto& state = link_.state()) {
    facts.length_unit_guessed = state->length_unit_guessed;
    facts.target_size_guessed = state->target_size_guessed;
  }
  facts.changed = info.changed;
  facts.selected_nodes = info.selected_nodes;
  facts.selected_shells = info.selected_shells;
  facts.counts = info.counts;
  facts.parts.reserve(info.parts.size());
  std::vector<std::int64_t> hidden, locked;
  for (std::size_t i = 0; i < info.parts.size(); ++i) {
    const ipc::SnapshotPart& part = info.parts[i];
    const render::Colour& colour = render::part_colours()[render::colour_of_part(i, info.parts.size())];
    facts.parts.push_back({part.id, part.name, part.shells, packed(colour), part.hidden, part.locked});
    if (part.hidden) hidden.push_back(part.id);
    if (part.locked) locked.push_back(part.id);
  }
  if (!link_.state()) return facts;
  std::sort(hidden.begin(), hidden.end());
  std::sort(locked.begin(), locked.end());
  for (const ipc::DeckFile& file : link_.state()->files)
    facts.files.push_back({file.name, file.shells, file.parts.size(), all_in(file.parts, hidden), all_in(file.parts, locked)});
  return facts;
}

std::optional<panels::PullFacts> Editor::pull_facts() const {
  if (!pull_) return std::nullopt;
  panels::PullFacts pull;
  pull.what = std::string(tools::name_of(pull_->handle()));
  switch (pull_->handle()) {
    case Under::lift_handle: pull.length = pull_->along_arrow(pulled_); break;
    case Under::turn_handle: pull.degrees = pulled_.degrees; break;
    default: pull.length = pulled_.by.norm(); break;
  }
  if (const RemoteDrag* drag = link_.drag(); drag != nullptr && drag->begun()) {
    pull.nodes = drag->facts().nodes;
    if (drag->frame().sequence > 0) pull.counts = drag->frame().counts;
  }
  return pull;
}

void Editor::trace_picture() {
  if (!trace_.on()) return;
  const stereo::Aim now = aim();
  const Eigen::Matrix4d clip = now.clip_from_deck();
  std::string text = fmt::format("aim {} {}", now.width, now.height);
  for (int i = 0; i < 16; ++i) text += fmt::format(" {}", clip.data()[i]);
  if (text != traced_aim_) trace_.line(traced_aim_ = text);
  text = "handle none";
  if (const auto shown = shown_handle()) {
    const auto foot = stereo::pixel_of(now, shown->at), tip = stereo::pixel_of(now, stereo::handle_tip(now, shown->at, shown->direction));
    if (foot && tip) text = fmt::format("handle {:.1f} {:.1f} {:.1f} {:.1f}", foot->x(), foot->y(), tip->x(), tip->y());
  }
  if (text != traced_handle_) trace_.line(traced_handle_ = text);
  text = notices_.empty() ? "notice none" : trace_of(notices_.front());
  text.replace(0, std::string_view("notice").size(), "reads");
  if (text != traced_notice_) trace_.line(traced_notice_ = text);
}

}  // namespace prismesh::kiosk
