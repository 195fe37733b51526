// Fixture for tests of pictures: an OpenGL context, a renderer, views and pixels.
#pragma once

#include <cstdlib>
#include <iostream>
#include <memory>
#include <optional>

#include <gtest/gtest.h>

#include "kiosk/display/headless.h"
#include "kiosk/render/offscreen.h"
#include "kiosk/render/renderer.h"
#include "tests/kiosk/test_source.h"

namespace prismesh::kiosk::render {

class RenderTest : public testing::Test {
 protected:
  void SetUp() override {
    Result<display::Headless> made = display::Headless::create();
    if (!made) GTEST_SKIP() << "PICTURES ARE NOT TESTED: " << made.error().text();
    headless_.emplace(std::move(*made));
    make_renderer({.samples = 1});
  }
  void TearDown() override {
    renderer_.reset();
    headless_.reset();
  }

  void make_renderer(const RendererOptions& options) {
    renderer_.reset();
    auto made = Renderer::create(options);
    ASSERT_TRUE(made) << made.error().text();
    renderer_ = std::move(*made);
  }
  void show(const std::shared_ptr<test::TestSource>& source) {
    const auto shown = renderer_->set_model(source);
    ASSERT_TRUE(shown) << shown.error().text();
  }
  /// Shows a copy, as each snapshot of a document is a new object.
  void show(const test::TestSource& source) { show(std::make_shared<test::TestSource>(source)); }

  Picture fitted(const std::string& profile, const std::string& view, int width, int height) const {
    Picture picture;
    picture.profile = *stereo::find_profile(profile);
    picture.view.rotation = *stereo::named_rotation(view);
    picture.view.bounds = stereo::sphere_around(renderer_->bounds());
    picture.view = renderer_->fitted(picture.view, stereo::screen_size_mm(picture.profile, width, height));
    return picture;
  }
  stereo::Aim aim_of(const Picture& picture, int width, int height) const { return aim_for(picture, width, height); }
  Image draw(const Picture& picture, int width, int height) {
    auto offscreen = Offscreen::create(width, height);
    EXPECT_TRUE(offscreen);
    const auto report = renderer_->draw(picture, offscreen->framebuffer(), width, height);
    EXPECT_TRUE(report) << report.error().text();
    if (report) report_ = *report;
    return offscreen->read();
  }

  std::optional<display::Headless> headless_;
  std::unique_ptr<Renderer> renderer_;
  DrawReport report_;
};

inline int brightness(const Image& image, int x, int y) {
  const std::uint8_t* at = image.at(x, y);
  return (at[0] + at[1] + at[2]) / 3;
}

}  // namespace prismesh::kiosk::render
