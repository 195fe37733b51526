// The calibration done by a simulated viewer who doesn't know the display's data: the kiosk's renderer draws the wizard's pages, the viewer
// looks at them through a mask that differs from the profile, and follows the instructions with limited perception and random errors. The
// result has to fit the display.
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <iostream>
#include <numbers>
#include <random>

#include "kiosk/calibration/pattern_painter.h"
#include "kiosk/calibration/wizard.h"
#include "tests/optics/optics_fixture.h"

namespace prismesh::optics {
namespace {

using drivers::display::Profile;
using kiosk::calibration::Now;
using kiosk::calibration::Page;
using kiosk::calibration::PatternPainter;
using kiosk::calibration::Step;
using kiosk::calibration::Wizard;

constexpr kiosk::display::PixelSize kSize{1280, 96};

// What a viewer notices; conservative: a trained observer sees half of it.
constexpr double kTiltNoticed = 0.012;     ///< share of the picture's height by which a band is lower on one side
constexpr double kRelativeNoticed = 0.03;  ///< of light
constexpr double kDarkNoticed = 0.004;     ///< relative to a white panel's light

/// A display with unknown errors, and the viewer before it.
struct Situation {
  viewer::MaskDisplay display;
  viewer::Sharpness sharpness;
  unsigned seed = 1;
};

class CalibrationTest : public OpticsTest {
 protected:
  void SetUp() override {
    OpticsTest::SetUp();
    if (IsSkipped()) return;
    auto painter = PatternPainter::create();
    ASSERT_TRUE(painter) << painter.error().text();
    painter_.emplace(std::move(*painter));
  }
  void TearDown() override {
    painter_.reset();
    OpticsTest::TearDown();
  }

  static Situation situation(double offset_mm, double pitch_scale, double glass_scale) {
    Situation made{OpticsTest::display(kSize.width, kSize.height), {}, 1};
    made.display.offset_mm = offset_mm;
    made.display.pitch_scale = pitch_scale;
    made.display.glass_scale = glass_scale;
    return made;
  }

  void begin(const Situation& situation) {
    situation_ = situation;
    random_.seed(situation.seed);
    start_ = profile_named("prism-mask");
    wizard_.emplace(start_, kiosk::calibration::Setup{std::nullopt, kSize, true});
    sit(0, 0);
  }

