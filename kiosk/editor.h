// What the hand's gestures and keys mean for the model and the view: they become edits sent to the model server, or another view.
// Knows the renderer (for what lies under the pointer) but no window.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/clock.h"
#include "kiosk/before_after.h"
#include "kiosk/comparing.h"
#include "kiosk/deck_files.h"
#include "kiosk/display/window.h"
#include "kiosk/model_link.h"
#include "kiosk/notices.h"
#include "kiosk/panels/panels.h"
#include "kiosk/quality_link.h"
#include "kiosk/render/renderer.h"
#include "kiosk/stereo/tracked_eyes.h"
#include "kiosk/tools/axis_pick.h"
#include "kiosk/tools/by_hand.h"
#include "kiosk/tools/command.h"
#include "kiosk/tools/depth.h"
#include "kiosk/tools/gestures.h"
#include "kiosk/tools/handle.h"
#include "kiosk/tools/history_file.h"
#include "kiosk/tools/shaping_options.h"
#include "kiosk/tools/typed_number.h"
#include "kiosk/tools/view_glide.h"

namespace prismesh::kiosk {

struct EditorOptions {
  stereo::Profile profile;
  tools::MouseLayout mouse = tools::default_mouse_layout();
  std::filesystem::path expressions{};  ///< where entered expressions are kept; empty: nowhere
  bool follows_others = false;          ///< moves together with other kiosks that do
};

class Editor {
 public:
  Editor(const EditorOptions& options, ModelLink& link, render::Renderer& renderer, Clock& clock, Trace trace);

  void set_picture_size(display::PixelSize size);
  /// Width at the left and right that panels cover: `fit` leaves it free.
  void set_covered_width(double pixels) { covered_width_ = pixels; }
  /// What the next picture is drawn for. Depth follows.
  void look_from(const stereo::SeenFrom& seen);
  void set_eyes_facts(std::optional<panels::EyesFacts> facts);
  void set_panel(const render::PanelPlace& panel);
  const render::PanelPlace& panel() const { return panel_; }
  /// Follows the model server: its generation, its drag, its words. Errors: a model too large for the GPU.
  Result<void> follow();

  tools::Under under(const tools::Pixel& pixel) const;  ///< of the handle; panels are not its matter
  void gesture(const tools::Gesture& gesture);
  /// `pointer`: where it is, if it is on the picture and on no panel. False: a command that isn't the editor's (fullscreen, help).
  bool command(tools::Command command, const std::optional<tools::Pixel>& pointer);
  void panel_action(const panels::PanelAction& action);

  bool dialog_open() const { return dialog_ != panels::Dialog::none || files_.question(); }
  /// Replies to the question that is asked, if the key does that.
  bool reply_by_key(display::Key key);
  /// Typing a number now would say how far: something is pulled, or the pointer is over a part of the handle.
  bool takes_numbers(const std::optional<tools::Pixel>& pointer) const;
  /// `text`: what has been typed of it.
  void begin_number(const std::string& text, const std::optional<tools::Pixel>& pointer);
  /// What the pointer was dragging is let go without effect.
  void cancel_gesture();

  render::Picture picture() const;
  panels::PanelData panel_data() const;
  void set_report(const render::DrawReport& report) { report_ = report; }
  /// So many shells that a picture of them at rest may be too slow for the hand.
  bool large_model() const;
  const stereo::Profile& profile() const { return profile_; }
  /// The view is on its way to another, without the hand.
  bool gliding() const { return depth_.moving() || glide_.moving(); }
  /// Counts up with everything that changes the picture or the panels.
  std::uint64_t changes() const { return changes_; }
  std::optional<std::uint64_t> shown_generation() const { return shown_ ? std::optional(shown_->info().generation) : std::nullopt; }
  /// Writes what a watching program needs to aim: the projection and the handle's place, when they changed.
  void trace_picture();

 private:
  void handle(const tools::NodeClicked& click);
  void handle(const tools::RegionClicked& click);
  void handle(const tools::TakeBackClicked& click);
  void handle(const tools::OutlineDrawn& outline);
  void handle(const tools::OutlineDone& outline);
  void handle(const tools::Orbited& orbit);
  void handle(const tools::Panned& pan);
  void handle(const tools::Zoomed& zoom);
  void handle(const tools::AngleTurned& turned);
  void handle(const tools::HandleTaken& taken);
  void handle(const tools::HandleMoved& moved);
  void handle(const tools::HandleReleased& released);

