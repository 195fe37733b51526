// Colours by a field: the maps, the picture of known values, uploads, and two views in one picture.
#include <algorithm>
#include <cmath>
#include <limits>

#include "kiosk/render/colour_map.h"
#include "tests/kiosk/render_test.h"

namespace prismesh::kiosk::render {
namespace {

constexpr int kColoursWidth = 480, kColoursHeight = 320;

/// Approximates what people without red or without green receptors see of a colour: the missing cone's response follows from the others
/// [Viénot 1999].
Colour seen_without(bool red, const Colour& colour) {
  const float l = 0.31399022F * colour.x() + 0.63951294F * colour.y() + 0.04649755F * colour.z();
  const float m = 0.15537241F * colour.x() + 0.75789446F * colour.y() + 0.08670142F * colour.z();
  const float s = 0.01775239F * colour.x() + 0.10944209F * colour.y() + 0.87256922F * colour.z();
  const float ll = red ? 1.05118294F * m - 0.05116099F * s : l;
  const float mm = red ? m : 0.9513092F * l + 0.04866992F * s;
  return {5.47221206F * ll - 4.6419601F * mm + 0.16963708F * s, -1.1252419F * ll + 2.29317094F * mm - 0.1678952F * s,
          0.02980165F * ll - 0.19318073F * mm + 1.16364789F * s};
}

TEST(ColourMaps, have_even_steps_and_only_get_darker) {
  for (const ColourMap map : {ColourMap::crimson, ColourMap::blues}) {
    const auto& colours = colours_of(map);
    float min = 1, max = 0;
    for (std::size_t i = 16; i < colours.size(); i += 16) {
      const Eigen::Vector3f from = oklab_of(colours[i - 16]), to = oklab_of(colours[i]);
      EXPECT_LT(to.x(), from.x()) << i;
      min = std::min(min, (to - from).norm());
      max = std::max(max, (to - from).norm());
    }
    EXPECT_LT(max, 1.1F * min) << "equal steps must look equal";
  }
}

TEST(ColourMaps, can_be_read_by_colour_blind_people) {
  for (const ColourMap map : {ColourMap::crimson, ColourMap::blues})
    for (const bool red : {true, false}) {
      const auto& colours = colours_of(map);
      for (std::size_t i = 16; i < colours.size(); i += 16) {
        const Colour before = seen_without(red, colours[i - 16]), after = seen_without(red, colours[i]);
        EXPECT_LT(0.30F * after.x() + 0.59F * after.y() + 0.11F * after.z(), 0.30F * before.x() + 0.59F * before.y() + 0.11F * before.z())
            << i;
      }
    }
}

TEST(ColourMaps, their_end_is_not_the_colour_that_means_fail) {
  EXPECT_GT((oklab_of(colours_of(ColourMap::crimson).back()) - oklab_of(kFailColour)).norm(), 0.12F);
  for (const ColourMap map : {ColourMap::crimson, ColourMap::blues})
    for (const Colour& colour : colours_of(map)) EXPECT_GT((oklab_of(colour) - oklab_of(kWarnColour)).norm(), 0.2F);
}

TEST(FieldLookTest, values_below_the_limit_keep_their_own_colour) {
  FieldLook look{true, 1, 5, ColourMap::crimson, 0};
  EXPECT_FALSE(look.colour_of(0.999));
  EXPECT_FALSE(look.colour_of(1));
  EXPECT_FALSE(look.colour_of(std::numeric_limits<double>::quiet_NaN()));
  EXPECT_EQ(*look.colour_of(5), colours_of(ColourMap::crimson).back());
  EXPECT_EQ(*look.colour_of(500), colours_of(ColourMap::crimson).back());
  look = {true, 0.7, 0.3, ColourMap::crimson, 0};  // small values are worse
  EXPECT_FALSE(look.colour_of(0.8));
  EXPECT_EQ(*look.colour_of(0.1), colours_of(ColourMap::crimson).back());
  look = {true, 0, 10, ColourMap::blues, 5};
  EXPECT_EQ(*look.colour_of(2.1), *look.colour_of(3.9));
  EXPECT_NE(*look.colour_of(3.9), *look.colour_of(4.1));
}

class FieldColoursTest : public RenderTest {
 protected:
  /// A plate of 40 x 30 quads seen from above, its values growing from left to right.
  Picture plate(std::size_t pane = 0) {
    test::TestSource source;
    test::add_grid(source, 40, 30, 0, [](double u, double v) { return mesh::Vec3(120 * u, 80 * v, 0); });
    EXPECT_TRUE(pane == 0 ? renderer_->set_model(std::make_shared<test::TestSource>(source))
                          : renderer_->set_other(std::make_shared<test::TestSource>(source)));
    across_.clear();
    for (std::size_t n = 0; n < source.positions.size(); ++n) across_.push_back(static_cast<float>(source.positions[n].x() / 12));
    Picture picture = fitted("mono", "top", kColoursWidth, kColoursHeight);
    picture.element_edges = picture.outlines = picture.quality_glyphs = false;
    return picture;
  }
  static Colour colour_at(const Image& image, const Eigen::Vector2d& pixel) {
    const std::uint8_t* at = image.at(static_cast<int>(pixel.x()), static_cast<int>(pixel.y()));
    return Colour(at[0], at[1], at[2]) / 255;
  }
  /// Hue and chroma alone, as light changes only the brightness of a colour.
  static Eigen::Vector2f tint(const Colour& colour) { return {colour.x() / colour.sum(), colour.y() / colour.sum()}; }
  Colour at_place(const Image& image, const Picture& picture, double x, double y) {
    return colour_at(image, *stereo::pixel_of(aim_of(picture, kColoursWidth, kColoursHeight), mesh::Vec3(x, y, 0)));
  }
  std::vector<float> across_;
};

TEST_F(FieldColoursTest, values_of_nodes_get_the_maps_colours) {
  Picture picture = plate();
  const Image plain = draw(picture, kColoursWidth, kColoursHeight);
  ASSERT_TRUE(renderer_->set_field(Pane::model, across_, true));
  picture.colour = ColourMode::field;
  picture.field[0] = {true, 2, 8, ColourMap::crimson, 0};
  const Image coloured = draw(picture, kColoursWidth, kColoursHeight);
  EXPECT_EQ(at_place(coloured, picture, 12, 41), at_place(plain, picture, 12, 41)) << "1 is below the limit: the part's own colour";
  for (const double value : {3.0, 5.0, 7.0, 9.0}) {
    const Colour wanted = *picture.field[0].colour_of(value);
    const Colour seen = at_place(coloured, picture, 12 * value, 41);
    EXPECT_LT((tint(seen) - tint(wanted)).norm(), 0.012F) << value;
  }
}

TEST_F(FieldColoursTest, values_of_shells_colour_whole_shells_and_shells_without_value_keep_their_colour) {
  Picture picture = plate();
  const Image plain = draw(picture, kColoursWidth, kColoursHeight);
  std::vector<float> values(40 * 30, 0.0F);
  values[15 * 40 + 20] = 4;
  values[15 * 40 + 22] = std::numeric_limits<float>::quiet_NaN();
  ASSERT_TRUE(renderer_->set_field(Pane::model, values, false));
  picture.colour = ColourMode::field;
  picture.field[0] = {true, 1, 5, ColourMap::blues, 0};
  const Image coloured = draw(picture, kColoursWidth, kColoursHeight);
  const double side = 3, y = 15.5 * 80 / 30;
  EXPECT_NE(at_place(coloured, picture, 20.5 * side, y), at_place(plain, picture, 20.5 * side, y));
  for (const double column : {18.5, 21.5, 22.5})
    EXPECT_EQ(at_place(coloured, picture, column * side, y), at_place(plain, picture, column * side, y)) << column;
}

TEST_F(FieldColoursTest, values_of_another_model_are_not_shown) {
  Picture picture = plate();
  const Image plain = draw(picture, kColoursWidth, kColoursHeight);
  across_.push_back(9);
  ASSERT_TRUE(renderer_->set_field(Pane::model, across_, true));
  picture.colour = ColourMode::field;
  picture.field[0] = {true, 0, 1, ColourMap::crimson, 0};
  EXPECT_EQ(draw(picture, kColoursWidth, kColoursHeight).rgb, plain.rgb);
}

TEST_F(FieldColoursTest, new_values_upload_only_the_rows_that_differ) {
  plate();
  std::vector<float> values(5 * mesh::kChunkSize, 1.0F);
  ASSERT_TRUE(renderer_->set_field(Pane::model, values, true));
  const std::size_t before = renderer_->figures().bytes_uploaded;
  values[3 * mesh::kChunkSize + 7] = 2;
  ASSERT_TRUE(renderer_->set_field(Pane::model, values, true));
  EXPECT_EQ(renderer_->figures().bytes_uploaded - before, mesh::kChunkSize * 8);
}

TEST_F(FieldColoursTest, two_views_stay_in_their_halves_of_the_picture) {
  plate(1);
  Picture picture = plate();
  picture.colour = ColourMode::field;
  picture.field[1] = {true, 0, 10, ColourMap::crimson, 0};
  picture.view = stereo::zoom(picture.view, 0.4, {0, 0});
  ASSERT_TRUE(renderer_->set_field(Pane::other, across_, true));
  const Image alone = draw(picture, kColoursWidth, kColoursHeight);
  picture.two_views = TwoViews{true, 0.25};
  const Image both = draw(picture, kColoursWidth, kColoursHeight);
  // The model is drawn as in the middle, shifted to the right by a quarter; the left half shows the other one in its colours.
  const auto differ = [](const Colour& a, const Colour& b) { return (a - b).norm() > 0.02F; };
  int same = 0, coloured = 0;
  for (int y = 100; y < 220; y += 8)
    for (int x = 180; x < 300; x += 8) {
      const bool is_model = differ(colour_at(alone, {x, y}), colour_at(alone, {2, y}));
      if (!is_model) continue;
      same += differ(colour_at(both, {x + kColoursWidth / 4, y}), colour_at(alone, {x, y})) ? 0 : 1;
      coloured += differ(colour_at(both, {x - kColoursWidth / 4, y}), colour_at(alone, {x, y})) ? 1 : 0;
    }
  EXPECT_GT(same, 40);
  EXPECT_GT(coloured, 40);
  // However near the models are, none is visible in the other's half.
  picture.view = stereo::zoom(picture.view, 40, {0, 0});
  const Image near = draw(picture, kColoursWidth, kColoursHeight);
  const Image ground = [&] {
    EXPECT_TRUE(renderer_->set_model(nullptr) && renderer_->set_other(nullptr));
    return draw(picture, kColoursWidth, kColoursHeight);
  }();
  for (int y = 0; y < kColoursHeight; y += 16)
    EXPECT_FALSE(differ(colour_at(near, {kColoursWidth / 2, y}), colour_at(ground, {kColoursWidth / 2, y}))) << y;
}

/// Each of the two eyes' images must contain both halves, and they must differ only by the model's parallax.
TEST_F(FieldColoursTest, both_eyes_see_both_views) {
  plate(1);
  Picture picture = plate();
  picture.view.rotation = *stereo::named_rotation("iso");
  picture.view = stereo::zoom(picture.view, 0.5, {0, 0});
  picture.two_views = TwoViews{true, 0.25};
  for (const char* profile : {"mono-left", "mono-right"}) {
    picture.profile = *stereo::find_profile(profile);
    const Image image = draw(picture, kColoursWidth, kColoursHeight);
    for (const bool right : {false, true}) {
      int bright = 0;
      for (int y = 0; y < kColoursHeight; y += 4)
        for (int x = right ? kColoursWidth / 2 + 8 : 0; x < (right ? kColoursWidth : kColoursWidth / 2 - 8); x += 4)
          bright += brightness(image, x, y) > 150 ? 1 : 0;
      EXPECT_GT(bright, 60) << profile << (right ? " right" : " left");
    }
  }
}

}  // namespace
}  // namespace prismesh::kiosk::render
