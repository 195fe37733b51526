// Pictures kept beside the test, compared with what is drawn today. PRISMESH_UPDATE_PICTURES=1 draws them anew: look at them then.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>

#include <GLES3/gl31.h>
#include <gtest/gtest.h>
#include <stb_image.h>

#include "tests/kiosk/render_test.h"

namespace prismesh::kiosk::render {
namespace {

constexpr int kWidth = 640, kHeight = 360;
constexpr const char* kDrawnWith = "Mesa 22.";  ///< another version may round otherwise

class GoldenPicture : public RenderTest {
 protected:
  void SetUp() override {
#ifndef NDEBUG
    GTEST_SKIP() << "GOLDEN PICTURES ARE NOT COMPARED: release builds only, software rendering crawls in others";
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

  /// The selection on its way, 22 mm up.
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
    const std::filesystem::path path = std::filesystem::path(PRISMESH_SOURCE_FOLDER) / "tests/pictures/golden" / (name + ".png");
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

TEST_F(GoldenPicture, EveryProfile) {
  show(model());
  for (const auto& profile : stereo::built_in_profiles()) {
    std::string name = profile.name;
    std::replace(name.begin(), name.end(), '-', '_');
    compare(name, draw(fitted(profile.name, "iso", kWidth, kHeight), kWidth, kHeight));
  }
}

TEST_F(GoldenPicture, PrismMaskFromTheSide) {
  show(model());
  Picture picture = fitted("prism-mask", "iso", kWidth, kHeight);
  picture.between_eyes_mm = {150, 60, 520};
  picture.toward_right = {1, 0.15, 0};
  picture.panel = {401, 300, 1920, 1080};
  picture.rubber_band = PixelRect{420, 40, 600, 130};
  compare("prism_mask_from_the_side", draw(picture, kWidth, kHeight));
}

TEST_F(GoldenPicture, CrosstalkTakenOut) {
  show(model());
  Picture picture = fitted("prism-mask", "iso", kWidth, kHeight);
  picture.profile.crosstalk = {0.1, 0.1};
  compare("crosstalk", draw(picture, kWidth, kHeight));
}

TEST_F(GoldenPicture, AnaglyphFromTheSide) {
  show(model());
  Picture picture = fitted("anaglyph", "iso", kWidth, kHeight);
  picture.between_eyes_mm = {120, 60, 550};
  compare("anaglyph_from_the_side", draw(picture, kWidth, kHeight));
}

TEST_F(GoldenPicture, Quality) {
  show(model());
  Picture picture = fitted("mono", "iso", kWidth, kHeight);
  picture.colour = ColourMode::quality;
  compare("quality", draw(picture, kWidth, kHeight));
}

TEST_F(GoldenPicture, Lifting) {
  Picture picture = lifted();
  picture.rubber_band = PixelRect{420, 40, 600, 130};
  compare("lifting", draw(picture, kWidth, kHeight));
}

TEST_F(GoldenPicture, Shadows) {
  Picture picture = lifted();
  picture.shadows = true;
  compare("shadows", draw(picture, kWidth, kHeight));
  renderer_->end_preview();
  picture.handle.reset();
  compare("shadows_of_the_selection", draw(picture, kWidth, kHeight));
}

/// The middle of the selection, nearer.
Picture nearer(Picture picture, const mesh::Vec3& at, double factor) {
  const Eigen::Vector2d seen = stereo::to_screen(picture.view, at).head<2>();
  picture.view = stereo::zoom(stereo::pan(picture.view, -seen), factor, {0, 0});
  return picture;
}

TEST_F(GoldenPicture, SelectedNodesBehindSomethingShowThrough) {
  test::TestSource source = model();
  for (auto& state : source.shell_quality) state = {};
  const std::size_t plate = 23 * 31;  // the closing plate lies under the hat
  for (std::size_t row = 10; row < 20; ++row)
    for (std::size_t n = 4; n < 12; ++n) source.node_marks[plate + 16 * row + n] = mesh::document::kSelected;
  show(source);
  compare("selection", draw(nearer(fitted("mono", "iso", kWidth, kHeight), source.positions[23 * 14 + 11], 1.8), kWidth, kHeight));
}

TEST_F(GoldenPicture, Handle) {
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

TEST_F(GoldenPicture, Rotation) {
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

TEST_F(GoldenPicture, Lasso) {
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
