// Thin lines of all slopes as one eye sees them: drawn at half width they stay whole, with a stencil they break.
#include <array>
#include <cmath>
#include <iostream>
#include <numbers>
#include <random>

#include "tests/optics/optics_fixture.h"
#include "tests/optics/thin_line.h"

namespace prismesh::optics {
namespace {

constexpr int kLines = 900;
constexpr double kInkLevels =
    60;  ///< far below a white line, far above the light that a window at the edge of its column gets from the next one
constexpr std::array<double, 7> kSlopes{0, 15, 45, 60, 75, 85, 90};  ///< degrees: limits of the table's columns

class ThinLines : public OpticsTest {
 protected:
  void SetUp() override {
    OpticsTest::SetUp();
    if (IsSkipped()) return;
    for (const bool left : {true, false}) {
      const viewer::Eyes eyes = viewer::eyes_around({0, 0, 650});
      const auto view = viewer::Viewpoint::at(display_, left ? eyes.left : eyes.right, 0);
      ASSERT_TRUE(view);
      views_.push_back(*view);
    }
  }

  struct Table {
    std::array<double, 6> lines{}, pieces{}, broken{};
    double worst = 0;
    double mean(std::size_t column) const { return pieces[column] / lines[column]; }
  };
  /// The number of pieces in which each of the 900 lines is seen, by slope; both eyes count.
  Table look_at_lines(const std::string& profile) {
    const ThinLine line;
    const std::array<int, 2> size{display_.panel.columns, display_.panel.rows};
    Picture picture = at_head(profile, {0, 0, 650});
    std::mt19937 random(1);
    std::uniform_real_distribution<double> aside(-4, 4);
    const viewer::LightImage dark(size[0], size[1]);
    Table table;
    for (int i = 0; i < kLines; ++i) {
      const double degrees = (i + 0.5) * 90 / kLines;
      const std::array<double, 2> middle{aside(random), aside(random)};
      picture.overlay = [&](const EyeImage&) { line.draw(degrees, middle, size); };
      const viewer::LightImage drawn = woven(picture, display_.panel);
      std::size_t column = 0;
      while (degrees >= kSlopes[column + 1]) ++column;
      for (const viewer::Viewpoint& view : views_) {
        const int pieces = viewer::pieces_in(*view.look(drawn), *view.look(dark), kInkLevels);
        table.lines[column] += 1;
        table.pieces[column] += pieces;
        table.broken[column] += pieces != 1;
        table.worst = std::max(table.worst, static_cast<double>(pieces));
      }
    }
    print(profile, table);
    return table;
  }
  static void print(const std::string& profile, const Table& table) {
    std::cout << profile << ", mean pieces of one line as one eye sees it (share broken):";
    for (std::size_t i = 0; i < table.lines.size(); ++i)
      std::cout << "  " << kSlopes[i] << "-" << kSlopes[i + 1] << "°: " << std::round(10 * table.mean(i)) / 10 << " ("
                << std::round(100 * table.broken[i] / table.lines[i]) << " %)";
    std::cout << "; worst " << table.worst << "\n";
  }

  viewer::MaskDisplay display_ = OpticsTest::display(236, 216);
  std::vector<viewer::Viewpoint> views_;
};

TEST_F(ThinLines, stay_whole_at_half_width) {
  const Table table = look_at_lines("prism-mask");
  for (std::size_t i = 0; i < table.lines.size(); ++i) EXPECT_EQ(table.broken[i], 0) << kSlopes[i] << " degrees";
}

TEST_F(ThinLines, break_under_a_stencil) {
  const Table table = look_at_lines("prism-mask-stencil");
  // Known for lines of this length: 1, 23, 61, 38, 18 and 4.9 pieces.
  EXPECT_NEAR(table.mean(1), 23, 8);
  EXPECT_NEAR(table.mean(2), 61, 15);
  EXPECT_NEAR(table.mean(3), 38, 10);
  EXPECT_NEAR(table.mean(4), 18, 6);
  EXPECT_NEAR(table.mean(5), 4.9, 2);
}

TEST_F(ThinLines, a_beam_stays_whole_with_and_without_multisampling) {
  for (const int samples : {1, 4}) {
    make_renderer({.samples = samples});
    const Picture picture = at_head("prism-mask", {0, 0, 650});
    const viewer::LightImage ground = woven(picture, display_.panel);
    for (int degrees = 1; degrees < 180; degrees += 6) {
      const double angle = degrees * std::numbers::pi / 180;
      test::TestSource source;
      const mesh::Vec3 along(28 * std::cos(angle), 28 * std::sin(angle), 0), middle(0.13, 0.07, 0);
      source.add_line(source.add_node(middle - along), source.add_node(middle + along), 0);
      source.key = static_cast<std::uint64_t>(degrees);
      show(source);
      const viewer::LightImage drawn = woven(picture, display_.panel);
      for (const viewer::Viewpoint& view : views_) EXPECT_EQ(viewer::pieces_in(*view.look(drawn), *view.look(ground)), 1) << degrees;
    }
  }
}

}  // namespace
}  // namespace prismesh::optics
