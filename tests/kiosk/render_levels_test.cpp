// Moving pictures with levels of detail: near the picture at rest; picking and pictures at rest don't change.
#include <algorithm>
#include <cmath>

#include "kiosk/levels_worker.h"
#include "kiosk/render/make_levels.h"
#include "tests/kiosk/render_test.h"

namespace prismesh::kiosk::render {
namespace {

constexpr int kLevelsWidth = 400, kLevelsHeight = 300;

/// Two waved sheets, one in front of the other.
test::TestSource waves(std::uint32_t side = 150) {
  test::TestSource source;
  test::add_grid(source, side, side, 0,
                 [](double u, double v) { return mesh::Vec3(600 * u, 500 * v, 40 * std::sin(9 * u) * std::cos(8 * v)); });
  test::add_grid(source, side / 2, side / 2, 1,
                 [](double u, double v) { return mesh::Vec3(150 + 300 * u, 100 + 250 * v, 150 + 60 * u * v); });
  return source;
}

class RenderLevels : public RenderTest {
 protected:
  Picture of(const test::TestSource& source) {
    show(source);
    Picture picture = fitted("mono", "iso", kLevelsWidth, kLevelsHeight);
    picture.outlines = picture.element_edges = false;
    return picture;
  }
  void set_levels(const test::TestSource& source) { ASSERT_TRUE(renderer_->set_levels(make_levels(source).value())); }
  /// The renderer keeps a scene that is at rest, so the next picture is drawn anew from another side and back.
  Image moving(Picture picture) {
    const stereo::View view = picture.view;
    picture.moving = true;
    picture.view = stereo::orbit(view, 0.3, 0);
    draw(picture, kLevelsWidth, kLevelsHeight);
    picture.view = view;
    picture.view = stereo::orbit(view, 1e-9, 0);
    return draw(picture, kLevelsWidth, kLevelsHeight);
  }
  static bool is_ground(const Image& image, const Image& ground, int x, int y) {
    return std::equal(image.at(x, y), image.at(x, y) + 3, ground.at(x, y), [](int a, int b) { return std::abs(a - b) <= 2; });
  }
  Image ground() {
    auto empty = Renderer::create({.samples = 1});
    Picture picture;
    picture.profile = *stereo::find_profile("mono");
    auto offscreen = Offscreen::create(kLevelsWidth, kLevelsHeight);
    EXPECT_TRUE((*empty)->draw(picture, offscreen->framebuffer(), kLevelsWidth, kLevelsHeight));
    return offscreen->read();
  }
};

TEST_F(RenderLevels, at_rest_change_no_pixel) {
  const test::TestSource source = waves();
  Picture picture = of(source);
  picture.outlines = picture.element_edges = true;
  const Image before = draw(picture, kLevelsWidth, kLevelsHeight);
  set_levels(source);
  show(source);
  const Image after = draw(picture, kLevelsWidth, kLevelsHeight);
  EXPECT_EQ(before.rgb, after.rgb);
}

TEST_F(RenderLevels, in_motion_keep_the_outline_to_two_pixels) {
  const test::TestSource source = waves();
  const Picture picture = of(source);
  const Image whole = draw(picture, kLevelsWidth, kLevelsHeight);
  set_levels(source);
  const Image coarse = moving(picture);
  const Renderer::Figures figures = renderer_->figures();
  EXPECT_GT(figures.moving_triangles, 0u);
  EXPECT_LT(figures.moving_triangles, source.shell_nodes.size() / 4) << "few triangles";
  EXPECT_LE(figures.moving_pixels, 2);
  const Image behind = ground();
  std::size_t beyond = 0, model = 0, apart = 0;
  for (int y = 3; y < kLevelsHeight - 3; ++y)
    for (int x = 3; x < kLevelsWidth - 3; ++x) {
      const bool here = !is_ground(coarse, behind, x, y), there = !is_ground(whole, behind, x, y);
      model += there ? 1 : 0;
      if (here && there) {
        apart += std::abs(brightness(coarse, x, y) - brightness(whole, x, y)) > 40 ? 1 : 0;
        continue;
      }
      if (here == there) continue;
      bool near = false;  // the outline of the whole picture is within two pixels
      for (int dy = -2; dy <= 2 && !near; ++dy)
        for (int dx = -2; dx <= 2 && !near; ++dx) near = !is_ground(whole, behind, x + dx, y + dy) == here;
      beyond += near ? 0 : 1;
    }
  EXPECT_GT(model, 20'000u);
  EXPECT_EQ(beyond, 0u);
  EXPECT_LT(apart, model / 50) << "the shading is that of the shells";
}

TEST_F(RenderLevels, dont_change_what_is_picked) {
  const test::TestSource source = waves();
  const Picture picture = of(source);
  const stereo::Aim aim = aim_of(picture, kLevelsWidth, kLevelsHeight);
  std::vector<std::optional<mesh::ShellIndex>> before;
  for (int y = 10; y < kLevelsHeight; y += 23)
    for (int x = 10; x < kLevelsWidth; x += 29) before.push_back(renderer_->shell_at(aim, {x, y}));
  set_levels(source);
  moving(picture);
  show(source);
  std::size_t at = 0;
  for (int y = 10; y < kLevelsHeight; y += 23)
    for (int x = 10; x < kLevelsWidth; x += 29) EXPECT_EQ(renderer_->shell_at(aim, {x, y}), before[at++]) << x << "," << y;
}

TEST_F(RenderLevels, show_moved_nodes_where_they_are) {
  test::TestSource source = waves();
  of(source);
  set_levels(source);
  EXPECT_TRUE(renderer_->levels_are_current());
  // A spike of one node, which coarse triangles wouldn't have.
  const std::size_t node = 75 * 151 + 75;
  source.positions[node].z() += 200;
  source.touch(ipc::SnapshotArray::positions, node / mesh::kChunkSize);
  const Picture picture = of(source);
  EXPECT_FALSE(renderer_->levels_are_current());
  const Image whole = draw(picture, kLevelsWidth, kLevelsHeight), coarse = moving(picture);
  const stereo::Aim aim = aim_of(picture, kLevelsWidth, kLevelsHeight);
  const Eigen::Vector4d clip = aim.clip_from_deck() * (source.positions[node] - mesh::Vec3(0, 0, 30)).homogeneous();
  const int x = static_cast<int>((0.5 + 0.5 * clip.x() / clip.w()) * kLevelsWidth),
            y = static_cast<int>((0.5 - 0.5 * clip.y() / clip.w()) * kLevelsHeight);
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) EXPECT_NEAR(brightness(coarse, x + dx, y + dy), brightness(whole, x + dx, y + dy), 6);
}

/// Zoomed in, depth is compressed much: places in the deck say little about how large things are seen.
TEST_F(RenderLevels, show_element_edges_in_motion_where_they_are_seen_at_rest) {
  const test::TestSource source = waves();
  Picture picture = of(source);
  set_levels(source);
  picture.element_edges = true;
  picture.view = stereo::zoom(picture.view, 12, {0, 0});
  const Image coarse = moving(picture);
  const Image whole = draw(picture, kLevelsWidth, kLevelsHeight);
  picture.element_edges = false;
  const Image plain = draw(picture, kLevelsWidth, kLevelsHeight);
  std::size_t edges = 0, differ = 0;
  for (int y = 0; y < kLevelsHeight; ++y)
    for (int x = 0; x < kLevelsWidth; ++x) {
      edges += std::abs(brightness(plain, x, y) - brightness(whole, x, y)) > 16 ? 1 : 0;
      differ += std::abs(brightness(coarse, x, y) - brightness(whole, x, y)) > 16 ? 1 : 0;
    }
  EXPECT_GT(edges, 2000u);
  EXPECT_LT(differ, 300u);
}

TEST_F(RenderLevels, see_small_moves_far_from_zero) {
  test::TestSource source = waves();
  for (mesh::Vec3& at : source.positions) at += mesh::Vec3::Constant(1e7);
  of(source);
  set_levels(source);
  EXPECT_TRUE(renderer_->levels_are_current());
  source.positions[77].z() += 2e-3;
  source.touch(ipc::SnapshotArray::positions, 0);
  const Picture picture = of(source);
  EXPECT_FALSE(renderer_->levels_are_current());
  const Image whole = draw(picture, kLevelsWidth, kLevelsHeight), coarse = moving(picture);
  std::size_t differ = 0;
  for (int y = 0; y < kLevelsHeight; ++y)
    for (int x = 0; x < kLevelsWidth; ++x) differ += std::abs(brightness(coarse, x, y) - brightness(whole, x, y)) > 40 ? 1 : 0;
  EXPECT_LT(differ, 600u);
}

TEST_F(RenderLevels, of_other_shells_arent_used) {
  test::TestSource source = waves();
  of(source);
  test::TestSource other = source;
  other.shell_nodes.pop_back();
  other.shell_parts.pop_back();
  set_levels(other);
  EXPECT_FALSE(renderer_->levels_are_current());
  set_levels(source);
  EXPECT_TRUE(renderer_->levels_are_current());
  source.shell_nodes[7] = source.shell_nodes[8];
  source.touch(ipc::SnapshotArray::shell_nodes, 0);
  const Picture picture = of(source);
  EXPECT_FALSE(renderer_->levels_are_current()) << "they are dropped";
  moving(picture);
}

TEST_F(RenderLevels, dont_show_hidden_parts) {
  test::TestSource source = waves();
  of(source);
  set_levels(source);
  source.hidden[0] = true;
  const Picture picture = of(source);
  const Image whole = draw(picture, kLevelsWidth, kLevelsHeight), coarse = moving(picture);
  std::size_t differ = 0;
  for (int y = 0; y < kLevelsHeight; ++y)
    for (int x = 0; x < kLevelsWidth; ++x) differ += std::abs(brightness(whole, x, y) - brightness(coarse, x, y)) > 40 ? 1 : 0;
  EXPECT_LT(differ, 300u);
}

TEST_F(RenderLevels, hold_selected_shells_apart) {
  test::TestSource source = waves();
  Picture picture = of(source);
  const Image plain = draw(picture, kLevelsWidth, kLevelsHeight);
  set_levels(source);
  for (std::size_t row = 20; row < 40; ++row)
    for (std::size_t column = 100; column < 120; ++column) source.shell_marks[150 * row + column] = mesh::document::kSelected;
  for (std::size_t chunk = 0; chunk < 2; ++chunk) source.touch(ipc::SnapshotArray::shell_marks, chunk);
  picture = of(source);
  const Image whole = draw(picture, kLevelsWidth, kLevelsHeight), coarse = moving(picture);
  std::size_t selected = 0, same = 0;
  for (int y = 0; y < kLevelsHeight; ++y)
    for (int x = 0; x < kLevelsWidth; ++x) {
      if (brightness(whole, x, y) - brightness(plain, x, y) < 30) continue;
      ++selected;
      same += std::abs(brightness(coarse, x, y) - brightness(whole, x, y)) <= 6 ? 1 : 0;
    }
  EXPECT_GT(selected, 200u);
  EXPECT_GT(same, selected - selected / 20);
}

/// A scene with all that is drawn: transparent parts, glyphs, selected nodes, a marked shell, a cut, shadows, a handle and two views.
class RenderPieces : public RenderLevels {
 protected:
  static test::TestSource full_source() {
    test::TestSource source = waves();
    mesh::quality::ShellState warns;
    warns.warn = 1;
    for (std::size_t s = 0; s < source.shell_nodes.size(); s += 17) source.shell_quality[s] = warns;
    for (std::size_t n = 5000; n < 9000; ++n) source.node_marks[n] = mesh::document::kSelected;
    for (std::size_t s = 900; s < 1300; ++s) source.shell_marks[s] = mesh::document::kSelected;
    return source;
  }
  Picture full_picture(const test::TestSource& source, const std::string& profile) {
    make_renderer({.samples = 4});
    show(source);
    EXPECT_TRUE(renderer_->set_other(std::make_shared<test::TestSource>(source)));
    EXPECT_TRUE(renderer_->set_part_paints(std::vector<PartPaint>{{}, {.transparent = true}}));
    Picture picture = fitted(profile, "iso", kLevelsWidth, kLevelsHeight);
    picture.marked = mesh::ShellIndex(std::size_t{77});
    picture.shadows = true;
    picture.handle = Handle{mesh::Vec3(300, 250, 0), mesh::Vec3::UnitZ()};
    picture.two_views.emplace();
    return picture;
  }
  /// Moves on by 10 ms at each look.
  class TickingClock final : public Clock {
   public:
    std::int64_t now_ns() override { return now_ += 10'000'000; }