  render::Picture plain_picture() const;
  stereo::Aim aim() const;
  void view_moved();

  // --- editor_select.cpp ---
  std::optional<mesh::NodeIndex> node_at(const tools::Pixel& pixel);
  void clear_selection();
  void select_nodes(const mesh::NodeSet& nodes, mesh::document::SelectMode mode);
  void select_region(const tools::Pixel& at, mesh::document::SelectMode mode);
  void change_angle(double degrees);
  bool is_rectangle(bool other_kind) const { return lasso_ == other_kind; }
  void open_expression();
  void expression_changed(const panels::ExpressionTyped& typed);
  void enter_expression(const panels::ExpressionEntered& entered);
  std::optional<mesh::PartIndex> part_at(const std::optional<tools::Pixel>& pointer);
  void set_parts(mesh::document::VisibilityAction action, const std::optional<tools::Pixel>& pointer);
  void set_file(tools::Command command, const std::optional<tools::Pixel>& pointer);
  void show_all();

  // --- editor_shape.cpp ---
  void begin_pull(tools::Under handle, const tools::Pixel& at);
  void pull_to(const tools::Pixel& pixel);
  void send_pull();
  void cancel_pull();
  Result<void> follow_drag();
  std::optional<render::Handle> shown_handle() const;
  void set_axis(const std::optional<tools::Axis>& axis, const std::string& what);
  void pick_axis();
  void axis_clicked(const tools::Pixel& at);
  void axis_from_edge(const std::optional<tools::Pixel>& pointer);
  void axis_from_deck(tools::DeckAxis axis);
  void enter_number(const std::string& text);
  bool change_shaping(tools::Command command);

  // --- editor_quality.cpp ---
  QualityLink::Wish quality_wish() const;
  bool quality_command(tools::Command command, const std::optional<tools::Pixel>& pointer);
  bool quality_action(const panels::PanelAction& action);
  std::optional<panels::QualityFacts> quality_facts() const;
  void relax(mesh::document::Scope scope);
  void relax_from(const std::optional<tools::Pixel>& pointer);
  void repair(mesh::document::Scope scope);
  void follow_quality();
  void step_error(int by);
  void go_to_error(std::size_t error);
  void leave_error();
  std::optional<mesh::ShellIndex> shell_with_id(std::int64_t id) const;
  void pick_operation(mesh::repair::Operation operation, const std::optional<tools::Pixel>& pointer);
  void operation_clicked(const tools::Pixel& at);
  void do_operation();
  void leave_operation();
  void leave_operation_picked();
  void follow_operation();
  std::string operation_words() const;

  // --- editor_commands.cpp ---
  enum class LeftPanel : std::uint8_t { document, quality, comparing, shaping };
  LeftPanel left_panel() const;
  void show_left(LeftPanel panel);
  void toggle_left(LeftPanel panel) { show_left(left_panel() == panel ? LeftPanel::document : panel); }
  bool select_command(tools::Command command, const std::optional<tools::Pixel>& pointer);
  bool shape_command(tools::Command command, const std::optional<tools::Pixel>& pointer);
  bool view_command(tools::Command command);
  void look(std::string_view view_name);
  void fit();
  void next_profile();
  void cancel();
  void open_dialog(panels::Dialog dialog);
  /// What is read in place of the side panels.
  enum class Cover : std::uint8_t { none, menu, help, warnings };
  void cover(Cover cover);
  void toggle_cover(Cover cover) { this->cover(cover_ == cover ? Cover::none : cover); }

  // --- following ---
  void take_model();
  void bring_selection();
  /// Follow at the next turn, though the server has said nothing.
  void follow_soon() { link_changes_ = ~std::uint64_t{0}; }

  // --- editor_compare.cpp ---
  bool compare_command(tools::Command command);
  bool compare_action(const panels::PanelAction& action);
  Result<void> follow_states();
  void compare();
  void send(mesh::document::Edit edit);
  bool leave_older_state();
  std::string save_remark() const;
  double pane_shift() const;
  bool beside(const tools::Pixel& pixel) const;
  bool pickable(const tools::Pixel& pixel) const { return !comparing_.shows_older() && !beside(pixel); }
  tools::Pixel in_picked_view(const tools::Pixel& pixel) const;
  void resize_view(double by);
  void share_view();
  void take_shared_view();

