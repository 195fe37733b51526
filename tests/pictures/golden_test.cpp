// Compares drawn pictures with those kept beside the test. PRISMESH_UPDATE_PICTURES=1 replaces them: check the new ones by eye.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>

#include <GLES3/gl31.h>
#include <gtest/gtest.h>
#include <stb_image.h>

#include "tests/kiosk/render_test.h"
#include "tests/support/places.h"

namespace prismesh::kiosk::render {
namespace {

constexpr int kWidth = 640, kHeight = 360;
constexpr const char* kDrawnWith = "Mesa 22.";  ///< another version may round differently

class GoldenPicture : public RenderTest {
 protected:
  void SetUp() override {
#ifndef NDEBUG
    GTEST_SKIP() << "GOLDEN PICTURES ARE NOT COMPARED: release builds only, as others are too slow";
#endif
    RenderTest::SetUp();
    if (IsSkipped()) return;
    const std::string version = reinterpret_cast<const char*>(glGetString(GL_VERSION));
    const std::string renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    if (version.find(kDrawnWith) == std::string::npos || renderer.find("llvmpipe") == std::string::npos)
      GTEST_SKIP() << "GOLDEN PICTURES ARE NOT COMPARED: they were drawn with " << kDrawnWith << "x llvmpipe, here are \"" << version
                   << "\" and \"" << renderer << '"';
    make_renderer({});
  }

  /// A crash box in the middle of being edited.
  static test::TestSource model() {
    test::TestSource source = test::make_crash_box();
    for (std::size_t n = 23 * 12 + 7; n < 23 * 12 + 16; ++n)
      for (std::size_t row = 0; row < 5; ++row) source.node_marks[n + 23 * row] = mesh::document::kSelected;
    for (std::size_t i = 0; i < 12; ++i) {
      auto& state = source.shell_quality[22 * 3 + 5 + 23 * i];
      state.warn = static_cast<std::uint16_t>(1U << i % 11);
      if (i % 2 == 0) state.fail = state.warn;
    }
    return source;
  }

  /// The selection during a lift, 22 mm up.
  Picture lifted() {
    const test::TestSource source = model();
    show(source);
    Picture picture = fitted("mono", "iso", kWidth, kHeight);
    std::vector<mesh::NodeIndex> nodes;
    ipc::PreviewFrame frame;
    for (std::uint32_t n = 0; n < source.positions.size(); ++n)
      if (source.node_marks[n] != 0) {
        nodes.push_back(mesh::NodeIndex(n));
        frame.positions.push_back(source.positions[n] + mesh::Vec3(0, 0, 22));
      }
    std::vector<mesh::ShellIndex> shells;
    for (std::uint32_t s = 0; s < source.shell_nodes.size(); ++s)
      for (const mesh::NodeIndex node : source.shell_nodes[s].node)
        if (source.node_marks[node.value] != 0) {
          shells.push_back(mesh::ShellIndex(s));
          break;
        }
    frame.states.resize(shells.size());
    for (std::size_t i = 0; i < shells.size(); i += 7) frame.states[i].warn = frame.states[i].fail = 1;
    renderer_->begin_preview(nodes, shells);
    EXPECT_TRUE(renderer_->update_preview(frame));
    picture.handle = Handle{frame.positions[frame.positions.size() / 2], mesh::Vec3::UnitZ(), Handle::Use::arrow};
    return picture;
  }

