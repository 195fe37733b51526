// Steps of the calibration, from a new display to a profile that is bound to it. Holds the viewer's choices and gives for each step the
// text, the pattern and the position at which to hold the mask. It uses no window, renderer or device.
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
  link,             ///< does each pixel arrive unchanged
  size,             ///< size of a pixel
  eye_separation,   ///< of this viewer
  pitch,            ///< of the mask, by bands that must be level
  places,           ///< of the mask, chosen from several positions of the head
  crosstalk_left,   ///< light of the right eye's picture that reaches the left eye
  crosstalk_right,  ///< the reverse
  check,            ///< final check before the profile is saved
};

/// The display's setup: its monitor, its panel and its mask.
struct Setup {
  std::optional<display::Monitor> monitor;
  display::PixelSize panel;   ///< size of the picture
  bool mask_answers = false;  ///< a servo moves the mask on command
};

/// Current state of the devices.
struct Now {
  bool eyes_seen = false;
  Eigen::Vector3d between_eyes_mm{0, 0, 650};
  std::optional<double> mask_mm;  ///< measured
};

/// Content of a step.
struct Page {
  int number = 1, count = 1;
  std::string title;
  std::string task;                  ///< what to do, in a few sentences
  std::string value;                 ///< current value of what is adjusted; empty: nothing to adjust
  std::vector<std::string> remarks;  ///< results, doubts, and the position of the head
  std::string next;                  ///< label of the button to the next step
  Pattern pattern;
  drivers::display::Profile profile;    ///< profile to show the pattern with
  std::optional<double> hold_mask_mm;   ///< position to hold the mask at; empty: it follows the head
  std::optional<double> weave_mask_mm;  ///< position of the mask to weave for; empty: the ideal one for these eyes
};

class Wizard {
 public:
  /// Starts at the first step. `start`: the known profile of this kind of display. Steps that don't apply to it are left out.
  Wizard(const drivers::display::Profile& start, const Setup& setup);

  Step step() const { return steps_[at_]; }
  /// Content of the current step.
  Page page(const Now& now) const;
  /// Changes the value of this step by `steps` fine steps; `coarse`: eight times as much. Stops at the value's limits.
  void adjust(int steps, bool coarse);
  /// Accepts the value and goes to the next step. Errors: why it can't be accepted yet; the step stays.
  Result<void> next(const Now& now);
  /// Goes back by one position of the head, or by one step; a finished wizard goes back to its final check.
  void back();

  bool finished() const { return finished_; }
  /// The profile with all choices so far, bound to the monitor.
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
  double mask_mm_ = 0;            ///< position that the viewer set
  double pitch_distance_mm_ = 0;  ///< distance of the eyes while the bands were levelled
  std::vector<drivers::display::MaskChoice> choices_;
  std::optional<drivers::display::MaskFit> fit_;
};

}  // namespace prismesh::kiosk::calibration
