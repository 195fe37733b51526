// Models that nobody should have: very many parts, coordinates far from zero, slivers, points, numbers that are none. What can be drawn is.
#include <algorithm>
#include <cmath>
#include <limits>

#include "kiosk/render/make_levels.h"
#include "tests/kiosk/render_test.h"

namespace prismesh::kiosk::render {
namespace {

constexpr int kBadWidth = 400, kBadHeight = 300;

class RenderBadInput : public RenderTest {
 protected:
  Image moving_picture(Picture picture) {
    picture.moving = true;
    picture.view = stereo::orbit(picture.view, 1e-9, 0);
    return draw(picture, kBadWidth, kBadHeight);
  }
  static std::size_t pixels_apart(const Image& a, const Image& b, int by) {
    std::size_t apart = 0;
    for (int y = 0; y < kBadHeight; ++y)
      for (int x = 0; x < kBadWidth; ++x) apart += std::abs(brightness(a, x, y) - brightness(b, x, y)) > by ? 1 : 0;
    return apart;
  }
  static Eigen::Vector2d pixel_of(const stereo::Aim& aim, const mesh::Vec3& at) {
    const Eigen::Vector4d clip = aim.clip_from_deck() * at.homogeneous();
    return {(0.5 + 0.5 * clip.x() / clip.w()) * kBadWidth, (0.5 - 0.5 * clip.y() / clip.w()) * kBadHeight};
  }
};

TEST_F(RenderBadInput, of_20000_parts_shows_and_picks_each) {
  constexpr std::uint32_t kSide = 142;
  test::TestSource source;
  for (std::uint32_t part = 0; part < kSide * kSide; ++part) {
    const mesh::Vec3 corner(part % kSide, part / kSide, 0);
    std::array<std::uint32_t, 4> node;
    for (std::size_t k = 0; k < 4; ++k) node[k] = source.add_node(corner + mesh::Vec3(k == 1 || k == 2 ? 0.9 : 0, k > 1 ? 0.9 : 0, 0));
    source.add_shell(node[0], node[1], node[2], node[3], part);
  }
  show(source);
  const Picture picture = fitted("mono", "top", kBadWidth, kBadHeight);
  const Image whole = draw(picture, kBadWidth, kBadHeight);
  const stereo::Aim aim = aim_of(picture, kBadWidth, kBadHeight);
  std::size_t wrong = 0, looked = 0;
  for (std::uint32_t part = 0; part < kSide * kSide; part += 37) {
    const mesh::Vec3 middle(part % kSide + 0.45, part / kSide + 0.45, 0);
    ++looked;
    if (renderer_->shell_at(aim, pixel_of(aim, middle)) != mesh::ShellIndex(std::size_t{part})) ++wrong;
  }
  EXPECT_GT(looked, 500u);
  EXPECT_EQ(wrong, 0u);
  ASSERT_TRUE(renderer_->set_levels(make_levels(source).value()));
  EXPECT_LT(pixels_apart(whole, moving_picture(picture), 40), std::size_t{kBadWidth * kBadHeight / 50});
  for (std::size_t part = 0; part < source.hidden.size(); ++part) source.hidden[part] = part % 2 == 0;
  show(source);
  draw(picture, kBadWidth, kBadHeight);
  for (const std::uint32_t part : {5'000U, 5'001U})
    EXPECT_EQ(renderer_->shell_at(aim, pixel_of(aim, {part % kSide + 0.45, part / kSide + 0.45, 0})).has_value(), part % 2 == 1);
}

TEST_F(RenderBadInput, a_thousandth_at_ten_millions_is_drawn_as_at_zero) {
  const auto sheet = [](const mesh::Vec3& away) {
    test::TestSource source;
    // The type is said: a sum of Eigen's refers to its terms, which end with the return.
    test::add_grid(source, 150, 150, 0, [&](double u, double v) -> mesh::Vec3 {
      return away + mesh::Vec3(0.15 * u, 0.15 * v, 0.01 * std::sin(9 * u) * std::cos(8 * v));
    });
    return source;
  };
  const test::TestSource near = sheet(mesh::Vec3::Zero()), far = sheet(mesh::Vec3(1e7, -1e7, 1e7));
  show(near);
  const Image expected = draw(fitted("mono", "iso", kBadWidth, kBadHeight), kBadWidth, kBadHeight);
  make_renderer({.samples = 1});
  show(far);
  const Picture picture = fitted("mono", "iso", kBadWidth, kBadHeight);
  const Image at_rest = draw(picture, kBadWidth, kBadHeight);
  EXPECT_LT(pixels_apart(expected, at_rest, 24), 400u);
  ASSERT_TRUE(renderer_->set_levels(make_levels(far).value()));
  EXPECT_LT(pixels_apart(at_rest, moving_picture(picture), 40), 1200u);
}

TEST_F(RenderBadInput, a_node_far_out_takes_no_precision_from_the_others) {
  test::TestSource source;
  test::add_grid(source, 60, 60, 0, [](double u, double v) { return mesh::Vec3(6 * u, 5 * v, std::sin(9 * u) * std::cos(8 * v)); });
  show(source);
  const Picture picture = fitted("mono", "iso", kBadWidth, kBadHeight);
  const Image alone = draw(picture, kBadWidth, kBadHeight);
  source.add_node(mesh::Vec3(0, 1e12, 0));
  source.key = 2;
  show(source);
  EXPECT_LT(pixels_apart(alone, draw(picture, kBadWidth, kBadHeight), 24), 200u);
}

TEST_F(RenderBadInput, slivers_points_and_numbers_that_are_none_change_nothing_else) {
  test::TestSource source;
  test::add_grid(source, 150, 150, 0,
                 [](double u, double v) { return mesh::Vec3(600 * u, 500 * v, 40 * std::sin(9 * u) * std::cos(8 * v)); });
  show(source);
  const Picture picture = fitted("mono", "iso", kBadWidth, kBadHeight);
  const Image good = draw(picture, kBadWidth, kBadHeight);
  const double nan = std::numeric_limits<double>::quiet_NaN(), huge = 1e300;
  const auto far = static_cast<std::uint32_t>(source.shell_nodes.size());
  for (const mesh::Vec3& at : {mesh::Vec3(nan, 0, 0), mesh::Vec3(0, huge, 0), mesh::Vec3(0, 0, -std::numeric_limits<double>::infinity())}) {
    const std::uint32_t bad = source.add_node(at);
    for (std::uint32_t k = 0; k < 200; ++k) source.add_shell(bad, 151 * k % 20'000, 151 * k % 20'000 + 1, bad, 0);
  }
  for (std::uint32_t k = 0; k < 2'000; ++k) {
    source.add_shell(k, k, k, k, 0);                          // a point
    source.add_shell(7 * k, 7 * k + 1, 7 * k + 1, 7 * k, 0);  // a line along an edge
    source.add_shell(0, 1, 0xfffffff0U, 2, 0);                // a node that isn't there
  }
  source.key = 2;
  show(source);
  EXPECT_TRUE(renderer_->bounds().low.allFinite() && renderer_->bounds().high.allFinite());
  EXPECT_NEAR(renderer_->bounds().high.x(), 600, 1e-3);
  EXPECT_NEAR(renderer_->bounds().high.y(), 500, 1e-3);
  Picture bare = picture;
  bare.outlines = false;
  const Image with_bad = draw(bare, kBadWidth, kBadHeight);
  make_renderer({.samples = 1});
  test::TestSource clean = source;
  for (std::size_t s = far; s < clean.shell_nodes.size(); ++s) clean.shell_nodes[s] = mesh::ShellNodes{};
  show(clean);
  EXPECT_EQ(pixels_apart(draw(bare, kBadWidth, kBadHeight), with_bad, 0), 0u);
  EXPECT_LT(pixels_apart(good, with_bad, 60), 2'000u) << "but for the outlines";
  show(source);
  ASSERT_TRUE(renderer_->set_levels(make_levels(source).value()));
  EXPECT_LT(pixels_apart(with_bad, moving_picture(bare), 40), 1'200u);
}

}  // namespace
}  // namespace prismesh::kiosk::render
