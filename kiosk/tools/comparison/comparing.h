// Asks the model server for fields and older states that are to be compared, and gives them to the renderer.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "kiosk/link/model_link.h"
#include "kiosk/render/renderer.h"
#include "kiosk/tools/comparison/compare_wish.h"
#include "kiosk/tools/comparison/legend_facts.h"

namespace prismesh::kiosk::tools::comparison {

class Comparing {
 public:
  Comparing(link::ModelLink& link, render::Renderer& renderer, notices::Trace trace) : link_(link), renderer_(renderer), trace_(trace) {}

  const CompareWish& wish() const { return wish_; }
  void set(const CompareWish& wish);
  /// Shows a state in place of the chosen one, until `end_glance` or until another one is chosen.
  void glance(std::uint64_t generation) { glance_ = generation; }
  void end_glance() { glance_.reset(); }
  /// The state to show; empty: always the current one.
  const std::optional<std::uint64_t>& shown() const { return glance_ ? glance_ : wish_.shown; }
  /// Why that state can't be shown; empty: it can, or the answer isn't here.
  const std::string& shown_problem() const { return main_.view_problem; }
  /// Shows the current state from now on.
  void show_current();
  void set_limits(const SetLimits& limits);
  void open_panel(bool open) { panel_open_ = open; }
  bool panel_open() const { return panel_open_; }
  /// The renderer's model is an older state than the current one: nothing in it can be picked.
  bool shows_older() const { return main_.view != nullptr; }
  /// A field's colours are on the model, or on the one beside it.
  bool coloured() const { return main_.made || other_.made; }
  bool two_views() const { return wish_.two_views && renderer_.other() != nullptr; }

  /// Call after the link has turned and before the renderer gets the current state: asks for what is missing. Errors: too large for the
  /// GPU.
  Result<void> follow();
  /// The state for the renderer's model: an older one, or else the current one.
  std::shared_ptr<const ipc::SnapshotView> model() const { return main_.view ? main_.view : link_.document.snapshot(); }
  /// By part, 1: hidden in the current state, and so in all that are shown.
  const std::vector<std::uint8_t>& hidden() const { return hidden_; }
  /// `shift`: as in render::TwoViews.
  void dress(render::Picture& picture, const render::TwoViews& both) const;
  CompareFacts facts(const render::TwoViews& both) const;
  /// What the colours of the model's view are of.
  enum class Of : std::uint8_t { nothing, nodes, shells };
  Of coloured_by() const { return !main_.values ? Of::nothing : main_.values->on_nodes() ? Of::nodes : Of::shells; }
  /// The value of a node or shell in the model's view, by its index; empty: it has none.
  std::optional<double> value_of(std::size_t index) const;

 private:
  /// One of the two views: which state it shows, and by what it is coloured.
  struct View {
    std::shared_ptr<const ipc::SnapshotView> view;  ///< of an older state; null: the current one
    std::optional<std::uint64_t> asked_view;
    std::optional<ipc::GetField> asked;  ///< answered or under way
    std::optional<ipc::FieldMade> made;
    std::shared_ptr<const ipc::FieldValues> values;  ///< of `made`
    std::string view_problem, field_problem;         ///< why there is no such state, no such field; empty: there is
  };
  using Pane = render::Pane;

  View& of(Pane pane) { return pane == Pane::model ? main_ : other_; }
  const View& of(Pane pane) const { return pane == Pane::model ? main_ : other_; }
  /// Older states hide the same parts as the current one. True: these have changed.
  bool follow_hidden();
  void follow_states();
  void follow_view(Pane pane, const std::optional<std::uint64_t>& generation);
  void follow_field(Pane pane, const std::optional<std::uint64_t>& generation);
  void took_field(Pane pane, const ipc::GetField& asked, const ipc::Answer& answer);
  void forget_field(Pane pane);
  /// Whether the choice of the field is complete.
  bool field_wanted() const;
  std::string words_of(const std::optional<std::uint64_t>& generation) const;
  std::vector<CompareFacts::Caption> captions(const render::TwoViews& both) const;

  link::ModelLink& link_;
  render::Renderer& renderer_;
  notices::Trace trace_;
  CompareWish wish_;
  std::optional<std::uint64_t> glance_;
  bool panel_open_ = false;
  View main_, other_;
  render::FieldLook look_;  ///< of both views, so that they can be compared
  std::string look_of_;     ///< title and unit of the values that its limits were set for
  std::vector<std::uint8_t> hidden_;
  std::shared_ptr<const ipc::SnapshotView> beside_;  ///< what the renderer has as the other model
  std::vector<ipc::ListedGeneration> states_;
  std::optional<std::uint64_t> states_of_;  ///< the current generation when they were asked for
  std::uint64_t connection_ = 0;
  std::uint64_t document_ = 0;   ///< FollowedDocument::number; 0: none
  std::optional<Error> failed_;  ///< of the renderer, in an answer
};

}  // namespace prismesh::kiosk::tools::comparison
