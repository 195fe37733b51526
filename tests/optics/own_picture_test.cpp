// Each eye sees its own picture, anywhere in the working volume and for every known mask position.
#include <cmath>
#include <iostream>
#include <string>

#include "tests/optics/optics_fixture.h"

namespace prismesh::optics {
namespace {

constexpr double kOwnPhaseLimit = 0.25;  ///< pixels

class OwnPicture : public OpticsTest {
 protected:
  /// Differences between what an eye sees and its own and the other eye's picture.
  struct Sight {
    double to_own = 0, to_other = 0, other_share = 0;
  };
  Sight sight(const viewer::MaskDisplay& display, const Picture& picture, double true_mask_mm, bool left) {
    const viewer::Eyes eyes = eyes_of(picture);
    const auto seen = viewer::look(display, woven(picture, display.panel), left ? eyes.left : eyes.right, true_mask_mm);
    EXPECT_TRUE(seen) << seen.error().text();
    const viewer::Seen own = viewer::ordinary(display, ordinary(picture, left ? "mono-left" : "mono-right", display.panel), *seen);
    const viewer::Seen other = viewer::ordinary(display, ordinary(picture, left ? "mono-right" : "mono-left", display.panel), *seen);
    return {viewer::mean_difference(*seen, own), viewer::mean_difference(*seen, other), viewer::share_of_other(*seen, own, other)};
  }
  static std::string where(const Vec3& at) {
    return std::to_string(std::lround(at.x())) + ", " + std::to_string(std::lround(at.y())) + ", " + std::to_string(std::lround(at.z()));
  }
  /// `likeness`: min. ratio of the differences from the other eye's picture and from the eye's own.
  void expect_own_pictures(const viewer::MaskDisplay& display, const Picture& picture, double true_mask_mm, const std::string& where,
                           double likeness = 3) {
    for (const bool left : {true, false}) {
      const Sight found = sight(display, picture, true_mask_mm, left);
      EXPECT_LT(found.to_own, 1) << where << ": levels from its own picture";
      EXPECT_GT(found.to_other, likeness * found.to_own) << where << ": and not like the other eye's";
      EXPECT_LT(std::abs(found.other_share), kOwnPhaseLimit) << where << ": of the other eye's detail";
    }
  }
};

TEST_F(OwnPicture, seen_anywhere_in_the_working_volume) {
  make_renderer({});
  const viewer::MaskDisplay display = OpticsTest::display(1280, 200);
  show(test::make_crash_box());
  for (const double distance : {575.0, 650.0, 710.0})
    for (const double aside : {-120.0, -45.0, 0.0, 80.0})
      for (const double up : {-60.0, 80.0}) {
        Picture picture = at_head("prism-mask", {aside, up, distance});
        fit(picture, display.panel);
        const double mask = display.ideal_mask_mm({aside, up, distance});
        expect_own_pictures(display, picture, mask, where(picture.between_eyes_mm));
        const viewer::PhaseSummary phase =
            viewer::phase_summary(display, owners(picture, display.panel), eyes_of(picture), mask, some_rows(display.panel));
        EXPECT_LE(phase.worst_pixels, kOwnPhaseLimit) << where(picture.between_eyes_mm);
      }
}

TEST_F(OwnPicture, seen_at_any_known_mask_position) {
  make_renderer({});
  const viewer::MaskDisplay display = OpticsTest::display(1280, 120);
  show(test::make_crash_box());
  const double pitch = display.element_pitch_mm();
  for (const Vec3& head : {Vec3(0, 0, 650), Vec3(70, 30, 590)})
    for (const double periods : {0.1, 0.25, 0.5, -0.37, 3.0}) {
      Picture picture = at_head("prism-mask", head);
      fit(picture, display.panel);
      picture.mask_mm = display.ideal_mask_mm(point(head)) + periods * pitch;
      // Borders inside a pixel's stripes reduce the likeness.
      expect_own_pictures(display, picture, *picture.mask_mm, where(head) + ", mask off by " + std::to_string(periods) + " periods", 2.5);
      const viewer::PhaseSummary phase =
          viewer::phase_summary(display, owners(picture, display.panel), eyes_of(picture), *picture.mask_mm, some_rows(display.panel));
      EXPECT_LE(phase.worst_pixels, kOwnPhaseLimit) << periods;
    }
}

TEST_F(OwnPicture, seen_on_any_panel) {
  // Widths with every remainder modulo four: the even columns begin at different positions.
  for (const int columns : {1024, 1366, 1279, 1281})
    for (const Vec3& head : {Vec3(0, 0, 650), Vec3(-85, 40, 700)}) {
      const viewer::MaskDisplay display = OpticsTest::display(columns, 401);
      const Picture picture = at_head("prism-mask", head);
      const viewer::PhaseSummary phase = viewer::phase_summary(display, owners(picture, display.panel), eyes_of(picture),
                                                               display.ideal_mask_mm(point(head)), some_rows(display.panel));
      EXPECT_GT(phase.windows, 3U * static_cast<unsigned>(columns - 10));
      EXPECT_LE(phase.worst_pixels, kOwnPhaseLimit) << columns << " columns, head " << where(head);
      EXPECT_LT(phase.mean_wrong_share, 0.12) << columns << " columns, head " << where(head);
    }
}

TEST_F(OwnPicture, seen_with_the_head_tilted) {
  const viewer::MaskDisplay display = OpticsTest::display(1280, 200);
  Picture picture = at_head("prism-mask", {-40, 30, 610});
  picture.toward_right = Vec3(0.96, 0.22, -0.17).normalized();
  picture.eye_separation_mm = 58;
  const viewer::PhaseSummary phase = viewer::phase_summary(display, owners(picture, display.panel), eyes_of(picture),
                                                           display.ideal_mask_mm({-40, 30, 610}), some_rows(display.panel));
  EXPECT_LE(phase.worst_pixels, kOwnPhaseLimit);
}

TEST_F(OwnPicture, seen_on_a_fixed_leaning_lenticular) {
  make_renderer({});
  viewer::MaskDisplay display = OpticsTest::display(1280, 160);
  display.lean = 1.0 / 6;
  show(test::make_crash_box());
  for (const Vec3& head : {Vec3(0, 0, 650), Vec3(47, 0, 650), Vec3(-110, 60, 560), Vec3(25, -40, 730)}) {
    Picture picture = at_head("lenticular", head);
    fit(picture, display.panel);
    expect_own_pictures(display, picture, 0, "lenticular, " + where(head));
    const viewer::PhaseSummary phase =
        viewer::phase_summary(display, owners(picture, display.panel), eyes_of(picture), 0, some_rows(display.panel));
    EXPECT_LE(phase.worst_pixels, kOwnPhaseLimit) << where(head);
  }
}

TEST_F(OwnPicture, swapped_eyes_are_detected) {
  make_renderer({});
  const viewer::MaskDisplay display = OpticsTest::display(1280, 120);
  show(test::make_crash_box());
  Picture picture = at_head("prism-mask", {0, 0, 650});
  fit(picture, display.panel);
  picture.profile.swap_eyes = true;
  for (const bool left : {true, false}) {
    const Sight found = sight(display, picture, 0, left);
    EXPECT_GT(found.to_own, 3 * found.to_other);
    EXPECT_GT(found.other_share, 0.9);
  }
}

TEST_F(OwnPicture, seen_with_crosstalk) {
  make_renderer({});
  const viewer::MaskDisplay display = OpticsTest::display(1280, 160);
  show(test::make_crash_box());
  constexpr double kLeak = 0.08;
  Picture picture = at_head("prism-mask", {0, 0, 650});
  fit(picture, display.panel);
  const auto share = [&](const std::array<double, 2>& corrected) {
    picture.profile.crosstalk = corrected;
    const Image image = draw(picture, display.panel.columns, display.panel.rows);
    const auto as_light = [](const Image& drawn) { return viewer::light_of(drawn.rgb, drawn.width, drawn.height, 2.2); };
    const viewer::Seen seen = *viewer::look(display, as_light(image), eyes_of(picture).left, 0, {1, kLeak});
    std::array<viewer::Seen, 2> wanted;
    for (const std::size_t i : {0, 1}) {
      Picture mono = picture;
      mono.profile = profile_named(i == 0 ? "mono-left" : "mono-right");
      wanted[i] = viewer::ordinary(display, as_light(draw(mono, display.panel.columns, display.panel.rows)), seen);
    }
    return viewer::share_of_other(seen, wanted[0], wanted[1]);
  };
  const double uncorrected = share({0, 0}), corrected = share({kLeak, kLeak});
  EXPECT_GT(uncorrected, 0.4 * kLeak) << "the viewer sees the ghost, blurred over both sides";
  EXPECT_LT(std::abs(corrected), 0.4 * uncorrected) << "and hardly with the correction";
  std::cout << "of the other eye's detail is seen: " << uncorrected << " without, " << corrected << " with crosstalk correction\n";
}

}  // namespace
}  // namespace prismesh::optics
