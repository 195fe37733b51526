#include "kiosk/calibration/wizard.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace prismesh::kiosk::calibration {
namespace {

using drivers::display::Profile;
using drivers::display::Weave;

/// Positions of the head: mm to the right of the middle, and farther than the design distance.
struct Seat {
  double aside, back;
  const char* words;
};
constexpr std::array<Seat, 5> kSeats{{{0, 0, "Sit before the middle of the screen"},
                                      {-90, 0, "Move your head a hand's breadth to the left"},
                                      {90, 0, "Move your head a hand's breadth to the right"},
                                      {0, -100, "Come a hand's breadth nearer"},
                                      {0, 110, "Lean back a hand's breadth"}}};
constexpr double kSeatToleranceMm = 45;
constexpr int kCoarse = 8;
constexpr double kMinSeparationMm = 50, kMaxSeparationMm = 75;
constexpr double kPitchStep = 2e-5, kPitchRange = 0.02;
constexpr double kCrosstalkStep = 0.0025, kMaxCrosstalk = 0.3;
constexpr double kBarStepMm = 0.1;
constexpr int kMaskStepsPerPitch = 96;
constexpr double kMaxMaskPitches = 0.75;  ///< of the mask from its middle

bool shares_panel(const Profile& profile) { return profile.has_mask() || profile.weave == Weave::rows; }

std::vector<Step> steps_for(const Profile& profile) {
  std::vector<Step> steps{Step::link, Step::size};
  if (profile.stereo()) steps.push_back(Step::eye_separation);
  if (profile.weave == Weave::mask) steps.push_back(Step::pitch);
  if (profile.weave == Weave::mask) steps.push_back(Step::places);
  if (shares_panel(profile)) {
    steps.push_back(Step::crosstalk_left);
    steps.push_back(Step::crosstalk_right);
  }
  steps.push_back(Step::check);
  return steps;
}

/// The same display without stereo, for patterns on the panel's own pixels.
Profile flat(Profile profile) {
  profile.weave = Weave::centre;
  return profile;
}

/// The position between the eyes of a viewer on a seat, mm from the panel's centre.
Eigen::Vector3d seat_mm(const Profile& profile, const Seat& seat) { return {seat.aside, 0, profile.optics.design_distance_mm + seat.back}; }

double stepped(double value, double by, double low, double high) { return std::clamp(value + by, low, high); }

int bar_pixels(const Setup& setup) { return ruler_bar(setup.panel.width).bars.front().pixels; }

/// With sign and three decimals; zero is +0.000, never -0.000.
std::string with_sign(double value) { return fmt::format("{:+.3f}", std::round(value * 1000) == 0 ? 0.0 : value); }

std::string eye_to_close(bool left_eye_looks) {
  return left_eye_looks ? "Close your right eye and look with the left one. " : "Close your left eye and look with the right one. ";
}

}  // namespace

Wizard::Wizard(const Profile& start, const Setup& setup) : profile_(start), setup_(setup), steps_(steps_for(start)) {
  profile_.optics.panel_columns = setup.panel.width;
  if (!profile_.eye_separation_mm) profile_.eye_separation_mm = drivers::display::kMeanEyeSeparationMm;
  const std::optional<display::Monitor>& monitor = setup_.monitor;
  if (monitor && monitor->edid && monitor->edid->width_mm > 0 && monitor->native.width > 0)
    profile_.optics.pixel_pitch_mm = monitor->edid->width_mm / monitor->native.width;
  bar_mm_ = bar_pixels(setup_) * profile_.optics.pixel_pitch_mm;
  enter();
}

void Wizard::enter() {
  if (step() != Step::places) return;
  choices_.clear();
  fit_.reset();
  mask_mm_ = 0;
}

/// A fixed mask is shifted in the picture instead, and the picture follows the head: one position is enough.
std::size_t Wizard::seats() const { return setup_.mask_answers ? kSeats.size() : 1; }

Page Wizard::page(const Now& now) const {
  Page page;
  page.number = static_cast<int>(at_) + 1;
  page.count = static_cast<int>(steps_.size());
  page.next = "Next";
  page.profile = profile_;
  if (!setup_.mask_answers) page.weave_mask_mm = 0;
  switch (step()) {
    case Step::link: link_page(now, page); break;
    case Step::size: size_page(now, page); break;
    case Step::eye_separation: separation_page(now, page); break;
    case Step::pitch: pitch_page(now, page); break;
    case Step::places: places_page(now, page); break;
    case Step::crosstalk_left:
    case Step::crosstalk_right: crosstalk_page(now, page); break;
    case Step::check: check_page(now, page); break;
  }
  return page;
}

