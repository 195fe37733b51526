#include "kiosk/display/kms/bare_window.h"

#include <sys/epoll.h>
#include <sys/timerfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>
#include <utility>

#include <EGL/egl.h>
#include <fmt/format.h>

#include "kiosk/display/kms/drm_card.h"
#include "kiosk/display/kms/flipper.h"
#include "kiosk/display/kms/input.h"
#include "kiosk/display/kms/input_devices.h"
#include "kiosk/display/kms/link.h"
#include "kiosk/display/kms/plugs.h"
#include "kiosk/display/kms/scanout.h"
#include "kiosk/display/kms/seat.h"
#include "kiosk/display/monitor.h"

namespace prismesh::kiosk::display::kms {
namespace {

class Descriptor {
 public:
  explicit Descriptor(int value) : value_(value) {}
  ~Descriptor() {
    if (value_ >= 0) ::close(value_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return value_; }

 private:
  int value_;
};

constexpr std::uint64_t kManyLost = 3;  ///< events that never came

KeyboardNames station_keyboard() {
  std::ifstream file("/etc/default/keyboard");
  std::ostringstream text;
  text << file.rdbuf();
  return drivers::settings::read_keyboard_names(text.str());
}

/// The card has lost the link to the monitor, and asks for the mode to be set again.
bool link_failed(const CardState& state, ObjectId connector) {
  for (const Connector& one : state.connectors)
    if (const auto status = one.properties.find("link-status"); one.id == connector && status != one.properties.end())
      return status->second.value != 0;
  return false;
}

class BareWindow final : public Window {
 public:
  BareWindow(BareOptions options, Clock& clock) : options_(std::move(options)), clock_(clock) {}
  ~BareWindow() override;
  Result<void> open();

  PixelSize size() const override { return flipper_->output().mode.size; }
  Result<std::vector<WindowEvent>> take_events() override;
  int descriptor() const override { return watched_.get(); }
  DesktopPosition position() const override { return {}; }
  std::optional<Monitor> monitor() override { return monitor_of(flipper_->output(), facts_); }
  void finish() override { eglWaitClient(); }
  void present() override;
  std::optional<std::int64_t> last_refresh_ns() override { return flipper_->shown_ns(); }
  bool has_pointer() const override { return false; }
  void show_pointer(bool) override {}
  void set_fullscreen(bool) override {}

 private:
  Result<void> open_card();
  Result<void> try_card(const std::string& file);
  Result<void> watch();
  void tell(const std::string& sentence) const {
    if (options_.tell) options_.tell(sentence);
  }
  void tell_output();
  Result<void> follow_seat(std::vector<WindowEvent>& out);
  Result<void> follow_plugs(std::vector<WindowEvent>& out);
  void free_pictures();
  void read_back();
  void set_timer();