  double any(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  double about(double spread) { return std::normal_distribution<double>(0, spread)(random_); }

  /// Near the requested position, at some height.
  void sit(double aside, double back) { head_ = {aside + any(-20, 20), any(-30, 30), 650 + back + any(-20, 20)}; }
  /// The state of tracker and servo: the mask is at the position that the page requests, or follows the head by the initial profile.
  Now now() {
    Now now;
    now.eyes_seen = true;
    now.between_eyes_mm = head_ + Vec3(about(0.5), about(0.5), about(0.5));
    now.mask_mm = mask_mm(wizard_->page(now)) + about(0.002);
    return now;
  }
  double mask_mm(const Page& page) const {
    const double pitch = start_.optics.mask_pitch_mm();
    return page.hold_mask_mm.value_or(std::remainder(mask_position_mm(start_.optics, head_), pitch));
  }

  /// What an eye sees of the open page.
  viewer::Seen look(bool left) {
    const Page page = wizard_->page(now());
    Picture picture;
    picture.profile = page.profile;
    picture.between_eyes_mm = now().between_eyes_mm;
    picture.eye_separation_mm = *page.profile.eye_separation_mm;
    picture.mask_mm = page.weave_mask_mm;
    picture.overlay = [&](const EyeImage& image) { painter_->paint(page.pattern, image); };
    const Image drawn = draw(picture, kSize.width, kSize.height);
    const viewer::Eyes eyes = viewer::eyes_around(point(head_), 63);
    const auto seen = viewer::look(situation_.display, viewer::light_of(drawn.rgb, drawn.width, drawn.height, page.profile.gamma),
                                   left ? eyes.left : eyes.right, mask_mm(page), situation_.sharpness);
    EXPECT_TRUE(seen) << seen.error().text();
    return *seen;
  }
  /// Mean light of a part of the seen picture; x and y as shares of elements and rows.
  static double light_in(const viewer::Seen& seen, double x0, double x1, double y0, double y1) {
    double sum = 0, count = 0;
    for (int y = static_cast<int>(y0 * seen.rows); y < static_cast<int>(y1 * seen.rows); ++y)
      for (int x = static_cast<int>(x0 * seen.elements); x < static_cast<int>(x1 * seen.elements); ++x) {
        for (const float light : seen.at(x, y)) sum += light;
        count += 3;
      }
    return sum / count;
  }

  /// By how many picture heights the band is lower at the right than at the left. Uses its middle part: at the ends its edges are bent,
  /// because the panel's stripes aren't exactly where the windows are.
  double tilt() {
    const viewer::Seen seen = look(true);
    constexpr int kSections = 12;
    double height = 0;
    std::complex<double> before = 0;
    for (int section = 0; section < kSections; ++section) {
      std::complex<double> band = 0;
      for (int row = 0; row < seen.rows; ++row)
        band += std::polar(light_in(seen, 0.15 + 0.7 * section / kSections, 0.15 + 0.7 * (section + 1) / kSections, row / double(seen.rows),
                                    (row + 1.001) / double(seen.rows)),
                           2 * std::numbers::pi * row / seen.rows);
      if (section > 0) height += std::arg(band / before) / (2 * std::numbers::pi);
      before = band;
    }
    return height * kSections / (kSections - 1) / 0.7 + about(kTiltNoticed / 2);
  }
  void level_the_band() {
    ASSERT_EQ(wizard_->step(), Step::pitch);
    double before = tilt();
    int direction = 1;
    for (const bool coarse : {true, false})
      for (int turns = 0; turns < 400 && std::abs(before) > (coarse ? 0.15 : kTiltNoticed); ++turns) {
        wizard_->adjust(direction, coarse);
        const double after = tilt();
        if (std::abs(after) > std::abs(before) + kTiltNoticed) direction = -direction;
        before = after;
      }
    EXPECT_LE(std::abs(before), kTiltNoticed) << "the band can't be levelled";
  }

  double darkness() {
    const double light = light_in(look(false), 0.02, 0.98, 0, 0.6);
    return light * (1 + about(kRelativeNoticed / 3));
  }
  /// Searches a whole mask period for the darkest position, then the positions on both sides where it becomes brighter, and takes the
  /// middle.
  void find_the_darkest() {
    wizard_->adjust(-6, true);
    double darkest = 2;
    int best = 0;
    for (int i = 0; i <= 12; ++i) {
      if (const double light = darkness(); light < darkest) darkest = light, best = i;
      wizard_->adjust(1, true);
    }
    wizard_->adjust(best - 13, true);
    const double noticed = std::max(kDarkNoticed, kRelativeNoticed * darkest) + darkest;
    std::array<int, 2> ends{0, 0};
    int at = 0;
    for (const int side : {1, -1}) {
      wizard_->adjust(-at, false);
      at = 0;
      while (std::abs(at) < 40 && darkness() < noticed) {
        wizard_->adjust(side, false);
        at += side;
      }
      ends[side > 0 ? 0 : 1] = at;
    }
    const int middle = (ends[0] + ends[1]) / 2 + static_cast<int>(std::lround(about(0.7)));
    wizard_->adjust(middle - at, false);
  }
  void choose_places() {
    constexpr std::array<std::array<double, 2>, 5> kTold{{{0, 0}, {-90, 0}, {90, 0}, {0, -100}, {0, 110}}};
    for (const auto& [aside, back] : kTold) {
      ASSERT_EQ(wizard_->step(), Step::places);
      sit(aside, back);
      find_the_darkest();
      const Result<void> chosen = wizard_->next(now());
      ASSERT_TRUE(chosen) << chosen.error().text();
    }
    sit(0, 0);
  }

  /// Relative difference in light between the right and the left half of the field.
  double imbalance(bool left) {
    const viewer::Seen seen = look(left);
    const double first = light_in(seen, 0.2, 0.45, 0.15, 0.45), second = light_in(seen, 0.55, 0.8, 0.15, 0.45);
    return (second - first) / (second + first) + about(kRelativeNoticed / 6);
  }
  void balance(bool left) {
    ASSERT_EQ(wizard_->step(), left ? Step::crosstalk_left : Step::crosstalk_right);
    for (int turns = 0; turns < 100; ++turns) {
      const double seen = imbalance(left);
      if (std::abs(seen) < kRelativeNoticed / 4) break;
      wizard_->adjust(seen > 0 ? 1 : -1, std::abs(seen) > 5 * kRelativeNoticed);
    }
  }

  void next() {
    const Result<void> taken = wizard_->next(now());
    ASSERT_TRUE(taken) << taken.error().text();
  }
  Profile calibrated() {
    next();  // the link
    const double bar_mm = 1100 * situation_.display.panel.pitch_mm;
    const double read_mm = std::round(2 * (bar_mm + any(-0.3, 0.3))) / 2;
    wizard_->adjust(static_cast<int>(std::lround((read_mm - 1100 * wizard_->result().optics.pixel_pitch_mm) / 0.1)), false);
    next();
    next();  // the eyes' distance
    level_the_band();
    next();
    choose_places();
    balance(true);
    next();
    balance(false);
    next();
    EXPECT_EQ(wizard_->step(), Step::check);
    next();
    EXPECT_TRUE(wizard_->finished());
    return wizard_->result();
  }

  /// Max. distance between the windows of the profile's optics and those of the display, over the panel and both eyes, in pixels.
  struct Fit {
    double worst_px = 0, mean_px = 0;
  };
  Fit fit_of(const Profile& profile, const std::vector<Vec3>& heads) const {
    Fit fit;
    int count = 0;
    drivers::display::MaskOptics optics = profile.optics;
    optics.panel_columns = kSize.width;
    for (const Vec3& head : heads)
      for (const double side : {-31.5, 31.5}) {
        const Vec3 eye = head + Vec3(side, 0, 0);
        const double mask = mask_position_mm(optics, head);
        for (int i = -8; i <= 8; ++i) {
          const double share = i / 8.1, u = share * 0.5 * situation_.display.panel.width_mm();
          const double profile_u = share * 0.5 * kSize.width * optics.pixel_pitch_mm;
          const double numbers =
              viewer::element_at(situation_.display, point(eye), mask, u, 0) - window_number(optics, eye, mask, profile_u, 0);
          const double off_px = 2 * std::abs(std::remainder(numbers, 1));
          fit.worst_px = std::max(fit.worst_px, off_px);
          fit.mean_px += off_px, ++count;
        }
      }
    fit.mean_px /= count;
    return fit;
  }
  /// The error of the woven picture, including the rounding to subpixels.
  double woven_worst_px(const Profile& profile, const Vec3& head) {
    Picture picture;
    picture.profile = profile;
    picture.profile.crosstalk = {0, 0};
    picture.between_eyes_mm = head;
    picture.eye_separation_mm = 63;
    return viewer::phase_summary(situation_.display, owners(picture, situation_.display.panel), eyes_of(picture),
                                 mask_position_mm(profile.optics, head), some_rows(situation_.display.panel))
        .worst_pixels;
  }

  /// Share of the other eye's light that an eye really gets, relative to its own, with the mask at the profile's position.
  double other_share(const Profile& profile, bool left) {
    Picture picture;
    picture.profile = profile;
    picture.profile.crosstalk = {0, 0};
    picture.between_eyes_mm = head_;
    const viewer::Eyes eyes = viewer::eyes_around(point(head_), 63);
    std::array<double, 2> light{};
    for (const bool own : {false, true}) {
      const auto seen = viewer::look(situation_.display, lit(picture, left == own, situation_.display.panel), left ? eyes.left : eyes.right,
                                     mask_position_mm(profile.optics, head_), situation_.sharpness);
      EXPECT_TRUE(seen) << seen.error().text();
      light[own ? 1 : 0] = light_in(*seen, 0.2, 0.8, 0, 1);
    }
    return light[0] / light[1];
  }

  void calibrate_and_judge(const Situation& situation) {
    begin(situation);
    const Profile profile = calibrated();
    if (HasFatalFailure()) return;
    const std::vector<Vec3> heads{{0, 0, 650}, {-100, 0, 650}, {100, 20, 650}, {0, 0, 580}, {0, 0, 740}, {60, -20, 690}};
    const Fit before = fit_of(start_, heads), after = fit_of(profile, heads);
    const double woven_before = woven_worst_px(start_, heads[0]), woven_after = woven_worst_px(profile, heads[0]);
    std::cout << "zero " << profile.optics.zero_mm << " (" << situation.display.offset_mm << "), pitch " << profile.optics.pitch_scale
              << " (" << situation.display.pitch_scale << "), gap " << profile.optics.gap_scale << " (" << situation.display.glass_scale
              << "), crosstalk " << profile.crosstalk[0] << " " << profile.crosstalk[1] << "; phase error before: worst " << before.worst_px
              << " px, mean " << before.mean_px << "; after: worst " << after.worst_px << " px, mean " << after.mean_px
              << "; woven picture, head in the middle: " << woven_before << " -> " << woven_after << " px\n";
    EXPECT_GT(before.worst_px, 0.4) << "there was something to calibrate";
    EXPECT_LE(after.worst_px, 0.15);
    EXPECT_LE(after.mean_px, 0.06);
    EXPECT_GT(woven_before, 0.3);
    EXPECT_LE(woven_after, 0.3) << "a sixth of a pixel of it is rounding to subpixels";
    for (const bool left : {true, false})
      EXPECT_NEAR(profile.crosstalk[left ? 0 : 1], other_share(profile, left), 0.03) << "the other eye's light";
  }

  std::optional<PatternPainter> painter_;
  std::optional<Wizard> wizard_;
  Situation situation_;
  Profile start_;
  Vec3 head_{0, 0, 650};
  std::mt19937 random_{1};
};

TEST_F(CalibrationTest, finds_a_mask_at_another_position) { calibrate_and_judge(situation(0.19, 1, 1)); }

TEST_F(CalibrationTest, finds_a_mask_of_another_pitch) {
  calibrate_and_judge(situation(-0.1, 1.0011, 1));
  calibrate_and_judge(situation(0.03, 0.9985, 1));
}

TEST_F(CalibrationTest, finds_a_mask_at_another_distance) {
  calibrate_and_judge(situation(0.27, 1, 0.95));
  calibrate_and_judge(situation(-0.2, 1, 1.06));
}

TEST_F(CalibrationTest, finds_all_errors_through_a_mask_with_crosstalk) {
  Situation all = situation(-0.171, 1.0006, 0.972);
  all.display.panel.pitch_mm = 0.2816;
  all.sharpness = {1.1, 0.06};
  for (all.seed = 1; all.seed <= 2; ++all.seed) calibrate_and_judge(all);
}

TEST_F(CalibrationTest, finds_all_errors_with_narrow_windows) {
  Situation narrow = situation(0.11, 1.0004, 0.98);
  narrow.sharpness.window_pixels = 0.5;
  calibrate_and_judge(narrow);
}

}  // namespace
}  // namespace prismesh::optics