   private:
    std::int64_t now_ = 0;
  };
  /// Draws the scene at rest. Returns the number of pieces.
  std::size_t draw_in_pieces(const Picture& picture, std::int64_t budget_ns, std::size_t max = 1000) {
    TickingClock clock;
    for (std::size_t pieces = 1; pieces <= max; ++pieces) {
      const Result<bool> whole = renderer_->draw_piece(picture, kLevelsWidth, kLevelsHeight, clock, budget_ns);
      EXPECT_TRUE(whole) << whole.error().text();
      if (!whole || *whole) return pieces;
    }
    return 0;
  }
};

TEST_F(RenderPieces, make_the_same_picture_as_one_go) {
  const test::TestSource source = full_source();
  for (const char* profile : {"mono", "side-by-side"}) {
    const Picture picture = full_picture(source, profile);
    const Image one_go = draw(picture, kLevelsWidth, kLevelsHeight);
    full_picture(source, profile);
    const std::size_t pieces = draw_in_pieces(picture, 1'000'000);
    EXPECT_GT(pieces, 20u);
    EXPECT_EQ(renderer_->figures().pieces_drawn, pieces);
    const std::size_t scenes = renderer_->figures().scenes_drawn;
    const Image in_pieces = draw(picture, kLevelsWidth, kLevelsHeight);
    EXPECT_EQ(renderer_->figures().scenes_drawn, scenes) << "the picture shows the pieces";
    EXPECT_EQ(one_go.rgb, in_pieces.rgb) << profile;
  }
}

TEST_F(RenderPieces, are_few_where_there_is_time) {
  const test::TestSource source = full_source();
  EXPECT_EQ(draw_in_pieces(full_picture(source, "mono"), 1'000'000'000'000), 1u);
}

TEST_F(RenderPieces, are_given_up_for_another_picture_model_or_levels) {
  test::TestSource source = full_source();
  Picture picture = full_picture(source, "mono");
  const stereo::View before = picture.view;
  picture.view = stereo::orbit(before, 0.4, 0);
  const Image expected = draw(picture, kLevelsWidth, kLevelsHeight);
  picture.view = before;
  EXPECT_EQ(draw_in_pieces(picture, 1'000'000, 5), 0u);
  picture.view = stereo::orbit(before, 0.4, 0);
  full_picture(source, "mono");
  EXPECT_EQ(draw_in_pieces(picture, 1'000'000, 5), 0u);
  set_levels(source);  // another order of shells
  EXPECT_EQ(draw_in_pieces(picture, 1'000'000, 5), 0u);
  Picture beside = picture;
  beside.moving = true;
  beside.view = stereo::orbit(before, 0.9, 0.3);
  draw(beside, kLevelsWidth, kLevelsHeight);  // its shadows lie otherwise
  EXPECT_GT(draw_in_pieces(picture, 1'000'000), 20u);
  EXPECT_EQ(draw(picture, kLevelsWidth, kLevelsHeight).rgb, expected.rgb);
  // Half of the pieces show the model before a node moved.
  picture.two_views.reset();
  EXPECT_TRUE(renderer_->set_part_paints({}));
  EXPECT_EQ(draw_in_pieces(picture, 1'000'000, 5), 0u);
  source.positions[75 * 151 + 75].z() += 200;
  source.touch(ipc::SnapshotArray::positions, (75 * 151 + 75) / mesh::kChunkSize);
  show(source);
  draw_in_pieces(picture, 1'000'000);
  const Image moved = draw(picture, kLevelsWidth, kLevelsHeight);
  beside.moving = false;
  draw(beside, kLevelsWidth, kLevelsHeight);
  EXPECT_EQ(moved.rgb, draw(picture, kLevelsWidth, kLevelsHeight).rgb);
}

TEST_F(RenderPieces, leave_what_is_shown_until_they_are_whole) {
  const test::TestSource source = full_source();
  Picture picture = full_picture(source, "mono");
  picture.two_views.reset();
  const Image first = draw(picture, kLevelsWidth, kLevelsHeight);
  Picture turned = picture;
  turned.view = stereo::orbit(picture.view, 0.4, 0);
  EXPECT_EQ(draw_in_pieces(turned, 1'000'000, 5), 0u);
  turned.waiting = true;
  EXPECT_EQ(draw(turned, kLevelsWidth, kLevelsHeight).rgb, first.rgb) << "without levels the last scene stays";
  set_levels(source);
  const Image coarse = draw(turned, kLevelsWidth, kLevelsHeight);
  EXPECT_NE(coarse.rgb, first.rgb) << "a moving picture stands for it";
  EXPECT_GT(renderer_->figures().moving_triangles, 0u);
  turned.waiting = false;
  EXPECT_GT(draw_in_pieces(turned, 1'000'000), 20u);
  turned.waiting = true;
  EXPECT_NE(draw(turned, kLevelsWidth, kLevelsHeight).rgb, coarse.rgb) << "what is whole is shown";
}

TEST_F(RenderPieces, pick_the_same_as_one_go) {
  test::TestSource source = full_source();
  const Picture picture = full_picture(source, "mono");
  const stereo::Aim aim = aim_of(picture, kLevelsWidth, kLevelsHeight);
  const auto picked = [&] {
    std::vector<std::optional<mesh::ShellIndex>> shells;
    for (int y = 10; y < kLevelsHeight; y += 13)
      for (int x = 10; x < kLevelsWidth; x += 19) shells.push_back(renderer_->shell_at(aim, {x, y}));
    return shells;
  };
  const auto expected = picked();
  full_picture(source, "mono");
  TickingClock clock;
  Picture turned = picture;
  for (int k = 1; k < 6; ++k) {  // pieces become small
    turned.view = stereo::orbit(picture.view, 0.1 * k, 0);
    EXPECT_FALSE(renderer_->draw_items_piece(aim_of(turned, kLevelsWidth, kLevelsHeight), clock, 1'000'000));
  }
  std::size_t pieces = 1;
  for (; !renderer_->draw_items_piece(aim, clock, 1'000'000); ++pieces)
    if (pieces % 3 == 0) draw(picture, kLevelsWidth, kLevelsHeight);
  EXPECT_GT(pieces, 10u);
  EXPECT_EQ(renderer_->figures().item_buffers_drawn, 1u);
  EXPECT_EQ(picked(), expected);
  EXPECT_EQ(renderer_->figures().item_buffers_drawn, 1u) << "what was drawn ahead is used";
  // A pick in between draws the rest.
  full_picture(source, "mono");
  EXPECT_FALSE(renderer_->draw_items_piece(aim, clock, 1'000'000));
  EXPECT_EQ(picked(), expected);
  // Pieces of another aim, paint or order of shells aren't gone on with.
  full_picture(source, "mono");
  EXPECT_FALSE(renderer_->draw_items_piece(aim_of(turned, kLevelsWidth, kLevelsHeight), clock, 1'000'000));
  EXPECT_FALSE(renderer_->draw_items_piece(aim, clock, 1'000'000));
  set_levels(source);
  EXPECT_EQ(picked(), expected);
  EXPECT_TRUE(renderer_->set_part_paints({}));
  EXPECT_FALSE(renderer_->draw_items_piece(aim, clock, 1'000'000));
  EXPECT_TRUE(renderer_->set_part_paints(std::vector<PartPaint>{{}, {.transparent = true}}));
  EXPECT_EQ(picked(), expected);
}

TEST(LevelsWorker, makes_levels_once_the_model_rests_and_stops_for_another) {
  const auto large = std::make_shared<test::TestSource>(waves(200)), other = std::make_shared<test::TestSource>(waves(200));
  other->key = 2;
  LevelsWorker worker;
  EXPECT_FALSE(worker.turn(0, large, true));
  EXPECT_EQ(worker.next_ns(0), LevelsWorker::kRestNs);
  EXPECT_FALSE(worker.turn(LevelsWorker::kRestNs - 1, large, true));
  EXPECT_FALSE(worker.turn(LevelsWorker::kRestNs, large, true)) << "begins";
  EXPECT_FALSE(worker.turn(LevelsWorker::kRestNs + 1, other, true)) << "another document: stops";
  std::optional<MadeLevels> made;
  for (std::int64_t now = 3 * LevelsWorker::kRestNs; !made; now += 1'000'000) {
    made = worker.turn(now, other, true);
    std::this_thread::yield();
  }
  EXPECT_EQ(made->document, 2u);
  EXPECT_EQ(made->levels.shells.size(), other->shell_nodes.size());
  const auto small = std::make_shared<test::TestSource>(waves(20));
  EXPECT_FALSE(worker.turn(1'000'000'000'000, small, true));
  EXPECT_EQ(worker.next_ns(1'000'000'000'000), std::nullopt);
}

TEST(MakeLevels, leaves_out_shells_with_nodes_out_of_range) {
  test::TestSource source = waves(30);
  source.shell_nodes[5].node[2] = mesh::NodeIndex(std::size_t{1'000'000});
  source.positions[3].x() = std::nan("");
  const MadeLevels made = make_levels(source).value();
  EXPECT_LT(made.levels.shells.size(), source.shell_nodes.size());
  EXPECT_TRUE(std::find(made.levels.shells.begin(), made.levels.shells.end(), mesh::ShellIndex(std::size_t{5})) ==
              made.levels.shells.end());
}

}  // namespace
}  // namespace prismesh::kiosk::render