void Wizard::link_page(const Now& /*now*/, Page& page) const {
  page.title = "The way to the panel";
  page.task =
      "Each pixel has to arrive as it was sent. Look at the two striped fields from where you sit: they must have the same colour. If the "
      "left one looks greyer or darker, colours arrive at half width: set RGB or 4:4:4 in the graphics settings.";
  page.pattern = colour_stripes();
  page.profile = flat(profile_);
  const display::LinkReport report = display::check_link(result(), setup_.monitor);
  page.remarks = report.refusals;
  page.remarks.insert(page.remarks.end(), report.doubts.begin(), report.doubts.end());
  page.next = "They look alike";
}

void Wizard::size_page(const Now& /*now*/, Page& page) const {
  page.title = "The size of a pixel";
  page.task = "Lay a ruler along the white bar and set the length that you read.";
  page.value = fmt::format("{:.1f} mm", bar_mm_);
  page.remarks.push_back(fmt::format("a pixel is then {:.4f} mm wide", bar_mm_ / bar_pixels(setup_)));
  page.pattern = ruler_bar(setup_.panel.width);
  page.profile = flat(profile_);
}

void Wizard::separation_page(const Now& /*now*/, Page& page) const {
  page.title = "The distance of your eyes";
  page.task =
      "Set the distance between your pupils: an optician's note says it, or hold a ruler under your eyes before a mirror. If you "
      "don't know it, leave 63 mm.";
  page.value = fmt::format("{:.1f} mm", *profile_.eye_separation_mm);
  page.pattern.ground = {0.3F, 0.3F, 0.3F};
  page.profile = flat(profile_);
}

void Wizard::pitch_page(const Now& /*now*/, Page& page) const {
  page.title = "The mask's pitch";
  page.task = eye_to_close(true) +
              "Bands of colour go across the picture, one of them white. Turn until each "
              "keeps its colour all the way from left to right.";
  page.value = with_sign(100 * (profile_.optics.pitch_scale - 1)) + " %";
  page.pattern = one_eye_bright(true);
  // A lean of one mask pitch over the picture's height makes the phase run through one period from top to bottom. The picture is bright at
  // the height where the phase fits.
  page.profile.optics.lean += profile_.optics.mask_pitch_mm() / (setup_.panel.height * profile_.optics.pixel_pitch_mm);
  if (setup_.mask_answers) page.hold_mask_mm = 0;
}

void Wizard::places_page(const Now& now, Page& page) const {
  const std::size_t seat = std::min(choices_.size(), kSeats.size() - 1);
  page.title = "The mask's place";
  page.task = std::string(kSeats[seat].words) + ". " + eye_to_close(false) +
              "Turn past the darkest place to both sides, come back to the middle between them, and choose.";
  page.value = with_sign(mask_mm_) + " mm";
  page.remarks.push_back(fmt::format("place {} of {}", seat + 1, seats()));
  if (std::string where = where_to_sit(now); !where.empty()) page.remarks.push_back(std::move(where));
  page.pattern = one_eye_bright(true);
  page.profile.optics.zero_mm = setup_.mask_answers ? 0 : -mask_mm_;
  if (setup_.mask_answers) page.hold_mask_mm = mask_mm_;
  page.next = "Choose";
}

void Wizard::crosstalk_page(const Now& now, Page& page) const {
  const bool left = step() == Step::crosstalk_left;
  page.title = left ? "What shines through to the left eye" : "What shines through to the right eye";
  page.task = eye_to_close(left) + "Turn until both halves of the field have the same grey.";
  page.value = fmt::format("{:.2f} %", 100 * profile_.crosstalk[left ? 0 : 1]);
  page.pattern = crosstalk_patches(left);
  if (now.mask_mm) page.weave_mask_mm = now.mask_mm;
}

void Wizard::check_page(const Now& now, Page& page) const {
  page.title = "A last look";
  page.task =
      "With the left eye alone you see the upright bar on the left, with the right eye alone the lying bar on the right, with both "
      "eyes both of them in one frame. Move your head: it must stay so.";
  if (fit_) {
    page.remarks.push_back(fmt::format("your choices agree to {:.2f} px", fit_->scatter_px));
    if (!fit_->gap_found) page.remarks.emplace_back("the mask's distance was taken as designed: the head didn't move enough to measure it");
  }
  page.pattern = eye_marks();
  if (now.mask_mm) page.weave_mask_mm = now.mask_mm;
  page.next = "Save";
}

std::string Wizard::where_to_sit(const Now& now) const {
  const Eigen::Vector3d wanted = seat_mm(profile_, kSeats[std::min(choices_.size(), kSeats.size() - 1)]);
  if (!now.eyes_seen) return "the tracker doesn't see your eyes: come before it, or sit as told as well as you can";
  const double aside = wanted.x() - now.between_eyes_mm.x(), back = wanted.z() - now.between_eyes_mm.z();
  std::string where;
  if (std::abs(aside) > kSeatToleranceMm) where = fmt::format("{:.0f} mm to the {}", std::abs(aside), aside > 0 ? "right" : "left");
  if (std::abs(back) > kSeatToleranceMm)
    where += fmt::format("{}{:.0f} mm {}", where.empty() ? "" : " and ", std::abs(back), back > 0 ? "back" : "nearer");
  return where.empty() ? "you sit right" : "move " + where;
}

