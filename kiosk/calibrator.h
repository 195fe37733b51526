// Runs the calibration on a display: shows the wizard's pages in both eyes, takes keys and buttons, holds the mask, and saves.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "kiosk/calibration/pattern_painter.h"
#include "kiosk/calibration/wizard.h"
#include "kiosk/display/window.h"
#include "kiosk/panels/gui.h"
#include "kiosk/panels/wizard_panel.h"
#include "kiosk/picture_watch.h"
#include "kiosk/render/renderer.h"
#include "kiosk/station.h"

namespace prismesh::kiosk {

/// Where a finished calibration is written.
struct SaveTo {
  std::filesystem::path folder;    ///< of profile files
  std::filesystem::path settings;  ///< the settings file that names the station's profile
};
/// The user's own folder and settings, or the settings file given. Errors: no home folder is known.
Result<SaveTo> usual_place(const std::optional<std::filesystem::path>& settings);

/// Somebody did it, and not the window.
bool is_by_hand(const display::WindowEvent& event);

class Calibrator {
 public:
  /// Needs the window's GL context. Errors: the driver refuses a shader; the font is missing.
  static Result<std::unique_ptr<Calibrator>> create(display::Window& window, Station& station, const drivers::display::Profile& start,
                                                    SaveTo save_to);

  /// Runs until the calibration is saved or left, or nothing was touched for `idle_ns` (negative: it waits for ever). Returns the profile's
  /// file, or nothing. Errors: the display is gone.
  Result<std::optional<std::filesystem::path>> run(std::int64_t idle_ns);

 private:
  Calibrator(display::Window& window, Station& station, drivers::display::Profile start, SaveTo save_to)
      : window_(window), station_(station), start_(std::move(start)), save_to_(std::move(save_to)) {}

  Result<void> take_events();
  void take_key(const display::KeyChanged& key);
  void act(panels::WizardAction action);
  void begin_when_ready();
  calibration::Now now() const;
  Result<void> draw();
  void lay_out(const calibration::Page& page);
  panels::WizardFacts facts(const calibration::Page& page) const;
  void save();
  void wait() const;

  display::Window& window_;
  Station& station_;
  drivers::display::Profile start_;
  SaveTo save_to_;
  std::unique_ptr<render::Renderer> renderer_;  ///< of its own, without a model
  std::optional<calibration::PatternPainter> painter_;
  std::optional<panels::Gui> gui_;
  std::optional<calibration::Wizard> wizard_;
  std::int64_t began_ns_ = 0, input_ns_ = 0;
  std::int64_t laid_out_ns_ = 0;
  std::string trouble_;
  std::string traced_;
  std::optional<input::Pixel> pointer_;
  std::optional<std::filesystem::path> saved_;
  PictureWatch watch_{reports_to_supervisor()};  ///< a station's set-up calls the calibration under systemd
  bool left_ = false;
};

}  // namespace prismesh::kiosk
