#include "kiosk/calibrator.h"

#include <poll.h>

#include <array>
#include <utility>

#include <fmt/format.h>

#include "drivers/settings/choose_profile.h"
#include "drivers/settings/settings.h"

namespace prismesh::kiosk {
namespace {

using panels::WizardAction;

/// How long the wizard waits for the device daemon before it goes on without the motor.
constexpr std::int64_t kDevicesPatienceNs = 3'000'000'000;
/// Between two drawings of a page, as mask and head move.
constexpr int kBeatMs = 30;

/// A file's name for a display: letters, digits and dashes.
std::string file_name(const std::string& text) {
  std::string name;
  for (const char c : text) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (plain) name += c;
    if (!plain && !name.empty() && name.back() != '-') name += '-';
  }
  while (name.ends_with('-')) name.pop_back();
  return name.empty() ? "display" : name;
}

}  // namespace

Result<SaveTo> usual_place(const std::optional<std::filesystem::path>& settings) {
  const std::vector<std::filesystem::path> usual = drivers::settings::usual_files();
  if (usual.size() < 2) {  // the system's only
    if (!settings) return fail("", "there is no place to save a calibration: set HOME or XDG_CONFIG_HOME, or give --config FILE");
    // Absolute: what settings name otherwise lies beside them, not in the working folder.
    return SaveTo{std::filesystem::absolute(settings->parent_path() / "displays"), *settings};
  }
  return SaveTo{usual.back().parent_path() / "displays", settings.value_or(usual.back())};
}

Result<std::unique_ptr<Calibrator>> Calibrator::create(display::Window& window, Station& station, const drivers::display::Profile& start,
                                                       SaveTo save_to) {
  auto calibrator = std::unique_ptr<Calibrator>(new Calibrator(window, station, start, std::move(save_to)));
  Result<std::unique_ptr<render::Renderer>> renderer = render::Renderer::create({.samples = 1});
  if (!renderer) return fail(renderer.error());
  calibrator->renderer_ = std::move(*renderer);
  Result<calibration::PatternPainter> painter = calibration::PatternPainter::create();
  if (!painter) return fail(painter.error());
  calibrator->painter_ = std::move(*painter);
  Result<panels::Gui> gui = panels::Gui::create();
  if (!gui) return fail(gui.error());
  if (Result<void> type = gui->set_type(panels::kStereoType); !type) return fail(type.error());
  calibrator->gui_ = std::move(*gui);
  return calibrator;
}

bool is_by_hand(const display::WindowEvent& event) {
  return std::holds_alternative<display::KeyChanged>(event) || std::holds_alternative<display::ButtonChanged>(event) ||
         std::holds_alternative<display::PointerMoved>(event) || std::holds_alternative<display::TextTyped>(event);
}

Result<std::optional<std::filesystem::path>> Calibrator::run(std::int64_t idle_ns) {
  began_ns_ = laid_out_ns_ = input_ns_ = station_.clock.now_ns();
  while (!left_ && !saved_) {
    if (Result<void> taken = take_events(); !taken) return fail(taken.error());
    if (Result<void> turned = station_.turn(); !turned) return fail(turned.error());
    station_.look();
    if (!wizard_) begin_when_ready();
    if (std::string refused = station_.devices.take_refusal(); !refused.empty()) trouble_ = std::move(refused);
    watch_.turn(station_.clock.now_ns(), true);
    if (Result<void> drawn = draw(); !drawn) return fail(drawn.error());
    window_.present();
    watch_.shown();
    if (idle_ns >= 0 && station_.clock.now_ns() - input_ns_ > idle_ns) left_ = true;
    wait();
  }
  station_.devices.release_mask();
  if (saved_) station_.devices.reload();
  return saved_;
}

void Calibrator::begin_when_ready() {
  const std::optional<ipc::PrismState> prism = station_.devices.read().prism;
  using drivers::prism_servo::MaskPhase;
  const bool answers = prism && prism->phase != MaskPhase::absent && prism->phase != MaskPhase::stuck && prism->phase != MaskPhase::alarm;
  const bool ready = !start_.mask_moves || (answers && prism->phase != MaskPhase::homing);
  if (!ready && station_.clock.now_ns() - began_ns_ < kDevicesPatienceNs) return;
  calibration::Setup setup;
  setup.monitor = window_.monitor();
  setup.panel = setup.monitor ? setup.monitor->shown : window_.size();
  setup.mask_answers = start_.mask_moves && answers;
  wizard_.emplace(start_, setup);
}

calibration::Now Calibrator::now() const {
  const stereo::DeviceReading reading = station_.devices.read();
  calibration::Now now;
  now.eyes_seen = reading.eyes && reading.eyes->phase == ipc::EyesPhase::tracking;
  now.between_eyes_mm = now.eyes_seen ? reading.eyes->head().between_eyes_mm : kRestingEyesMm;
  if (reading.prism && reading.prism->measured_ns > 0) now.mask_mm = reading.prism->position_mm;
  return now;
}