void Wizard::adjust(int steps, bool coarse) {
  const double by = steps * (coarse ? kCoarse : 1);
  switch (step()) {
    case Step::size: {
      const double pixels = bar_pixels(setup_);
      bar_mm_ = stepped(bar_mm_, by * kBarStepMm, 0.05 * pixels, 2.0 * pixels);
      profile_.optics.pixel_pitch_mm = bar_mm_ / pixels;
      break;
    }
    case Step::eye_separation:
      profile_.eye_separation_mm = stepped(*profile_.eye_separation_mm, by * 0.5, kMinSeparationMm, kMaxSeparationMm);
      break;
    case Step::pitch:
      profile_.optics.pitch_scale = stepped(profile_.optics.pitch_scale, by * kPitchStep, 1 - kPitchRange, 1 + kPitchRange);
      break;
    case Step::places: {
      const double pitch = profile_.optics.mask_pitch_mm();
      mask_mm_ += by * pitch / kMaskStepsPerPitch;
      // The picture repeats after a whole pitch, so turning has no end and the mask stays near its middle.
      if (std::abs(mask_mm_) > kMaxMaskPitches * pitch) mask_mm_ = std::remainder(mask_mm_, pitch);
      break;
    }
    case Step::crosstalk_left:
    case Step::crosstalk_right: {
      double& share = profile_.crosstalk[step() == Step::crosstalk_left ? 0 : 1];
      share = stepped(share, by * kCrosstalkStep, 0, kMaxCrosstalk);
      break;
    }
    case Step::link:
    case Step::check: break;
  }
}

Result<void> Wizard::choose_place(const Now& now) {
  const Seat& seat = kSeats[choices_.size()];
  drivers::display::MaskChoice choice{seat_mm(profile_, seat), mask_mm_};
  if (now.eyes_seen) {
    const Eigen::Vector3d off = now.between_eyes_mm - choice.between_eyes_mm;
    if (std::abs(off.x()) > kSeatToleranceMm || std::abs(off.z()) > kSeatToleranceMm)
      return fail("calibration", "not chosen yet: go there first");
    choice.between_eyes_mm = now.between_eyes_mm;
  }
  // The shift of the picture counts as a movement of the mask.
  if (!setup_.mask_answers)
    choice.mask_mm += drivers::display::mask_position_mm(profile_.optics, choice.between_eyes_mm) + profile_.optics.zero_mm;
  if (setup_.mask_answers && now.mask_mm) choice.mask_mm = *now.mask_mm;
  choices_.push_back(choice);
  Result<drivers::display::MaskFit> fit = drivers::display::fit_mask(profile_.optics, choices_);
  if (!fit) {
    choices_.pop_back();
    return fail(fit.error());
  }
  fit_ = *fit;
  return {};
}

void Wizard::take_fit() {
  drivers::display::MaskOptics& optics = profile_.optics;
  // The level bands fixed the distance of the windows on the panel, P (D + g') / D. With the fitted gap the pitch changes accordingly.
  const double before = pitch_distance_mm_ + optics.air_gap_mm();
  optics.zero_mm = fit_->zero_mm;
  optics.gap_scale = fit_->gap_scale;
  optics.pitch_scale *= before / (pitch_distance_mm_ + optics.air_gap_mm());
}

Result<void> Wizard::next(const Now& now) {
  if (finished_) return {};
  if (step() == Step::pitch) pitch_distance_mm_ = now.eyes_seen ? now.between_eyes_mm.z() : profile_.optics.design_distance_mm;
  if (step() == Step::places) {
    if (Result<void> chosen = choose_place(now); !chosen) return chosen;
    if (choices_.size() < seats()) return {};
    take_fit();
  }
  if (at_ + 1 == steps_.size()) {
    finished_ = true;
    return {};
  }
  ++at_;
  enter();
  return {};
}

void Wizard::back() {
  if (std::exchange(finished_, false)) return;
  if (step() == Step::places && !choices_.empty()) {
    choices_.pop_back();
    return;
  }
  if (at_ > 0) --at_;
  enter();
}

Profile Wizard::result() const {
  Profile profile = profile_;
  profile.monitor.pixels = {setup_.panel.width, setup_.panel.height};
  if (setup_.monitor && setup_.monitor->edid) {
    const drivers::display::MonitorIdentity& identity = setup_.monitor->edid->identity;
    profile.monitor.name = identity.maker + " " + identity.model;
    profile.monitor.serial = identity.serial;
  }
  return profile;
}

}  // namespace prismesh::kiosk::calibration
