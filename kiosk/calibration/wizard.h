// Step by step from a display out of its box to a profile that is bound to it. Holds what the viewer has chosen so far; knows no window, no
// renderer and no device: it says what to show, in words and as a pattern, and where the mask should be held meanwhile.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "base/error.h"
#include "drivers/display/calibration.h"
#include "drivers/display/profile.h"
#include "kiosk/calibration/pattern.h"
#include "kiosk/display/link_check.h"

namespace prismesh::kiosk::calibration {

enum class Step : std::uint8_t {
  link,             ///< does each pixel arrive as it was sent
  size,             ///< how large is a pixel
  eye_separation,   ///< of this viewer
  pitch,            ///< of the mask, by a band that must lie level
  places,           ///< of the mask, best seen from several places of the head
  crosstalk_left,   ///< what shines through to the left eye
  crosstalk_right,  ///< and to the right one
  check,            ///< a last look, then it is saved
};

/// The display's setup: its monitor, its panel and its mask.
struct Setup {
  std::optional<display::Monitor> monitor;
  display::PixelSize panel;   ///< what the picture covers
  bool mask_answers = false;  ///< a servo takes the mask where it is told
};

/// What the devices say at the moment.
struct Now {
  bool eyes_seen = false;
  Eigen::Vector3d between_eyes_mm{0, 0, 650};
  std::optional<double> mask_mm;  ///< measured
};

/// What a step shows.
struct Page {
  int number = 1, count = 1;
  std::string title;
  std::string task;                  ///< what to do, in a few sentences
  std::string value;                 ///< what is being adjusted, as it stands; empty: nothing is
  std::vector<std::string> remarks;  ///< what was found out, doubts, where the head is
  std::string next;                  ///< what the button that goes on says
  Pattern pattern;
  drivers::display::Profile profile;    ///< to show the pattern with
  std::optional<double> hold_mask_mm;   ///< where the mask is to be held; empty: let it follow
  std::optional<double> weave_mask_mm;  ///< where the weave takes the mask to stand; empty: where it should for these eyes
};

class Wizard {
 public:
  /// `start`: what is known of this kind of display. Steps that don't apply to it are left out.
  Wizard(const drivers::display::Profile& start, const Setup& setup);

  Step step() const { return steps_[at_]; }
  Page page(const Now& now) const;
  /// Changes the value of this step by so many fine steps; `coarse`: eight times as far. Stops at the value's limits.
  void adjust(int steps, bool coarse);
  /// Takes what is set and goes on. Errors: why it can't be taken yet, as a sentence; the step stays.
  Result<void> next(const Now& now);
  /// One place, or one step, back; a wizard that is finished goes back to its last look.
  void back();

  bool finished() const { return finished_; }
  /// The profile with everything chosen so far, bound to the monitor.
  drivers::display::Profile result() const;
  const std::vector<drivers::display::MaskChoice>& choices() const { return choices_; }

 private:
  void enter();
  std::size_t seats() const;
  void link_page(const Now& now, Page& page) const;
  void size_page(const Now& now, Page& page) const;
  void separation_page(const Now& now, Page& page) const;
  void pitch_page(const Now& now, Page& page) const;
  void places_page(const Now& now, Page& page) const;
  void crosstalk_page(const Now& now, Page& page) const;
  void check_page(const Now& now, Page& page) const;
  Result<void> choose_place(const Now& now);
  void take_fit();
  std::string where_to_sit(const Now& now) const;

  drivers::display::Profile profile_;
  Setup setup_;
  std::vector<Step> steps_;
  std::size_t at_ = 0;
  bool finished_ = false;
  double bar_mm_ = 0;
  double mask_mm_ = 0;            ///< where the viewer turns it to
  double pitch_distance_mm_ = 0;  ///< of the eyes while the band was levelled
  std::vector<drivers::display::MaskChoice> choices_;
  std::optional<drivers::display::MaskFit> fit_;
};

}  // namespace prismesh::kiosk::calibration
