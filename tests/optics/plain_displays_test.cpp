// Displays without a mask: each eye sees its own picture through its glass, half or row.
#include "tests/optics/optics_fixture.h"

namespace prismesh::optics {
namespace {

using viewer::LightImage;
using viewer::PlainKind;

class PlainDisplays : public OpticsTest, public testing::WithParamInterface<std::pair<const char*, PlainKind>> {
 protected:
  viewer::Panel panel_{.columns = 640, .rows = 360};
  LightImage grey(const LightImage& image) const {
    LightImage result = image;
    for (viewer::Colour& pixel : result.pixels) pixel.fill(0.2126F * pixel[0] + 0.7152F * pixel[1] + 0.0722F * pixel[2]);
    return result;
  }
};

TEST_P(PlainDisplays, each_eye_sees_its_own_picture) {
  make_renderer({});
  show(test::make_crash_box());
  const auto [profile, kind] = GetParam();
  Picture picture = at_head(profile, {0, 0, 650});
  fit(picture, panel_);
  const LightImage shown = woven(picture, panel_);
  for (const bool left : {true, false}) {
    const LightImage seen = viewer::seen_on(kind, shown, left);
    LightImage own = ordinary(picture, left ? "mono-left" : "mono-right", panel_),
               other = ordinary(picture, left ? "mono-right" : "mono-left", panel_);
    if (kind == PlainKind::anaglyph) own = grey(own), other = grey(other);
    const double to_own = viewer::mean_difference(seen, viewer::resized(own, seen.width, seen.height));
    const double to_other = viewer::mean_difference(seen, viewer::resized(other, seen.width, seen.height));
    EXPECT_LT(to_own, 6) << profile << (left ? ", left" : ", right");
    EXPECT_GT(to_other, 1.5 * to_own) << profile << (left ? ", left" : ", right");
  }
}

TEST_P(PlainDisplays, no_light_of_the_other_eye_is_seen) {
  const auto [profile, kind] = GetParam();
  const Picture picture = at_head(profile, {0, 0, 650});
  for (const bool left : {true, false}) {
    const LightImage shown = lit(picture, left, panel_);
    for (const viewer::Colour& light : viewer::seen_on(kind, shown, left).pixels) ASSERT_GT(light[1], 0.95F) << profile;
    for (const viewer::Colour& light : viewer::seen_on(kind, shown, !left).pixels) ASSERT_LT(light[1], 0.01F) << profile;
  }
}

INSTANTIATE_TEST_SUITE_P(, PlainDisplays,
                         testing::Values(std::pair("row-interlaced", PlainKind::rows), std::pair("side-by-side", PlainKind::side_by_side),
                                         std::pair("top-bottom", PlainKind::top_bottom), std::pair("anaglyph", PlainKind::anaglyph)),
                         [](const auto& given) {
                           std::string name = given.param.first;
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace prismesh::optics
