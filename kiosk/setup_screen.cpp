#include "kiosk/setup_screen.h"

#include <poll.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <utility>

#include <fmt/format.h>

#include "drivers/settings/choose_profile.h"
#include "drivers/settings/settings.h"
#include "ipc/setup/client.h"
#include "ipc/setup/own_addresses.h"
#include "kiosk/calibrator.h"
#include "kiosk/tools/files/shelf.h"

namespace prismesh::kiosk {
namespace {

using setup::Page;
using setup::SetupAction;

/// Between two drawings of a page, while something changes and while nothing does.
constexpr int kSetupBeatMs = 40, kSetupRestMs = 500;

/// Between two tries to get a pairing code.
constexpr std::int64_t kCodeNs = 1'000'000'000;

}  // namespace

SetupScreen::SetupScreen(display::Window& window, Station& station, SetupOptions options)
    : window_(window), station_(station), options_(std::move(options)), guide_(options_.station, {}), profile_(station.editor.profile()) {
  guide_ = setup::Guide(options_.station, facts());
}

SetupScreen::~SetupScreen() = default;  // a future of std::async waits

Result<std::unique_ptr<SetupScreen>> SetupScreen::create(display::Window& window, Station& station, SetupOptions options) {
  auto screen = std::unique_ptr<SetupScreen>(new SetupScreen(window, station, std::move(options)));
  Result<std::unique_ptr<render::Renderer>> renderer = render::Renderer::create({.samples = 1});
  if (!renderer) return fail(renderer.error());
  screen->renderer_ = std::move(*renderer);
  Result<panels::Gui> gui = panels::Gui::create();
  if (!gui) return fail(gui.error());
  screen->gui_ = std::move(*gui);
  return screen;
}

setup::Facts SetupScreen::facts() const {
  setup::Facts facts;
  facts.profile = options_.profile;
  facts.stereo = profile_.stereo();
  facts.mask_moves = profile_.mask_moves;
  using drivers::prism_servo::MaskPhase;
  const std::optional<ipc::PrismState> prism = station_.devices.read().prism;
  facts.mask_answers = prism && prism->phase != MaskPhase::absent && prism->phase != MaskPhase::stuck && prism->phase != MaskPhase::alarm;
  return facts;
}

Result<SetupScreen::End> SetupScreen::run() {
  input_ns_ = laid_out_ns_ = station_.clock.now_ns();
  while (!end_ || pending_.valid()) {  // what is asked for is answered before the window goes
    if (Result<void> taken = take_events(); !taken) return fail(taken.error());
    station_.devices.turn();  // not the document's: a large one would cost, and nothing of it is shown
    station_.look();
    take_answer();
    guide_.set_facts(facts());
    guide_.set_addresses(ipc::own_addresses());
    ask();
    if (guide_.finished() && !pending_.valid()) end_ = End::finished;
    const std::int64_t now_ns = station_.clock.now_ns();
    if (options_.idle_ns >= 0 && now_ns - input_ns_ > options_.idle_ns) end_ = End::left;
    watch_.turn(now_ns, true);
    if (Result<void> drawn = draw(); !drawn) return fail(drawn.error());
    window_.present();
    watch_.shown();
    for (const SetupAction& action : std::exchange(actions_, {}))
      if (Result<void> done = act(action); !done) return fail(done.error());
    wait();
  }
  return *end_;
}

Result<void> SetupScreen::take_events() {
  const Result<std::vector<display::WindowEvent>> events = window_.take_events();
  if (!events) return fail(events.error());
  for (const display::WindowEvent& event : *events) {
    gui_->feed(event);
    if (is_by_hand(event)) input_ns_ = station_.clock.now_ns();
    if (const auto* moved = std::get_if<display::PointerMoved>(&event)) pointer_ = input::Pixel(moved->x, moved->y);
    if (std::holds_alternative<display::PointerLeft>(event)) pointer_.reset();
    if (std::holds_alternative<display::CloseRequested>(event)) end_ = End::closed;
    if (const auto* key = std::get_if<display::KeyChanged>(&event)) take_key(*key);
    if (const auto* text = std::get_if<display::TextTyped>(&event)) guide_.type(text->text);
    // A press and its release must not fall into one layout.
    if (std::holds_alternative<display::ButtonChanged>(event)) {
      lay_out();
      for (const SetupAction& action : std::exchange(actions_, {}))
        if (Result<void> done = act(action); !done) return done;
    }
    if (std::holds_alternative<display::Resized>(event) || std::holds_alternative<display::Moved>(event))
      station_.place(window_.monitor(), window_.position());
  }
  return {};
}

void SetupScreen::take_key(const display::KeyChanged& key) {
  if (!key.down || key.modifiers.ctrl || key.modifiers.alt) return;
  using display::Key;
  switch (key.key) {
    case Key::backspace: return guide_.erase();
    case Key::up: return guide_.step(-2);
    case Key::down: return guide_.step(2);
    case Key::left: return guide_.step(-1);
    case Key::right: return guide_.step(1);
    default: break;
  }
  if (key.repeat) return;
  if (key.key == Key::tab) guide_.focus_next();
  if (key.key == Key::enter) next_ = true;
  if (key.key == Key::page_up) guide_.back();
  if (key.key == Key::page_down) guide_.skip();
  if (key.key == Key::escape) end_ = End::left;
}

Result<void> SetupScreen::act(const SetupAction& action) {
  using Kind = SetupAction::Kind;
  switch (action.kind) {
    case Kind::choose: guide_.choose(action.number); break;
    case Kind::focus: guide_.focus(action.number); break;
    case Kind::type: guide_.type(action.text); break;
    case Kind::erase: guide_.erase(); break;
    case Kind::next: next_ = true; break;
    case Kind::skip: guide_.skip(); break;
    case Kind::back: guide_.back(); break;
    case Kind::leave: end_ = End::left; break;
    case Kind::calibrate: return calibrate();
  }
  return {};
}

/// One thing at a time: what the page wants, and the page to be kept.
void SetupScreen::ask() {
  if (pending_.valid() || end_) return;
  if (std::exchange(next_, false)) {
    if (std::optional<ipc::SetupRequest> request = guide_.next()) return send(std::move(*request), true);
  }
  ask_for_code();
  if (guide_.wants_clock() && std::exchange(clock_asked_, true) == false) return send(ipc::GetSetup{}, false);
  if (!guide_.wants_clock()) clock_asked_ = false;
  if (calibrated_) return send(ipc::SetCalibration{*std::exchange(calibrated_, std::nullopt)}, false);
  const std::string page(setup::name_of(guide_.page()));
  if (options_.station.due && page != kept_ && !guide_.finished()) {
    kept_ = page;
    return send(ipc::KeepPage{page}, false);
  }
}

/// The service has just been started, and may need a moment.
void SetupScreen::ask_for_code() {
  constexpr int kTries = 10;
  if (!guide_.wants_code()) {
    code_asked_ns_ = 0;
    code_tries_ = 0;
    return;
  }
  const std::int64_t now_ns = station_.clock.now_ns();
  if (code_tries_ > 0 && now_ns - code_asked_ns_ < kCodeNs) return;
  code_asked_ns_ = now_ns;
  std::vector<std::string> words = tools::files::ask_for_pairing(options_.intake);
  if (++code_tries_ >= kTries || !words.front().starts_with("No pairing code")) guide_.set_code(std::move(words));
}

/// Beside the loop: tools that the request needs may take seconds.
void SetupScreen::send(ipc::SetupRequest request, bool of_page) {
  of_page_ = of_page;
  calibrates_ = std::holds_alternative<ipc::SetCalibration>(request);
  pending_ =
      std::async(std::launch::async, [socket = options_.socket, asked = std::move(request)] { return ipc::ask_setup(socket, asked); });
}

void SetupScreen::take_answer() {
  if (!pending_.valid() || pending_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
  const Result<ipc::SetupAnswer> answer = pending_.get();
  if (calibrates_) {
    if (!answer) guide_.calibrated("The kiosk has the calibration, but not the station's settings: " + answer.error().text());
    return station_.devices.reload();
  }
  if (const auto* now = answer ? std::get_if<ipc::StationSetup>(&*answer) : nullptr) return guide_.set_clock(*now);
  if (!of_page_) return;  // a page that isn't kept costs a few keys after a power cut
  const bool chooses = guide_.page() == Page::profile;
  if (!answer) station_.trace.line("setup refused " + answer.error().text());
  guide_.answered(answer ? Result<void>() : fail(answer.error()));
  if (answer && chooses) profile_changed();
}

/// The new profile counts at once, so that who chose it sees whether it can be read.
void SetupScreen::profile_changed() {
  options_.profile = guide_.profile();
  if (const Result<stereo::Profile> found = stereo::find_profile(options_.profile)) profile_ = *found;
  std::error_code none;
  if (!options_.own_settings.empty() && std::filesystem::exists(options_.own_settings, none))
    if (Result<void> chosen = drivers::settings::choose_profile(options_.own_settings, options_.profile); !chosen)
      station_.trace.line("setup profile " + chosen.error().text());
  station_.devices.reload();
}

Result<void> SetupScreen::calibrate() {
  const std::int64_t began_ns = station_.clock.now_ns();
  gui_.reset();  // the calibration has one of its own, and there is one at a time
  const Result<std::optional<std::filesystem::path>> saved = options_.calibrate(profile_, options_.idle_ns);
  if (!saved) return fail(saved.error());
  Result<panels::Gui> gui = panels::Gui::create();
  if (!gui) return fail(gui.error());
  gui_ = std::move(*gui);
  // Where nothing was touched for long the calibration has ended by itself, and so does this: the next hand may be a visitor's.
  if (options_.idle_ns >= 0 && !*saved && station_.clock.now_ns() - began_ns > options_.idle_ns)
    end_ = End::left;
  else
    input_ns_ = station_.clock.now_ns();
  guide_.calibrated(*saved ? "The calibration is saved." : "Nothing was saved.");
  if (*saved) take_calibration(**saved);
  return {};
}

/// The kiosk's own settings name the calibrated profile now. The device daemon can't read those: the station gets a copy.
void SetupScreen::take_calibration(const std::filesystem::path& file) {
  const Result<stereo::Profile> found = stereo::find_profile(file.string());
  if (!found) return;
  options_.profile = file.string();
  profile_ = *found;
  calibrated_ = drivers::display::profile_text(profile_);
}

void SetupScreen::lay_out() {
  const std::int64_t now_ns = station_.clock.now_ns();
  panels::PanelLayout layout{window_.size()};
  const setup::View view = guide_.view();
  gui_->layout(window_.size(), static_cast<double>(now_ns - std::exchange(laid_out_ns_, now_ns)) * 1e-9, [&] {
    for (SetupAction& action : setup::setup_panel(view, works(), layout)) actions_.push_back(std::move(action));
    if (pointer_ && (profile_.stereo() || !window_.has_pointer())) panels::draw_pointer(pointer_->x(), pointer_->y());
  });
  items_.tell(station_.trace, std::move(layout.items));
}

Result<void> SetupScreen::draw() {
  const display::PixelSize size = window_.size();
  const panels::TypeSizes type = panels::for_fingers(panels::type_for(size, profile_.stereo()), profile_.optics.pixel_pitch_mm);
  if (Result<void> set = gui_->set_type(type); !set) return set;
  // Panels that fit their content have their size after the second time.
  for (int round = 0; round < 2; ++round) lay_out();
  window_.show_pointer(!profile_.stereo());
  render::Picture picture;
  picture.profile = profile_;
  const stereo::SeenFrom& seen = station_.eyes.seen();
  picture.between_eyes_mm = seen.between_eyes_mm;
  picture.toward_right = seen.toward_right;
  picture.eye_separation_mm = profile_.eye_separation_mm.value_or(seen.eye_separation_mm);
  picture.panel = station_.editor.context().view.panel;
  picture.overlay = [&](const render::EyeImage& image) { gui_->draw({image.width, image.height}, image.from_picture); };
  const Result<render::DrawReport> report = renderer_->draw(picture, 0, size.width, size.height);
  if (!report) return fail(report.error());
  const std::string shown = fmt::format("setup {}", setup::name_of(guide_.page()));
  if (std::exchange(traced_, shown) != shown) station_.trace.line(shown);
  return {};
}

void SetupScreen::wait() const {
  std::array<pollfd, 1> watched{{{window_.descriptor(), POLLIN, 0}}};
  const bool changes = pending_.valid() || next_ || station_.eyes.follows();
  ::poll(watched.data(), watched.size(), changes ? kSetupBeatMs : kSetupRestMs);
}

}  // namespace prismesh::kiosk