Result<void> Calibrator::take_events() {
  const Result<std::vector<display::WindowEvent>> events = window_.take_events();
  if (!events) return fail(events.error());
  for (const display::WindowEvent& event : *events) {
    gui_->feed(event);
    if (is_by_hand(event)) input_ns_ = station_.clock.now_ns();
    if (const auto* moved = std::get_if<display::PointerMoved>(&event)) pointer_ = input::Pixel(moved->x, moved->y);
    if (std::holds_alternative<display::PointerLeft>(event)) pointer_.reset();
    if (std::holds_alternative<display::CloseRequested>(event)) left_ = true;
    if (const auto* key = std::get_if<display::KeyChanged>(&event)) take_key(*key);
    // A press and its release must not fall into one layout.
    if (std::holds_alternative<display::ButtonChanged>(event) && wizard_) lay_out(wizard_->page(now()));
    if (std::holds_alternative<display::Resized>(event) || std::holds_alternative<display::Moved>(event))
      station_.place(window_.monitor(), window_.position());
  }
  return {};
}

void Calibrator::take_key(const display::KeyChanged& key) {
  if (!key.down) return;
  using display::Key;
  const bool coarse = key.modifiers.shift;
  switch (key.key) {
    case Key::left:
    case Key::down: return act(coarse ? WizardAction::much_less : WizardAction::less);
    case Key::right:
    case Key::up: return act(coarse ? WizardAction::much_more : WizardAction::more);
    case Key::page_down: return act(WizardAction::much_less);
    case Key::page_up: return act(WizardAction::much_more);
    default: break;
  }
  if (key.repeat) return;
  if (key.key == Key::enter) act(WizardAction::next);
  if (key.key == Key::backspace) act(WizardAction::back);
  if (key.key == Key::escape) act(WizardAction::leave);
}

void Calibrator::act(panels::WizardAction action) {
  if (action == WizardAction::leave) left_ = true;
  if (!wizard_) return;
  trouble_.clear();
  switch (action) {
    case WizardAction::less: return wizard_->adjust(-1, false);
    case WizardAction::more: return wizard_->adjust(1, false);
    case WizardAction::much_less: return wizard_->adjust(-1, true);
    case WizardAction::much_more: return wizard_->adjust(1, true);
    case WizardAction::back: return wizard_->back();
    case WizardAction::next:
      if (Result<void> taken = wizard_->next(now()); !taken) trouble_ = taken.error().message;
      if (wizard_->finished()) save();
      return;
    case WizardAction::leave: return;
  }
}

panels::WizardFacts Calibrator::facts(const calibration::Page& page) const {
  panels::WizardFacts facts;
  facts.number = page.number;
  facts.count = page.count;
  facts.title = page.title;
  facts.task = page.task;
  facts.value = page.value;
  facts.remarks = page.remarks;
  facts.trouble = trouble_;
  facts.next = page.next;
  facts.first = page.number == 1;
  return facts;
}

void Calibrator::lay_out(const calibration::Page& page) {
  const std::int64_t now_ns = station_.clock.now_ns();
  std::vector<WizardAction> actions;
  gui_->layout(window_.size(), static_cast<double>(now_ns - std::exchange(laid_out_ns_, now_ns)) * 1e-9, [&] {
    if (wizard_) actions = panels::wizard_panel(facts(page), window_.size());
    if (pointer_) panels::draw_pointer(pointer_->x(), pointer_->y());
  });
  for (const WizardAction action : actions) act(action);
}

Result<void> Calibrator::draw() {
  calibration::Page page;
  page.profile = start_;
  page.pattern.ground = {0.2F, 0.2F, 0.2F};
  if (wizard_) page = wizard_->page(now());
  if (page.hold_mask_mm)
    station_.devices.hold_mask(*page.hold_mask_mm);
  else
    station_.devices.release_mask();
  // Panels that fit their content have their size after the second time.
  for (int round = 0; round < 2; ++round) lay_out(page);
  window_.show_pointer(false);
  render::Picture picture;
  picture.profile = page.profile;
  const stereo::SeenFrom& seen = station_.eyes.seen();
  picture.between_eyes_mm = seen.between_eyes_mm;
  picture.toward_right = seen.toward_right;
  picture.eye_separation_mm = page.profile.eye_separation_mm.value_or(seen.eye_separation_mm);
  picture.mask_mm = page.weave_mask_mm;
  picture.panel = station_.editor.context().view.panel;
  picture.overlay = [&](const render::EyeImage& image) {
    painter_->paint(page.pattern, image);
    gui_->draw({image.width, image.height}, image.from_picture);
  };
  const display::PixelSize size = window_.size();
  const Result<render::DrawReport> report = renderer_->draw(picture, 0, size.width, size.height);
  if (!report) return fail(report.error());
  const std::string now_shown = fmt::format("calibration {} {} {}", page.number, page.title, page.value);
  if (wizard_ && std::exchange(traced_, now_shown) != now_shown) station_.trace.line(now_shown);
  return {};
}

void Calibrator::save() {
  drivers::display::Profile profile = wizard_->result();
  const std::string monitor = (profile.monitor.name + " " + profile.monitor.serial);
  profile.name = file_name(profile.monitor.name.empty() ? profile.name + "-calibrated" : monitor);
  const std::filesystem::path file = save_to_.folder / (profile.name + ".toml");
  Result<void> done = drivers::display::write_profile(file, profile);
  if (done) done = drivers::settings::choose_profile(save_to_.settings, file);
  if (!done) {
    trouble_ = done.error().text();
    station_.trace.line("calibration not saved " + trouble_);
    return wizard_->back();
  }
  saved_ = file;
  station_.trace.line("calibration saved " + file.string());
}

void Calibrator::wait() const {
  std::array<pollfd, 1> watched{{{window_.descriptor(), POLLIN, 0}}};
  ::poll(watched.data(), watched.size(), kBeatMs);
}

}  // namespace prismesh::kiosk