  BareOptions options_;
  Clock& clock_;
  std::unique_ptr<Seat> seat_;
  std::unique_ptr<Plugs> plugs_;
  std::string card_file_;
  std::unique_ptr<Card> card_;
  std::unique_ptr<Scanout> scanout_;
  std::unique_ptr<Flipper> flipper_;
  std::unique_ptr<InputDevices> devices_;
  std::optional<Input> input_;
  LinkFacts facts_;
  bool losses_told_ = false;
  std::vector<std::string> told_;  ///< about the link; a sentence isn't said twice
  std::uint64_t modes_read_ = 0;   ///< how often the mode had been set when the link was read back
  bool active_ = true;             ///< the seat was ours at the last look
  bool plugged_ = false;           ///< a monitor was plugged in or out since the outputs were read
  bool monitor_away_ = false;
  std::optional<Error> broken_;  ///< found while a picture was shown
  Descriptor watched_{::epoll_create1(EPOLL_CLOEXEC)};
  Descriptor timer_{::timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC)};
};

BareWindow::~BareWindow() {
  devices_.reset();  // closes its files through the seat
  flipper_.reset();
  scanout_.reset();
  card_.reset();
}

Result<void> BareWindow::open() {
  Result<std::unique_ptr<Seat>> seat = Seat::open();
  if (!seat) return fail(seat.error());
  seat_ = std::move(*seat);
  Result<std::unique_ptr<Plugs>> plugs = Plugs::open();
  if (!plugs) return fail(plugs.error());
  plugs_ = std::move(*plugs);
  if (Result<void> opened = open_card(); !opened) return opened;
  Result<Keyboard> keyboard = Keyboard::create(station_keyboard());
  if (!keyboard) {
    tell(keyboard.error().text() + "; the usual one is used");
    keyboard = Keyboard::create({});
    if (!keyboard) return fail(keyboard.error());
  }
  input_.emplace(std::move(*keyboard), clock_, size());
  Result<std::unique_ptr<InputDevices>> devices = InputDevices::open(*seat_, [this](const std::string& sentence) { tell(sentence); });
  if (!devices) return fail(devices.error());
  devices_ = std::move(*devices);
  return watch();
}

/// The first card that can show a picture. If none can, what is wrong with the last one that has a monitor, or else with the last.
Result<void> BareWindow::open_card() {
  const std::vector<std::string> files = card_files();
  if (files.empty()) return fail("/dev/dri", "there is no graphics card, or its driver isn't loaded");
  Result<void> tried;
  for (const std::string& file : files) {
    tried = try_card(file);
    if (tried) return tried;
    if (files.size() > 1) tell(file + ": " + tried.error().text());
  }
  return tried;
}

Result<void> BareWindow::try_card(const std::string& file) {
  const Result<int> opened = seat_->open_device(file);
  if (!opened) return fail(opened.error());
  const auto attempt = [&]() -> Result<void> {
    Result<std::unique_ptr<Card>> card = make_drm_card(*opened, file);
    if (!card) return fail(card.error());
    const Result<CardState> state = (*card)->read(true);
    if (!state) return fail(state.error());
    Result<Output> output = choose_output(*state, options_.output);
    if (!output) return fail(output.error());
    Result<std::unique_ptr<Scanout>> scanout = Scanout::create(*opened, file, output->mode.size);
    if (!scanout) return fail(scanout.error());
    card_file_ = file;
    card_ = std::move(*card);
    scanout_ = std::move(*scanout);
    flipper_ = std::make_unique<Flipper>(*card_, clock_);
    flipper_->set_output(std::move(*output));
    tell_output();
    return {};
  };
  Result<void> done = attempt();
  if (!done) seat_->close_device(*opened);
  return done;
}

void BareWindow::tell_output() {
  const Output& output = flipper_->output();
  tell(fmt::format("shows on {} of {}: {}{}", output.connector.name, card_file_, output.mode.text(),
                   output.edid ? ", " + output.edid->identity.text() : ""));
  for (const std::string& note : output.notes) tell(note);
}

Result<void> BareWindow::watch() {
  for (const int descriptor : {seat_->descriptor(), plugs_->descriptor(), card_->descriptor(), devices_->descriptor(), timer_.get()}) {
    epoll_event event{};
    event.events = EPOLLIN;
    if (::epoll_ctl(watched_.get(), EPOLL_CTL_ADD, descriptor, &event) != 0)
      return fail("the screen", fmt::format("its events can't be watched ({})", std::strerror(errno)));
  }
  return {};
}

Result<std::vector<WindowEvent>> BareWindow::take_events() {
  if (broken_) return fail(*broken_);
  std::uint64_t expirations = 0;
  while (::read(timer_.get(), &expirations, sizeof expirations) > 0) {
  }
  std::vector<WindowEvent> out;
  if (Result<void> followed = follow_seat(out); !followed) return fail(followed.error());
  if (Result<void> followed = follow_plugs(out); !followed) return fail(followed.error());
  if (Result<void> turned = flipper_->turn(); !turned) return fail(turned.error());
  free_pictures();
  read_back();
  if (active_) devices_->turn(*input_);
  input_->turn();
  if (const int console = input_->take_console(); console != 0 && options_.may_switch_consoles) seat_->switch_to(console);
  for (WindowEvent& event : input_->take()) out.push_back(std::move(event));
  set_timer();
  return out;
}

Result<void> BareWindow::follow_seat(std::vector<WindowEvent>& out) {
  if (Result<void> turned = seat_->turn(); !turned) return turned;
  if (seat_->active() == active_) return {};
  active_ = seat_->active();
  if (!active_) {
    tell("another program, or a text console, has taken the screen");
    devices_->suspend();
    flipper_->pause();
    input_->lose();
    seat_->let_go();
    return {};
  }
  tell("the screen is ours again");
  plugged_ = true;  // what was plugged meanwhile may not have been told
  devices_->resume();
  out.emplace_back(Exposed{});
  return flipper_->resume();
}

Result<void> BareWindow::follow_plugs(std::vector<WindowEvent>& out) {
  const Plugs::Changes changes = plugs_->take();
  if (std::find(changes.cards_gone.begin(), changes.cards_gone.end(), card_file_) != changes.cards_gone.end())
    return fail(card_file_, "the graphics card is gone");
  plugged_ = plugged_ || changes.monitors;
  if (!plugged_ || !active_) return {};
  plugged_ = false;
  const Result<CardState> state = card_->read(true);
  if (!state) return fail(state.error());
  Result<Output> output = choose_output(*state, options_.output);
  if (!output) {
    // The picture stays as it is until a monitor is there again.
    if (!std::exchange(monitor_away_, true)) tell(output.error().text() + "; waiting for one");
    return {};
  }
  const Output& before = flipper_->output();
  const bool same = before.connector.id == output->connector.id && before.connector.edid == output->connector.edid &&
                    before.mode.timings == output->mode.timings && !link_failed(*state, before.connector.id);
  if (same && !std::exchange(monitor_away_, false)) return {};
  const PixelSize old_size = before.mode.size;
  flipper_->set_output(std::move(*output));
  free_pictures();
  tell_output();
  if (size() != old_size) {
    if (Result<void> resized = scanout_->resize(size()); !resized) return resized;
    input_->set_size(size());
    out.emplace_back(Resized{size()});
  }
  out.emplace_back(Moved{});
  out.emplace_back(Exposed{});
  return {};
}

void BareWindow::present() {
  if (broken_) return;
  const Result<ObjectId> picture = scanout_->swap();
  if (!picture) {
    broken_ = picture.error();
    return;
  }
  if (Result<void> shown = flipper_->show(*picture); !shown) broken_ = shown.error();
  free_pictures();
  set_timer();
}

void BareWindow::free_pictures() {
  for (const ObjectId picture : flipper_->take_released()) scanout_->release(picture);
}

/// After the mode was set: what the driver has really done.
void BareWindow::read_back() {
  if (flipper_->counts().lost >= kManyLost && !std::exchange(losses_told_, true))
    tell(card_file_ + ": the driver doesn't say when pictures appear; they may stutter, and depth is less exact");
  if (flipper_->counts().modes == modes_read_ || flipper_->counts().shown == 0) return;
  modes_read_ = flipper_->counts().modes;
  const Result<CardState> state = card_->read(false);
  if (!state) return;  // the next flip tells
  facts_ = read_link(*state, flipper_->output());
  std::vector<std::string> sentences = flipper_->refused();
  sentences.insert(sentences.end(), facts_.differ.begin(), facts_.differ.end());
  if (!facts_.not_told.empty()) {
    std::string list;
    for (const std::string& what : facts_.not_told) list += (list.empty() ? "" : ", ") + what;
    sentences.push_back(
        fmt::format("{}: the driver doesn't tell its {}: check them in the monitor's own menu", flipper_->output().connector.name, list));
  }
  for (const std::string& sentence : sentences)
    if (std::find(told_.begin(), told_.end(), sentence) == told_.end()) {
      tell(sentence);
      told_.push_back(sentence);
    }
}

void BareWindow::set_timer() {
  std::optional<std::int64_t> next = flipper_->next_ns();
  if (input_ && input_->next_ns()) next = next ? std::min(*next, *input_->next_ns()) : input_->next_ns();
  itimerspec when{};
  // An expiry of zero stops the timer.
  if (next) {
    const std::int64_t at = std::max<std::int64_t>(*next, 1);
    when.it_value = {at / 1'000'000'000, at % 1'000'000'000};
  }
  ::timerfd_settime(timer_.get(), TFD_TIMER_ABSTIME, &when, nullptr);
}

}  // namespace

Result<std::unique_ptr<Window>> open_bare_window(const BareOptions& options, Clock& clock) {
  auto window = std::make_unique<BareWindow>(options, clock);
  if (Result<void> opened = window->open(); !opened) return fail(opened.error());
  return window;
}

}  // namespace prismesh::kiosk::display::kms
