#include "kiosk/tools/comparison/before_after.h"

#include <algorithm>
#include <utility>

namespace prismesh::kiosk::tools::comparison {

using notices::Notice;

void BeforeAfter::toggle() {
  if (pair_) {
    showing_before_ = !showing_before_;
    return show();
  }
  wanted_ = true;
  ask();
}

bool BeforeAfter::end() {
  wanted_ = false;
  if (!std::exchange(pair_, std::nullopt)) return false;
  const std::optional<std::uint64_t> shown = comparing_.shown();
  comparing_.end_glance();
  trace_.line("comparing over");
  told_.clear();
  return shown != comparing_.shown();
}

void BeforeAfter::follow() {
  if (pair_ && (!link_.document.snapshot() || link_.document.number() != pair_->document ||
                link_.document.snapshot()->info().generation != pair_->after))
    end();
  if (pair_ && showing_before_ && !comparing_.shown_problem().empty()) {
    notices_.say(Notice::Kind::warning, "The state before " + edit() + " can't be shown: " + comparing_.shown_problem());
    end();
  }
  if (wanted_) ask();
}

/// The states are asked for when no edit is under way, so that the newest one is what the user means by it.
void BeforeAfter::ask() {
  if (asked_on_ == link_.connection.number()) return;
  if (!link_.connection.connected() || !link_.document.snapshot() || !link_.document.up_to_date() || link_.edits.under_way() ||
      link_.drag.running() != nullptr)
    return;
  asked_on_ = link_.connection.number();
  link_.connection.question(ipc::GetState{}, [this](const ipc::Answer& answer) {
    asked_on_.reset();
    if (const auto* state = std::get_if<ipc::DocumentState>(&answer); state != nullptr && wanted_) begin(*state);
  });
}

void BeforeAfter::begin(const ipc::DocumentState& state) {
  if (!link_.document.snapshot() || state.generation != link_.document.snapshot()->info().generation)
    return;  // a newer one is on its way: asked again then
  wanted_ = false;
  const auto newest = std::find_if(state.generations.begin(), state.generations.end(),
                                   [&](const ipc::ListedGeneration& each) { return each.number == state.generation; });
  if (newest == state.generations.begin() || newest == state.generations.end())
    return notices_.say(Notice::Kind::information, "There is no state before this one to compare with.");
  pair_ = Pair{link_.document.number(), newest->made_by, std::prev(newest)->number, newest->number};
  showing_before_ = true;
  show();
}

void BeforeAfter::show() { comparing_.glance(showing_before_ ? pair_->before : pair_->after); }

void BeforeAfter::tell() {
  if (!pair_ || showing_before_ != comparing_.shows_older()) return;
  const std::string now = (showing_before_ ? "comparing before " : "comparing after ") + pair_->edit;
  if (now != told_) trace_.line(told_ = now);
}

std::string BeforeAfter::words() const {
  if (!pair_ || showing_before_ != comparing_.shows_older()) return {};
  return showing_before_ ? "A: before " + edit() + "   C shows B" : "B: after " + edit() + "   C shows A";
}

}  // namespace prismesh::kiosk::tools::comparison