  void compare(const std::string& name, const Image& image) {
    const std::filesystem::path path = test::source_folder() / "tests/pictures/golden" / (name + ".png");
    if (std::getenv("PRISMESH_UPDATE_PICTURES") != nullptr) {
      const auto written = write_png(path, image);
      ASSERT_TRUE(written) << written.error().text();
      return;
    }
    int width = 0, height = 0, channels = 0;
    const std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> golden(stbi_load(path.c_str(), &width, &height, &channels, 3),
                                                                      &stbi_image_free);
    ASSERT_TRUE(golden) << path << " can't be read";
    ASSERT_EQ(width, image.width);
    ASSERT_EQ(height, image.height);
    std::size_t off = 0;
    double sum = 0;
    for (std::size_t i = 0; i < image.rgb.size(); ++i) {
      const int difference = std::abs(image.rgb[i] - golden.get()[i]);
      sum += difference;
      off += difference > 12;
    }
    const auto values = static_cast<double>(image.rgb.size());
    const bool same = sum / values < 0.2 && static_cast<double>(off) / values < 0.001;
    if (!same) {
      const std::string drawn = testing::TempDir() + "prismesh_" + name + ".png";
      EXPECT_TRUE(write_png(drawn, image));
      ADD_FAILURE() << name << " has changed: " << off << " values are off, " << sum / values << " levels on average; see " << drawn;
    }
  }
};

/// A closer view of the selection's middle.
Picture nearer(Picture picture, const mesh::Vec3& at, double factor) {
  const Eigen::Vector2d seen = stereo::to_screen(picture.view, at).head<2>();
  picture.view = stereo::zoom(stereo::pan(picture.view, -seen), factor, {0, 0});
  return picture;
}

TEST_F(GoldenPicture, every_profile) {
  show(model());
  for (const auto& profile : stereo::built_in_profiles()) {
    std::string name = profile.name;
    std::replace(name.begin(), name.end(), '-', '_');
    compare(name, draw(fitted(profile.name, "iso", kWidth, kHeight), kWidth, kHeight));
  }
}

TEST_F(GoldenPicture, prism_mask_from_the_side) {
  show(model());
  Picture picture = fitted("prism-mask", "iso", kWidth, kHeight);
  picture.between_eyes_mm = {150, 60, 520};
  picture.toward_right = {1, 0.15, 0};
  picture.panel = {401, 300, 1920, 1080};
  picture.rubber_band = PixelRect{420, 40, 600, 130};
  compare("prism_mask_from_the_side", draw(picture, kWidth, kHeight));
}

TEST_F(GoldenPicture, shells_with_their_thickness) {
  test::TestSource source = model();
  source.thickness = {{4, 4}, {2, 2}};
  source.hidden[2] = true;  // which stands before the open end
  show(source);
  Picture picture = fitted("mono", "iso", kWidth, kHeight);
  picture.thickness = true;
  compare("thickness", draw(nearer(picture, {140, -10, 30}, 2.2), kWidth, kHeight));
}

TEST_F(GoldenPicture, crosstalk_compensated) {
  show(model());
  Picture picture = fitted("prism-mask", "iso", kWidth, kHeight);
  picture.profile.crosstalk = {0.1, 0.1};
  compare("crosstalk", draw(picture, kWidth, kHeight));
}

TEST_F(GoldenPicture, anaglyph_from_the_side) {
  show(model());
  Picture picture = fitted("anaglyph", "iso", kWidth, kHeight);
  picture.between_eyes_mm = {120, 60, 550};
  compare("anaglyph_from_the_side", draw(picture, kWidth, kHeight));
}

TEST_F(GoldenPicture, quality) {
  show(model());
  Picture picture = fitted("mono", "iso", kWidth, kHeight);
  picture.colour = ColourMode::quality;
  compare("quality", draw(picture, kWidth, kHeight));
}

/// A shell for each shape of glyph: the front row fails, the back row warns.
test::TestSource bad_shells() {
  using mesh::quality::Metric;
  test::TestSource source;
  struct Bad {
    std::array<mesh::Vec3, 4> corner;
    int bit;
    bool triangle = false;
  };
  const std::array<Bad, 8> kinds{{{{{{0, 0, 0}, {20, 0, 0}, {20, 20, 9}, {0, 20, 0}}}, int(Metric::warpage)},
                                  {{{{0, 0, 0}, {20, 0, 0}, {12, 20, 0}, {8, 20, 0}}}, int(Metric::min_length)},
                                  {{{{0, 0, 0}, {20, 0, 0}, {20, 20, 0}, {0, 16, 0}}}, int(Metric::max_length)},
                                  {{{{0, 0, 0}, {20, 0, 0}, {16, 7, 0}, {16, 7, 0}}}, int(Metric::min_angle_tri), true},
                                  {{{{0, 0, 0}, {20, 0, 0}, {12, 9, 0}, {0, 20, 0}}}, int(Metric::max_angle_quad)},
                                  {{{{0, 7, 0}, {20, 7, 0}, {20, 12, 0}, {0, 12, 0}}}, int(Metric::aspect)},
                                  {{{{0, 0, 0}, {20, 0, 0}, {20, 14, 0}, {0, 20, 0}}}, int(Metric::taper)},
                                  {{{{0, 0, 0}, {14, 0, 0}, {14, 20, 0}, {0, 20, 0}}}, int(mesh::quality::Defect::no_area)}}};
  for (const double row : {0.0, 1.0})
    for (std::size_t i = 0; i < kinds.size(); ++i) {
      std::array<std::uint32_t, 4> nodes{};
      for (std::size_t k = 0; k < 4; ++k)
        nodes[k] = kinds[i].triangle && k == 3
                       ? nodes[2]
                       : source.add_node(kinds[i].corner[k] + mesh::Vec3(26.0 * static_cast<double>(i), 28 * row, 0));
      const std::uint32_t shell = source.add_shell(nodes[0], nodes[1], nodes[2], nodes[3], static_cast<std::uint32_t>(i % 3));
      auto& state = source.shell_quality[shell];
      state.warn = static_cast<std::uint16_t>(1U << kinds[i].bit);
      if (row == 0 || kinds[i].bit >= mesh::quality::kMetricCount) state.fail = state.warn;
    }
  // A fan of triangles beside a quad, for the cluster.
  const std::uint32_t centre = source.add_node({222, 10, 0});
  std::vector<std::uint32_t> rim;
  for (int n = 0; n <= 6; ++n) rim.push_back(source.add_node({222 + 11 * std::cos(0.6 * n), 10 + 11 * std::sin(0.6 * n), 0}));
  for (std::size_t n = 0; n < 6; ++n) {
    const std::uint32_t shell = source.add_shell(centre, rim[n], rim[n + 1], rim[n + 1], 1);
    if (n == 0) source.clusters.push_back({mesh::ShellIndex(shell), 6, 0, 0});
  }
  source.add_shell(centre, rim[6], source.add_node({222 + 4, -4, 0}), rim[0], 1);
  return source;
}

TEST_F(GoldenPicture, glyphs) {
  const test::TestSource source = bad_shells();
  show(source);
  Picture picture = fitted("mono", "top", 2 * kWidth, kHeight);
  compare("glyphs", draw(picture, 2 * kWidth, kHeight));
  picture.view = stereo::orbit(picture.view, 0.3, -0.7);
  picture.marked = mesh::ShellIndex(4);
  compare("glyphs_aslant", draw(picture, 2 * kWidth, kHeight));
  picture.view = stereo::zoom(picture.view, 0.16, {0, 0});
  compare("glyphs_far", draw(picture, kWidth, kHeight));
}

TEST_F(GoldenPicture, parts_by_their_state) {
  show(model());
  Picture picture = fitted("mono", "iso", kWidth, kHeight);
  picture.colour = ColourMode::part_states;
  picture.quality_glyphs = false;
  compare("part_states", draw(picture, kWidth, kHeight));
}

/// Before on the left, after on the right, coloured by the displacement of the nodes.
TEST_F(GoldenPicture, before_and_after_by_displacement) {
  test::TestSource before = model(), after = model();
  std::vector<float> displacement(after.positions.size(), 0);
  for (std::size_t n = 0; n < after.positions.size(); ++n) {
    after.node_marks[n] = before.node_marks[n] = 0;
    const double far = (after.positions[n] - model().positions[23 * 14 + 11]).norm() / 70;
    const double lift = 9 * std::max(0.0, 1 - far * far);
    after.positions[n].z() += lift;
    displacement[n] = n % 23 == 13 ? std::nanf("") : static_cast<float>(lift);  // a new row has no displacement
  }
  show(after);
  ASSERT_TRUE(renderer_->set_field(Pane::model, displacement, true));
  Picture picture = fitted("mono", "iso", kWidth, kHeight);
  picture.colour = ColourMode::field;
  picture.quality_glyphs = false;
  picture.field[0] = {true, 1, 8, ColourMap::crimson, 0};
  compare("field", draw(picture, kWidth, kHeight));
  picture.field[0].map = ColourMap::blues;
  picture.field[0].bands = 6;
  ASSERT_TRUE(renderer_->set_other(std::make_shared<test::TestSource>(before)));
  picture.two_views = TwoViews{true, 0.25};
  picture.view.mm_per_unit *= 0.5;
  compare("two_views", draw(picture, kWidth, kHeight));
  picture.profile = *stereo::find_profile("prism-mask");
  compare("two_views_prism_mask", draw(picture, kWidth, kHeight));
}

TEST_F(GoldenPicture, preview_of_a_split) {
  test::TestSource source = model();
  show(source);
  const mesh::ShellNodes quad = source.shell_nodes[22 * 12 + 11];
  MeshChange change;
  for (const mesh::NodeIndex node : quad.node) change.points.push_back(source.positions[node.value]);
  change.corners = {{0, 1, 2, 2}, {0, 2, 3, 3}};
  change.states.resize(2);
  change.states[1].warn = 1U << static_cast<unsigned>(mesh::quality::Metric::min_angle_tri);
  change.replaced = {mesh::ShellIndex(22 * 12 + 11)};
  ASSERT_TRUE(renderer_->show_change(change));
  compare("split", draw(nearer(fitted("mono", "iso", kWidth, kHeight), change.points[0], 4), kWidth, kHeight));
}

TEST_F(GoldenPicture, lifting) {
  Picture picture = lifted();
  picture.rubber_band = PixelRect{420, 40, 600, 130};
  compare("lifting", draw(picture, kWidth, kHeight));
}

TEST_F(GoldenPicture, shadows) {
  Picture picture = lifted();
  picture.shadows = true;
  compare("shadows", draw(picture, kWidth, kHeight));
  renderer_->end_preview();
  picture.handle.reset();
  compare("shadows_of_the_selection", draw(picture, kWidth, kHeight));
}

TEST_F(GoldenPicture, selected_nodes_behind_something_show_through) {
  test::TestSource source = model();
  for (auto& state : source.shell_quality) state = {};
  const std::size_t plate = 23 * 31;  // the closing plate is below the hat
  for (std::size_t row = 10; row < 20; ++row)
    for (std::size_t n = 4; n < 12; ++n) source.node_marks[plate + 16 * row + n] = mesh::document::kSelected;
  show(source);
  compare("selection", draw(nearer(fitted("mono", "iso", kWidth, kHeight), source.positions[23 * 14 + 11], 1.8), kWidth, kHeight));
}

TEST_F(GoldenPicture, handle) {
  const test::TestSource source = model();
  show(source);
  const mesh::Vec3 foot = source.positions[23 * 14 + 13];
  Picture picture = nearer(fitted("mono", "iso", kWidth, kHeight), foot, 1.8);
  using Use = Handle::Use;
  for (const auto& [use, name] :
       {std::pair{Use::idle, "handle"}, {Use::arrow, "handle_arrow"}, {Use::disk, "handle_disk"}, {Use::ring, "handle_ring"}}) {
    picture.handle = render::Handle{foot, mesh::Vec3(0.1, 0.1, 1).normalized(), use};
    compare(name, draw(picture, kWidth, kHeight));
  }
  picture.handle->use = Use::idle;
  picture.handle->at -= mesh::Vec3(0, 0, 14);
  compare("handle_hidden", draw(picture, kWidth, kHeight));
  picture = nearer(fitted("side-by-side", "iso", kWidth, kHeight), foot, 1.8);
  picture.handle = render::Handle{foot, mesh::Vec3(0.1, 0.1, 1).normalized(), Use::idle};
  compare("handle_side_by_side", draw(picture, kWidth, kHeight));
}

TEST_F(GoldenPicture, rotation) {
  const test::TestSource source = model();
  show(source);
  const mesh::Vec3 grab = source.positions[23 * 14 + 11];
  Picture picture = nearer(fitted("mono", "iso", kWidth, kHeight), grab, 1.5);
  picture.handle = render::Handle{grab, mesh::Vec3::UnitZ(), render::Handle::Use::idle};
  picture.handle->turn = render::Handle::Turn{grab + mesh::Vec3(-45, 0, 12), mesh::Vec3::UnitY(), 0};
  compare("rotation_idle", draw(picture, kWidth, kHeight));
  picture.handle->use = render::Handle::Use::arc;
  picture.handle->turn->degrees = -110;
  picture.handle->at += mesh::Vec3(-30, 0, 50);
  compare("rotation", draw(picture, kWidth, kHeight));
}

TEST_F(GoldenPicture, lasso) {
  show(model());
  Picture picture = fitted("prism-mask", "iso", kWidth, kHeight);
  for (int i = 0; i < 60; ++i) {
    const double angle = 0.1 * i, reach = 90 + 25 * std::sin(3 * angle);
    picture.lasso.emplace_back(300 + 1.6 * reach * std::cos(angle), 150 + reach * std::sin(angle));
  }
  compare("lasso_prism_mask", draw(picture, kWidth, kHeight));
  picture.profile = *stereo::find_profile("mono");
  compare("lasso", draw(picture, kWidth, kHeight));
}

}  // namespace
}  // namespace prismesh::kiosk::render
