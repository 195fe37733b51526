// Runs a station's set-up on a display: shows the guide's pages, takes keys and buttons, and asks prismesh-setup.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ipc/setup/messages.h"
#include "kiosk/display/window.h"
#include "kiosk/item_trace.h"
#include "kiosk/panels/gui.h"
#include "kiosk/picture_watch.h"
#include "kiosk/render/renderer.h"
#include "kiosk/setup/guide.h"
#include "kiosk/setup/setup_panel.h"
#include "kiosk/station.h"

namespace prismesh::kiosk {

struct SetupOptions {
  std::filesystem::path socket;  ///< of prismesh-setup
  std::filesystem::path intake;  ///< of prismesh-intake
  ipc::StationSetup station;     ///< as it is at the beginning
  std::string profile;           ///< as the settings name it
  std::int64_t idle_ns = -1;     ///< without any input, until it is left; negative: never
  /// The user's own settings file. It goes before the station's, so where it exists a profile that is chosen here goes into it too.
  std::filesystem::path own_settings{};
  /// Calibrates a display of this profile. Returns the file of the new one, if it was saved. Errors: the display is gone.
  /// It ends by itself after so long without any input (negative: never).
  std::function<Result<std::optional<std::filesystem::path>>(const stereo::Profile&, std::int64_t idle_ns)> calibrate{};
};

class SetupScreen {
 public:
  /// Needs the window's GL context. Errors: the driver refuses a shader; the font is missing.
  static Result<std::unique_ptr<SetupScreen>> create(display::Window& window, Station& station, SetupOptions options);
  /// Waits for the answer that is on its way.
  ~SetupScreen();
  SetupScreen(const SetupScreen&) = delete;
  SetupScreen& operator=(const SetupScreen&) = delete;

  /// How it ended.
  enum class End : std::uint8_t { finished, left, closed };
  /// Runs until it is finished or left. Errors: the display is gone.
  Result<End> run();

 private:
  SetupScreen(display::Window& window, Station& station, SetupOptions options);

  Result<void> take_events();
  void take_key(const display::KeyChanged& key);
  Result<void> act(const setup::SetupAction& action);
  void ask();
  void send(ipc::SetupRequest request, bool of_page);
  void ask_for_code();
  void take_answer();
  void profile_changed();
  Result<void> calibrate();
  void take_calibration(const std::filesystem::path& file);
  void lay_out();
  Result<void> draw();
  void wait() const;
  bool works() const { return pending_.valid() && of_page_; }
  setup::Facts facts() const;

  display::Window& window_;
  Station& station_;
  SetupOptions options_;
  setup::Guide guide_;
  std::unique_ptr<render::Renderer> renderer_;  ///< of its own, without a model
  std::optional<panels::Gui> gui_;
  stereo::Profile profile_;
  std::future<Result<ipc::SetupAnswer>> pending_;
  bool calibrates_ = false;                ///< what is asked is to take a calibration over
  bool of_page_ = false;                   ///< what is asked comes from the page, and not from here
  std::optional<std::string> calibrated_;  ///< text of a profile that the station is to have
  bool clock_asked_ = false;               ///< for the clock page
  bool next_ = false;                      ///< the page is to go on
  std::string kept_;                       ///< the page that is kept
  std::int64_t code_asked_ns_ = 0;         ///< when a pairing code was asked for last, since it is wanted; 0: not yet
  int code_tries_ = 0;
  std::int64_t input_ns_ = 0;  ///< the last input
  std::int64_t laid_out_ns_ = 0;
  std::vector<setup::SetupAction> actions_;
  ItemTrace items_;
  std::string traced_;
  std::optional<input::Pixel> pointer_;
  PictureWatch watch_{reports_to_supervisor()};
  std::optional<End> end_;
};

}  // namespace prismesh::kiosk
