#include "kiosk/tools/comparison/comparing.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "ipc/wire/failure.h"
#include "kiosk/link/notice_words.h"

namespace prismesh::kiosk::tools::comparison {

namespace {

bool same(const ipc::GetField& a, const ipc::GetField& b) {
  return a.field == b.field && a.generation == b.generation && a.against == b.against && a.against_generation == b.against_generation &&
         a.from == b.from && a.to == b.to;
}

constexpr int kBands = 10;

std::string words_of_state(const ipc::ListedGeneration& state) {
  return state.made_by == "open" ? fmt::format("{}: as opened", state.number) : fmt::format("{}: {}", state.number, state.made_by);
}

}  // namespace

void Comparing::set(const CompareWish& wish) {
  if (wish.shown != wish_.shown) end_glance();
  wish_ = wish;
  for (View* view : {&main_, &other_})
    if (!view->field_problem.empty()) view->asked.reset();  // whoever chooses again wants it tried again
  look_.map = wish.map;
  look_.bands = wish.bands ? kBands : 0;
  trace_.line(fmt::format("compare {} views {} shown {} beside {}", wish.field.empty() ? "nothing" : wish.field, wish.two_views ? 2 : 1,
                          wish.shown ? std::to_string(*wish.shown) : "current", wish.beside ? std::to_string(*wish.beside) : "current"));
}

void Comparing::show_current() {
  end_glance();
  wish_.shown.reset();
}

void Comparing::set_limits(const SetLimits& limits) {
  if (limits.clear == limits.full) return;
  look_.clear = limits.clear;
  look_.full = limits.full;
}

Result<void> Comparing::follow() {
  if (failed_) return fail(*std::exchange(failed_, std::nullopt));
  if (connection_ != link_.connection.number()) {
    // Another server knows nothing of what was asked.
    connection_ = link_.connection.number();
    for (View* view : {&main_, &other_}) view->asked_view.reset(), view->asked.reset();
    states_of_.reset();
  }
  if (const std::uint64_t document = link_.document.snapshot() ? link_.document.number() : 0; document != document_) {
    document_ = document;
    show_current();
    wish_.beside.reset();
    wish_.against_generation.reset();
    wish_.two_views = false;
    for (const Pane pane : {Pane::model, Pane::other}) {
      of(pane).view.reset();
      forget_field(pane);
    }
    states_of_.reset();
  }
  if (!link_.document.snapshot()) return {};
  follow_states();
  follow_view(Pane::model, shown());
  follow_view(Pane::other, wish_.two_views ? wish_.beside : std::nullopt);
  const auto beside = !wish_.two_views ? nullptr : other_.view ? other_.view : link_.document.snapshot();
  const bool other_hidden = follow_hidden();
  if (beside != beside_ || (beside && other_hidden)) {
    beside_ = beside;
    if (Result<void> set = renderer_.set_other(beside ? render::snapshot_source(beside, hidden_) : nullptr); !set) return set;
  }
  follow_field(Pane::model, shown());
  if (wish_.two_views)
    follow_field(Pane::other, wish_.beside);
  else
    forget_field(Pane::other);
  return {};
}

bool Comparing::follow_hidden() {
  std::vector<std::uint8_t> hidden;
  for (const ipc::SnapshotPart& part : link_.document.snapshot()->info().parts) hidden.push_back(part.hidden ? 1 : 0);
  return std::exchange(hidden_, hidden) != hidden_;
}

void Comparing::follow_states() {
  const std::uint64_t current = link_.document.snapshot()->info().generation;
  if (states_of_ == current || (!panel_open_ && !wish_.two_views)) return;
  states_of_ = current;
  link_.connection.question(ipc::GetState{}, [this](const ipc::Answer& answer) {
    const auto* state = std::get_if<ipc::DocumentState>(&answer);
    if (state == nullptr) return;
    states_ = state->generations;
    const auto known = [&](std::uint64_t number) {
      return std::any_of(states_.begin(), states_.end(), [&](const ipc::ListedGeneration& each) { return each.number == number; });
    };
    // What was opened may have left the history meanwhile: then the oldest that is left stands beside.
    if (wish_.beside && !other_.view && !states_.empty() && !known(*wish_.beside)) wish_.beside = states_.front().number;
  });
}

void Comparing::follow_view(Pane pane, const std::optional<std::uint64_t>& generation) {
  View& view = of(pane);
  const bool current = !generation || *generation == link_.document.snapshot()->info().generation;
  if (current) {
    view.view.reset();
    view.asked_view.reset();
    view.view_problem.clear();
    return;
  }
  if (view.asked_view == generation) return;
  view.asked_view = generation;
  view.view_problem.clear();
  ipc::GetSnapshot request;
  request.generation = generation;
  request.have_segments = link_.connection.segments();
  link_.connection.question(request, [this, pane, generation](const ipc::Answer& answer) {
    View& asked = of(pane);
    if (const auto* failed = std::get_if<ipc::Failed>(&answer)) {
      asked.view_problem = failed->message;
      return;
    }
    const auto* snapshot = std::get_if<ipc::Snapshot>(&answer);
    if (snapshot == nullptr) return;
    Result<std::shared_ptr<const ipc::SnapshotView>> taken = link_.connection.take(*snapshot);
    if (!taken) {
      asked.view_problem = taken.error().text();
      return;
    }
    if (asked.asked_view != generation) return;  // another is wanted by now
    asked.view = std::move(*taken);
    trace_.line(fmt::format("view {} generation {}", pane == Pane::model ? "main" : "beside", *generation));
  });
}

void Comparing::forget_field(Pane pane) {
  View& view = of(pane);
  if (!view.asked && !view.made) return;
  view.asked.reset();
  view.made.reset();
  view.values.reset();
  view.field_problem.clear();
  if (!main_.made && !other_.made) look_of_.clear();
  if (Result<void> cleared = renderer_.set_field(pane, {}, true); !cleared) failed_ = cleared.error();
}

bool Comparing::field_wanted() const {
  if (wish_.field.empty()) return false;
  if (wish_.field == "distance") return !wish_.from.empty() && !wish_.to.empty();
  return !needs_against(wish_) || wish_.against_generation || !wish_.against.empty();
}

void Comparing::follow_field(Pane pane, const std::optional<std::uint64_t>& generation) {
  if (!field_wanted()) return forget_field(pane);
  ipc::GetField request;
  request.field = wish_.field;
  request.generation = generation.value_or(link_.document.snapshot()->info().generation);
  std::error_code ignored;
  request.against = is_state(wish_.against) ? wish_.against : std::filesystem::absolute(wish_.against, ignored).string();
  request.against_generation = wish_.against_generation;
  request.from = wish_.from;
  request.to = wish_.to;
  View& view = of(pane);
  if (view.asked && same(*view.asked, request)) return;
  view.asked = request;
  link_.connection.question(request, [this, pane, request](const ipc::Answer& answer) { took_field(pane, request, answer); });
}

void Comparing::took_field(Pane pane, const ipc::GetField& asked, const ipc::Answer& answer) {
  View& view = of(pane);
  if (!view.asked || !same(*view.asked, asked)) return;  // something else is wanted by now
  view.field_problem.clear();
  const auto* made = std::get_if<ipc::FieldMade>(&answer);
  if (made == nullptr) {
    if (const auto* failed = std::get_if<ipc::Failed>(&answer))
      view.field_problem = link::was_stopped(*failed) ? "stopped; choose it again to see it" : ipc::error_from(*failed).text();
    view.made.reset();
    view.values.reset();
    if (Result<void> cleared = renderer_.set_field(pane, {}, true); !cleared) failed_ = cleared.error();
    return;
  }
  const Result<std::shared_ptr<const ipc::FieldValues>> values = link_.connection.take(*made);
  if (!values) {
    view.field_problem = values.error().text();
    return;
  }
  if (Result<void> set = renderer_.set_field(pane, (*values)->values(), made->on_nodes); !set) {
    failed_ = set.error();
    return;
  }
  // Limits that were set stay with the kind of values that they were set for.
  if (std::string kind = made->title + ", " + made->unit; look_of_ != kind) {
    look_ = {true, made->clear, made->full, wish_.map, wish_.bands ? kBands : 0};
    look_of_ = std::move(kind);
  }
  view.made = *made;
  view.values = *values;
  trace_.line(fmt::format("field {} generation {} measured {} max {} at {}", asked.field, made->generation, made->measured, made->max,
                          made->max_at));
}

void Comparing::dress(render::Picture& picture, const render::TwoViews& both) const {
  if (two_views()) picture.two_views = both;
  if (!coloured()) return;
  picture.colour = render::ColourMode::field;
  picture.quality_glyphs = false;  // yellow and red would be read as values
  picture.field.fill(look_);
  picture.field[0].on = main_.made.has_value();
  picture.field[1].on = other_.made.has_value();
}

std::optional<double> Comparing::value_of(std::size_t index) const {
  if (!main_.values || index >= main_.values->values().size()) return std::nullopt;
  const double value = main_.values->values()[index];
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::string Comparing::words_of(const std::optional<std::uint64_t>& generation) const {
  if (!generation || !link_.document.snapshot() || *generation == link_.document.snapshot()->info().generation) return "now";
  for (const ipc::ListedGeneration& state : states_)
    if (state.number == *generation) return words_of_state(state);
  return fmt::format("state {}", *generation);
}

/// Which state is seen where, wherever that isn't the current one alone.
std::vector<CompareFacts::Caption> Comparing::captions(const render::TwoViews& both) const {
  if (two_views()) return {{words_of(wish_.beside), both.border - both.shift}, {words_of(shown()), both.border + both.shift}};
  if (shows_older() && !glance_) return {{words_of(wish_.shown) + "   only shown: Shift+C chooses another state", both.border}};
  return {};
}

CompareFacts Comparing::facts(const render::TwoViews& both) const {
  CompareFacts facts;
  facts.wish = wish_;
  for (const View* view : {&other_, &main_})
    for (const std::string& problem : {view->field_problem, view->view_problem})
      if (!problem.empty()) facts.problem = problem;
  for (const ipc::ListedGeneration& state : states_) facts.states.push_back({state.number, words_of_state(state)});
  facts.captions = captions(both);
  if (link_.document.snapshot()) facts.current = link_.document.snapshot()->info().generation;
  for (const Pane pane : {Pane::model, Pane::other}) {
    const View& view = of(pane);
    if (!view.made || (pane == Pane::other && !two_views())) continue;
    LegendFacts legend;
    legend.title = view.made->title;
    legend.unit = view.made->unit;
    legend.of = view.made->against.empty() ? view.made->of : view.made->of + " against " + view.made->against;
    legend.look = look_;
    legend.min = view.made->min;
    legend.max = view.made->max;
    legend.min_at = view.made->min_at;
    legend.max_at = view.made->max_at;
    legend.new_nodes = view.made->new_nodes;
    legend.shells_without = view.made->shells_without;
    legend.pane = static_cast<std::size_t>(pane);
    legend.centre = both.border;
    legend.widest = (two_views() ? 2 : 4) * both.shift;
    if (two_views()) legend.centre += pane == Pane::model ? both.shift : -both.shift;
    facts.legends.push_back(std::move(legend));
  }
  return facts;
}

}  // namespace prismesh::kiosk::tools::comparison
