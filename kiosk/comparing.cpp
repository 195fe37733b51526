#include "kiosk/comparing.h"

#include <utility>

#include <fmt/format.h>

namespace prismesh::kiosk {

namespace {

bool same(const ipc::GetField& a, const ipc::GetField& b) {
  return a.field == b.field && a.generation == b.generation && a.against == b.against && a.against_generation == b.against_generation &&
         a.from == b.from && a.to == b.to;
}

std::string words_of(const ipc::ListedGeneration& state) {
  return state.made_by == "open" ? fmt::format("{}: as opened", state.number) : fmt::format("{}: {}", state.number, state.made_by);
}

}  // namespace

void Comparing::set(const tools::CompareWish& wish) {
  const bool other_map = wish.map != wish_.map || wish.bands != wish_.bands;
  wish_ = wish;
  for (View* view : {&main_, &other_}) {
    if (other_map) view->look.map = wish.map;
    view->look.bands = wish.bands ? 10 : 0;
  }
  trace_.line(fmt::format("compare {} views {} shown {} beside {}", wish.field.empty() ? "nothing" : wish.field, wish.two_views ? 2 : 1,
                          wish.shown ? std::to_string(*wish.shown) : "current", wish.beside ? std::to_string(*wish.beside) : "current"));
}

void Comparing::set_limits(const panels::SetLimits& limits) {
  if (limits.pane > 1 || limits.clear == limits.full) return;
  View& view = of(static_cast<Pane>(limits.pane));
  view.look.clear = limits.clear;
  view.look.full = limits.full;
}

Result<void> Comparing::follow() {
  if (failed_) return fail(*std::exchange(failed_, std::nullopt));
  if (connection_ != link_.connections()) {
    // Another server knows nothing of what was asked.
    connection_ = link_.connections();
    for (View* view : {&main_, &other_}) view->asked_view.reset(), view->asked.reset();
    states_of_.reset();
  }
  if (const std::string document = link_.snapshot() ? link_.snapshot()->info().document : ""; document != document_) {
    document_ = document;
    wish_.shown.reset();
    wish_.beside.reset();
    wish_.two_views = false;
    for (const Pane pane : {Pane::model, Pane::other}) {
      of(pane).view.reset();
      forget_field(pane);
    }
    states_of_.reset();
  }
  if (!link_.snapshot()) return {};
  follow_states();
  follow_view(Pane::model, wish_.shown);
  follow_view(Pane::other, wish_.two_views ? wish_.beside : std::nullopt);
  const auto beside = !wish_.two_views ? nullptr : other_.view ? other_.view : link_.snapshot();
  const bool other_hidden = follow_hidden();
  if (beside != beside_ || (beside && other_hidden)) {
    beside_ = beside;
    if (Result<void> set = renderer_.set_other(beside ? render::snapshot_source(beside, hidden_) : nullptr); !set) return set;
  }
  follow_field(Pane::model, wish_.shown);
  if (wish_.two_views)
    follow_field(Pane::other, wish_.beside);
  else
    forget_field(Pane::other);
  return {};
}

bool Comparing::follow_hidden() {
  std::vector<std::uint8_t> hidden;
  for (const ipc::SnapshotPart& part : link_.snapshot()->info().parts) hidden.push_back(part.hidden ? 1 : 0);
  return std::exchange(hidden_, hidden) != hidden_;
}

void Comparing::follow_states() {
  const std::uint64_t current = link_.snapshot()->info().generation;
  if (states_of_ == current || (!panel_open_ && !wish_.two_views)) return;
  states_of_ = current;
  link_.question(ipc::GetState{}, [this](const ipc::Answer& answer) {
    if (const auto* state = std::get_if<ipc::State>(&answer)) states_ = state->generations;
  });
}

void Comparing::follow_view(Pane pane, const std::optional<std::uint64_t>& generation) {
  View& view = of(pane);
  const bool current = !generation || *generation == link_.snapshot()->info().generation;
  if (current) {
    view.view.reset();
    view.asked_view.reset();
    return;
  }
  if (view.asked_view == generation) return;
  view.asked_view = generation;
  ipc::GetSnapshot request;
  request.generation = generation;
  request.have_segments = link_.segments();
  link_.question(request, [this, pane, generation](const ipc::Answer& answer) {
    View& asked = of(pane);
    if (const auto* failed = std::get_if<ipc::Failed>(&answer)) {
      asked.problem = failed->message;
      return;
    }
    const auto* snapshot = std::get_if<ipc::Snapshot>(&answer);
    if (snapshot == nullptr) return;
    Result<std::shared_ptr<const ipc::SnapshotView>> taken = link_.take(*snapshot);
    if (!taken) {
      asked.problem = taken.error().text();
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
  view.problem.clear();
  if (Result<void> cleared = renderer_.set_field(pane, {}, true); !cleared) failed_ = cleared.error();
}

void Comparing::follow_field(Pane pane, const std::optional<std::uint64_t>& generation) {
  if (wish_.field.empty() || (wish_.field == "distance" && (wish_.from.empty() || wish_.to.empty()))) return forget_field(pane);
  ipc::GetField request;
  request.field = wish_.field;
  request.generation = generation.value_or(link_.snapshot()->info().generation);
  request.against = wish_.against;
  request.against_generation = wish_.against_generation;
  request.from = wish_.from;
  request.to = wish_.to;
  View& view = of(pane);
  if (view.asked && same(*view.asked, request)) return;
  view.asked = request;
  link_.question(request, [this, pane, request](const ipc::Answer& answer) { took_field(pane, request, answer); });
}

void Comparing::took_field(Pane pane, const ipc::GetField& asked, const ipc::Answer& answer) {
  View& view = of(pane);
  if (!view.asked || !same(*view.asked, asked)) return;  // something else is wanted by now
  view.problem.clear();
  const auto* made = std::get_if<ipc::FieldMade>(&answer);
  if (made == nullptr) {
    if (const auto* failed = std::get_if<ipc::Failed>(&answer)) view.problem = Error{failed->file, failed->line, failed->message}.text();
    view.made.reset();
    if (Result<void> cleared = renderer_.set_field(pane, {}, true); !cleared) failed_ = cleared.error();
    return;
  }
  const Result<std::shared_ptr<const ipc::FieldValues>> values = link_.take(*made);
  if (!values) {
    view.problem = values.error().text();
    return;
  }
  if (Result<void> set = renderer_.set_field(pane, (*values)->values(), made->on_nodes); !set) {
    failed_ = set.error();
    return;
  }
  // Limits that were set stay with the kind of values that they were set for.
  const bool other_kind = !view.made || view.made->title != made->title || view.made->unit != made->unit;
  if (other_kind) view.look = {true, made->clear, made->full, wish_.map, wish_.bands ? 10 : 0};
  view.made = *made;
  trace_.line(fmt::format("field {} generation {} measured {} max {} at {}", asked.field, made->generation, made->measured, made->max,
                          made->max_at));
}

void Comparing::dress(render::Picture& picture, double shift) const {
  if (two_views()) picture.two_views = render::TwoViews{true, shift};
  if (!main_.made && !other_.made) return;
  picture.colour = render::ColourMode::field;
  picture.quality_glyphs = false;  // yellow and red would be read as values
  picture.field[0] = main_.look;
  picture.field[1] = other_.look;
  picture.field[0].on = main_.made.has_value();
  picture.field[1].on = other_.made.has_value();
}

panels::CompareFacts Comparing::facts(double shift) const {
  panels::CompareFacts facts;
  facts.wish = wish_;
  facts.panel_open = panel_open_;
  facts.problem = !main_.problem.empty() ? main_.problem : other_.problem;
  for (const ipc::ListedGeneration& state : states_) facts.states.push_back({state.number, words_of(state)});
  if (link_.snapshot()) facts.current = link_.snapshot()->info().generation;
  for (const Pane pane : {Pane::model, Pane::other}) {
    const View& view = of(pane);
    if (!view.made || (pane == Pane::other && !two_views())) continue;
    panels::LegendFacts legend;
    legend.title = view.made->title;
    legend.unit = view.made->unit;
    legend.of = view.made->against.empty() ? view.made->of : view.made->of + " against " + view.made->against;
    legend.look = view.look;
    legend.min = view.made->min;
    legend.max = view.made->max;
    legend.min_at = view.made->min_at;
    legend.max_at = view.made->max_at;
    legend.new_nodes = view.made->new_nodes;
    legend.shells_without = view.made->shells_without;
    legend.pane = static_cast<std::size_t>(pane);
    if (two_views()) {
      legend.centre = 0.5 + (pane == Pane::model ? shift : -shift);
      legend.widest = 2 * shift;
    }
    facts.legends.push_back(std::move(legend));
  }
  return facts;
}

}  // namespace prismesh::kiosk