  // --- editor_facts.cpp ---
  panels::DocumentFacts document_facts() const;
  std::optional<panels::PullFacts> pull_facts() const;
  std::string guidance() const;

  ModelLink& link_;
  render::Renderer& renderer_;
  Clock& clock_;
  Trace trace_;
  display::PixelSize size_{1, 1};
  double covered_width_ = 0;
  stereo::Profile profile_;
  stereo::SeenFrom seen_;
  render::PanelPlace panel_;
  std::optional<panels::EyesFacts> eyes_facts_;
  tools::DepthFit depth_;
  stereo::View view_;
  render::ColourMode colour_ = render::ColourMode::parts;
  bool through_ = false;
  bool lasso_ = true;
  mesh::document::RegionBy region_by_ = mesh::document::RegionBy::features;
  double region_angle_ = 30;
  bool region_across_welds_ = false;
  std::optional<mesh::document::SelectRegion> last_region_;  ///< picked last, while nothing else was selected since
  tools::HistoryFile expressions_;
  std::vector<tools::MouseBinding> mouse_words_;
  tools::ShapingOptions shaping_;
  bool shaping_open_ = false, shadows_ = false;
  tools::Under tool_ = tools::Under::lift_handle;  ///< what numbers are typed for
  tools::AxisPick axis_pick_;
  std::optional<tools::Axis> axis_;
  /// What the number that is being typed is for.
  struct Typing {
    enum class For : std::uint8_t { pull, move_limit, symmetry_place } what = For::pull;
    std::string begun;
    std::string problem;
  };
  Typing typing_;
  QualityLink quality_;
  /// What is looked at of the shells' quality.
  struct Review {
    bool open = false;
    std::string metric;  ///< empty: all
    bool damaged = false;
    std::optional<std::size_t> error;  ///< which of the errors is gone to, and of which shell it is
    std::int64_t shell = 0;
    std::optional<mesh::ShellIndex> marked;
  };
  Review review_;
  tools::ViewGlide glide_;
  /// An operation by hand that is picked, and what it would be done to.
  struct ByHand {
    std::optional<mesh::repair::Operation> operation;
    std::optional<tools::HandTarget> target;
    std::optional<mesh::document::Restructure> edit;
    std::uint64_t generation = 0;
    std::uint64_t shown = 0;  ///< the preview that is in the picture; 0: none
  };
  ByHand by_hand_;
  std::optional<std::uint64_t> preview_kept_;  ///< the generation whose preview stays until what it shows is done
  panels::Dialog dialog_ = panels::Dialog::none;
  Cover cover_ = Cover::none;

  DeckFiles files_;
  Notices notices_;
  Comparing comparing_;
  BeforeAfter before_after_;
  std::vector<std::uint8_t> drawn_hidden_;          ///< parts that the renderer was told to hide
  std::shared_ptr<const ipc::SnapshotView> drawn_;  ///< the renderer's model: the current state, or an older one
  bool follows_others_ = false;
  std::optional<ipc::Camera> shared_;  ///< said or heard last

  std::shared_ptr<const ipc::SnapshotView> shown_;
  std::uint64_t document_number_ = 0;  ///< ModelLink::document_number of what is shown
  std::uint64_t link_changes_ = 0;
  std::optional<mesh::NodeIndex> last_clicked_;
  std::optional<tools::Anchor> anchor_;
  std::optional<mesh::Vec3> selection_centre_;
  std::optional<tools::HandlePull> pull_;
  tools::Pull pulled_;
  bool preview_shown_ = false;
  std::uint64_t preview_sequence_ = 0;
  tools::Pixel pulled_to_ = tools::Pixel::Zero();
  bool axis_taken_ = false;                ///< the server has said along which normal: only then a distance means something to it
  bool released_early_ = false;            ///< before that
  std::optional<tools::Pull> typed_pull_;  ///< by so much, whatever the pointer says; of a lift: along the arrow
  std::optional<render::PixelRect> rubber_band_;
  std::vector<tools::Pixel> lasso_way_;
  bool pivot_found_ = false;
  tools::Pixel orbit_from_ = tools::Pixel::Zero();
  render::DrawReport report_;
  std::uint64_t changes_ = 0;
  std::string traced_aim_;
  std::string traced_handle_;
  std::string traced_quality_;
  std::string traced_notice_ = "reads none";
};

}  // namespace prismesh::kiosk
