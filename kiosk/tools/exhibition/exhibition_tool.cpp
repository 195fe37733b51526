#include "kiosk/tools/exhibition/exhibition_tool.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "kiosk/toolkit/edits.h"
#include "kiosk/toolkit/model_boxes.h"
#include "kiosk/toolkit/open_panels.h"
#include "kiosk/toolkit/picking.h"
#include "kiosk/toolkit/tool_set.h"
#include "kiosk/tools/exhibition/allowed_requests.h"

namespace prismesh::kiosk::tools::exhibition {
namespace {

constexpr std::string_view kName = "exhibition";
constexpr std::int64_t kShowFrameNs = 33'000'000;  ///< between two pictures of the show
constexpr std::int64_t kTouchNs = 400'000'000;
constexpr std::int64_t kRestoreAgainNs = 5'000'000'000;
constexpr double kFitShare = 0.75;  ///< of the view that a fitted model has in the show ...
constexpr double kFitAbove = 0.1;   ///< ... and how far above the middle, for the card below it
constexpr std::array kStageNames{"show", "visit", "warning", "over", "unlocked"};

std::int64_t nanoseconds_of(double seconds) { return std::llround(seconds * 1e9); }

std::int64_t seconds_since_1970() {
  return std::chrono::duration_cast<std::chrono::seconds>(std::chrono::system_clock::now().time_since_epoch()).count();
}

ShowTimes times_of(const toolkit::ToolOptions& options) {
  ShowTimes times;
  if (!options.exhibition) return times;
  times.idle_ns = options.exhibition->idle_ns;
  times.warning_ns = options.exhibition->warning_ns;
  return times;
}

}  // namespace

std::optional<bool> face_seen(const std::optional<toolkit::EyesFacts>& eyes) {
  using Condition = toolkit::EyesFacts::Condition;
  if (!eyes || eyes->condition == Condition::trouble) return std::nullopt;
  return eyes->condition == Condition::good;
}

ExhibitionTool::ExhibitionTool(toolkit::ToolContext& context)
    : context_(context),
      clock_(times_of(context.options)),
      gate_(on() ? context.options.exhibition->pin : std::string(), on() ? context.options.exhibition->tries : std::filesystem::path()) {
  if (!on()) return;
  show_ = parse_show(context.options.exhibition->show_text, context.options.exhibition->show_file).value_or(std::vector<ShowStep>());
  restoring_ = true;
  const std::filesystem::path deck = context.options.exhibition->deck;
  context_.link.connection.set_guard([this, deck](const ipc::Request& request) { return !locked() || is_allowed(request, deck); });
}

std::string_view ExhibitionTool::name() const { return kName; }

// --- stages ---

void ExhibitionTool::watch(std::int64_t now_ns) {
  if (!on()) return;
  // A tracker that was away says nothing of who has come meanwhile.
  if (const std::optional<bool> face = face_seen(context_.view.eyes)) clock_.face(*face, now_ns);
  // A model server that has started anew brings back what the visit did.
  const std::uint64_t before = std::exchange(connection_, context_.link.connection.number());
  if (locked() && before > 0 && before != connection_) clock_.end();
  const int left = clock_.stage() == Stage::warning ? clock_.seconds_left(now_ns) : 0;
  clock_.turn(now_ns);
  if (clock_.stage() == Stage::warning && clock_.seconds_left(now_ns) != left) ++context_.changes;
  follow_stage();
  drop_notices();
  if (restoring_ && asked_ && shows_deck()) restored();
  if (restoring_ && now_ns >= restore_ns_ && context_.link.document.state() && !context_.link.connection.progress().can_stop())
    restore_deck();
  if (clock_.stage() == Stage::show) play(now_ns);
}

/// What a deck is warned of is no matter of visitors; during the show nobody is there to read anything.
void ExhibitionTool::drop_notices() {
  const bool show = clock_.stage() == Stage::show;
  while (locked() && !context_.notices.empty() && (show || context_.notices.front().kind == notices::Notice::Kind::warning))
    context_.notices.read();
}

void ExhibitionTool::follow_stage() {
  const Stage stage = clock_.stage();
  if (stage == Stage::over) context_.quits = context_.anew = true;
  if (traced_ == stage) return;
  const Stage before = std::exchange(traced_, stage);
  ++context_.changes;
  context_.trace.line(fmt::format("exhibition {}", kStageNames[static_cast<std::size_t>(stage)]));
  if (stage == Stage::visit && before == Stage::show) begin_visit();
}

void ExhibitionTool::restore_deck() {
  restoring_ = true;
  if (!context_.link.document.state()) return;  // watch() does it, once it is known what the server has open
  restore_ns_ = context_.clock.now_ns() + kRestoreAgainNs;
  if (context_.link.connection.progress().can_stop()) context_.link.connection.stop();
  asked_ = false;
  // The server answers for a deck that is open already with its present state: it is closed first.
  const auto open = [this] {
    asked_ = true;
    context_.link.deck.open(context_.options.exhibition->deck, link::Unsaved::discard);
  };
  if (!context_.link.document.state()->open) return open();
  context_.link.deck.close([open](const ipc::Answer&) { open(); });
}

void ExhibitionTool::begin_visit() {
  card_ = {};
  step_.reset();
  tour_due_ = true;
  restore_deck();
}

/// Whether the deck is shown as it lies on the disk, and not as another program, or a visit before a crash, has left it.
bool ExhibitionTool::shows_deck() const {
  const auto& shown = context_.shown.snapshot;
  if (!shown || shown != context_.link.document.snapshot() || !context_.link.document.up_to_date()) return false;
  const ipc::SnapshotInfo& info = shown->info();
  return info.document == context_.options.exhibition->deck.string() && !info.can_undo && !info.changed;
}

void ExhibitionTool::restored() {
  restoring_ = false;
  context_.trace.line("exhibition deck");
  if (std::exchange(tour_due_, false)) context_.tools.command({"tour", 0}, std::nullopt);
}

// --- input ---

bool ExhibitionTool::takes_input(bool fresh) {
  if (!on()) return false;
  const std::int64_t now_ns = context_.clock.now_ns();
  // A touch is a move and a press, a key comes with its text: all that belongs to what ended the show goes no further either.
  const bool belongs = now_ns < taken_until_ns_;
  if (!fresh) return belongs || (clock_.stage() != Stage::visit && clock_.stage() != Stage::unlocked);  // something may lie on a key
  const bool taken = clock_.touched(now_ns);
  if (taken) taken_until_ns_ = now_ns + kTouchNs;
  follow_stage();
  return taken || belongs;
}

bool ExhibitionTool::allow_command(const input::Command& command) {
  if (!locked()) return true;
  if (clock_.stage() != Stage::visit) return false;
  if (command.owner == "files") {
    if (command == context_.options.exhibition->leave)
      ask_pin();
    else
      context_.notices.say(notices::Notice::Kind::information, "Files are closed in the exhibition: nothing is opened or saved.");
    return false;
  }
  if (command == context_.options.exhibition->set_up) {
    ask_pin();
    return false;
  }
  return command != context_.options.exhibition->fullscreen;
}

std::int64_t ExhibitionTool::next_ns(std::int64_t now_ns) const {
  if (!on()) return -1;
  return clock_.stage() == Stage::show ? now_ns + kShowFrameNs : clock_.next_ns(now_ns);
}

// --- the show ---

void ExhibitionTool::play(std::int64_t now_ns) {
  if (!context_.shown.snapshot || restoring_ || show_.empty()) return;
  if (!step_) {
    step_ = 0;
    begin_step(now_ns);
  }
  const ShowStep& step = show_[*step_];
  const std::int64_t length = nanoseconds_of(step.seconds);
  const double share = length > 0 ? std::clamp(static_cast<double>(now_ns - step_ns_) / static_cast<double>(length), 0.0, 1.0) : 1;
  if (const double by = share - std::exchange(played_, share); by > 0 && (step.turn_right != 0 || step.turn_up != 0 || step.zoom != 1)) {
    constexpr double kRadians = std::numbers::pi / 180;
    stereo::View& view = context_.view.view;
    view = stereo::orbit(view, by * step.turn_right * kRadians, by * step.turn_up * kRadians);
    view.mm_per_unit *= std::pow(step.zoom, by);
    context_.tools.view_moved();
    ++context_.changes;
  }
  const bool works = context_.link.edits.under_way() || !context_.link.document.up_to_date();
  if (share < 1 || works) return;
  if (*step_ + 1 < show_.size()) {
    ++*step_;
    return begin_step(now_ns);
  }
  step_.reset();
  restore_deck();
}

void ExhibitionTool::begin_step(std::int64_t now_ns) {
  const ShowStep& step = show_[*step_];
  step_ns_ = now_ns;
  played_ = 0;
  if (!step.title.empty() || !step.words.empty()) card_ = {step.title, step.words};
  context_.trace.line(fmt::format("show {} of {} {}", *step_ + 1, show_.size(), card_.title));
  ++context_.changes;
  if (step.fit != ShowStep::Fit::none) {
    toolkit::PictureView& view = context_.view;
    const stereo::Box selection = step.fit == ShowStep::Fit::selection ? toolkit::turned_box_of_selection(context_) : stereo::Box();
    const Eigen::Vector2d room = toolkit::room_of_view_mm(view) * kFitShare;
    const double eyes = view.seen.between_eyes_mm.z();
    view.view = selection.empty() ? context_.renderer.fitted(view.view, room, eyes) : stereo::fit_turned(view.view, selection, room, eyes);
    view.view.pan_mm.y() += kFitAbove * toolkit::room_of_view_mm(view).y();
    context_.tools.view_moved();
  }
  if (step.edit) toolkit::send(context_, *step.edit);
}

// --- the way out ---

void ExhibitionTool::ask_pin() {
  pin_ = {};
  toolkit::open_dialog(context_, this);
}

void ExhibitionTool::enter_pin(const std::string& pin) {
  const std::int64_t now_s = seconds_since_1970();
  if (gate_.try_pin(pin, now_s)) {
    context_.trace.line("exhibition PIN right");
    toolkit::close_dialog(context_);
    clock_.unlock(context_.clock.now_ns());
    follow_stage();
    return;
  }
  context_.trace.line("exhibition PIN refused");
  pin_.typed.clear();
  pin_.wrong = true;
}

void ExhibitionTool::draw_over_picture(panels::PanelLayout& layout) {
  if (!on()) return;
  switch (clock_.stage()) {
    case Stage::show: show_card(card_, layout); break;
    case Stage::visit:
      if (staff_button(layout)) layout.ask([this] { ask_pin(); });
      break;
    case Stage::warning: warning_card(clock_.seconds_left(context_.clock.now_ns()), layout); break;
    case Stage::unlocked: {
      const UnlockedAsked asked = unlocked_card(layout);
      if (asked == UnlockedAsked::lock) layout.ask([this] { clock_.end(); });
      if (asked == UnlockedAsked::leave) layout.ask([this] { context_.quits = true; });
      break;
    }
    case Stage::over: break;
  }
}

void ExhibitionTool::draw_dialog(int, bool opened, panels::PanelLayout& layout) {
  const PinFacts facts{gate_.has_pin(), gate_.wait_s(seconds_since_1970())};
  switch (pin_pad(facts, opened, layout, pin_)) {
    case PinAsked::nothing: break;
    case PinAsked::cancel: layout.ask([this] { toolkit::close_dialog(context_); }); break;
    case PinAsked::enter: layout.ask([this] { enter_pin(std::string(pin_.typed)); }); break;
  }
}

}  // namespace prismesh::kiosk::tools::exhibition
