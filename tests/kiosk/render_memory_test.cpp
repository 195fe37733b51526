// The limit of video memory: what is held is counted as the driver counts it, keeps to the limit, and shows and picks the same shells.
#include <algorithm>
#include <cmath>

#include "kiosk/render/make_levels.h"
#include "kiosk/render/row_texture.h"
#include "tests/kiosk/driver_memory.h"
#include "tests/kiosk/render_test.h"

namespace prismesh::kiosk::render {
namespace {

constexpr int kMemoryWidth = 360, kMemoryHeight = 270;
constexpr std::size_t kMiB = std::size_t{1} << 20;

TEST(MemoryPlan, gives_up_nothing_without_a_limit_or_below_it) {
  const MemoryNeeds needs{100 * kMiB, kMiB, 4, true, 24 * kMiB, 40 * kMiB};
  // For a pixel at rest 4 samples of colour and depth, and for each eye three images; in motion one sample and two images.
  const std::size_t all = (100 + 4 * 8 + 2 * 12 + 8 + 2 * 8 + 24 + 40) * kMiB + kMemoryMargin;
  EXPECT_EQ(plan_memory(needs, 0), (MemoryPlan{{}, all}));
  EXPECT_EQ(plan_memory(needs, all), (MemoryPlan{{}, all}));
}

TEST(MemoryPlan, has_no_images_in_motion_where_nothing_moves) {
  const MemoryNeeds moves{100 * kMiB, kMiB, 4, true, 0, 0}, rests{100 * kMiB, kMiB, 4, false, 0, 0};
  EXPECT_EQ(plan_memory(moves, 0).bytes - plan_memory(rests, 0).bytes, 24 * kMiB);
}

TEST(MemoryPlan, gives_up_in_a_fixed_order_and_no_more_than_needed) {
  const MemoryNeeds needs{100 * kMiB, kMiB, 4, true, 24 * kMiB, 40 * kMiB};
  const std::size_t all = plan_memory(needs, 0).bytes;
  const auto first = plan_memory(needs, all - 1);
  EXPECT_EQ(first, (MemoryPlan{{.multisampling = true}, all - 24 * kMiB}));
  const auto second = plan_memory(needs, first.bytes - 1);
  EXPECT_EQ(second, (MemoryPlan{{.multisampling = true, .moving_images = true}, first.bytes - 24 * kMiB}));
  const auto third = plan_memory(needs, second.bytes - 1);
  EXPECT_EQ(third, (MemoryPlan{{.multisampling = true, .moving_images = true, .order = true}, second.bytes - 24 * kMiB}));
  const auto fourth = plan_memory(needs, third.bytes - 1);
  EXPECT_EQ(fourth, (MemoryPlan{{true, true, true, true}, third.bytes - 40 * kMiB}));
  EXPECT_EQ(plan_memory(needs, 1), fourth) << "nothing else can be given up";
}

TEST(MemoryPlan, says_what_is_given_up_and_what_isnt) {
  EXPECT_EQ(megabytes_of({3 * kMiB + 1, 0, 0, {}}), "4 MB");
  EXPECT_EQ(megabytes_of({3 * kMiB, 64 * kMiB, 0, {}}), "3 of 64 MB");
  EXPECT_EQ(sentence_of({60 * kMiB, 64 * kMiB, 64 * kMiB, {.multisampling = true, .order = true}}),
            "Video memory is limited to 64 MB (video_memory_mb). To keep to it, edges aren't smoothed, pictures at rest take longer. Every "
            "shell is still drawn at rest, and can be picked.");
  EXPECT_EQ(
      sentence_of({60 * kMiB, 64 * kMiB, 64 * kMiB + 1, {}}),
      "Video memory is limited to 64 MB (video_memory_mb). Every shell is still drawn at rest, and can be picked. The limit is exceeded "
      "all the same: this model in this window takes up to 65 MB.");
}

class RenderMemory : public RenderTest {
 protected:
  static test::TestSource sheets() {
    test::TestSource source;
    test::add_grid(source, 130, 130, 0,
                   [](double u, double v) { return mesh::Vec3(600 * u, 500 * v, 40 * std::sin(9 * u) * std::cos(8 * v)); });
    test::add_grid(source, 60, 60, 1, [](double u, double v) { return mesh::Vec3(150 + 300 * u, 100 + 250 * v, 150 + 60 * u * v); });
    mesh::quality::ShellState warns;
    warns.warn = 1;
    for (std::size_t s = 0; s < source.shell_nodes.size(); s += 17) source.shell_quality[s] = warns;
    for (std::size_t n = 5000; n < 7000; ++n) source.node_marks[n] = mesh::document::kSelected;
    for (std::size_t s = 900; s < 1300; ++s) source.shell_marks[s] = mesh::document::kSelected;
    return source;
  }
  Picture picture_of() {
    Picture picture = fitted("side-by-side", "iso", kMemoryWidth, kMemoryHeight);
    picture.shadows = true;
    picture.handle = Handle{mesh::Vec3(300, 250, 0), mesh::Vec3::UnitZ()};
    picture.marked = mesh::ShellIndex(std::size_t{77});
    return picture;
  }
  /// What is held, by the renderer and by the driver, must be the same; returns it. No target of pictures is left over by then.
  std::size_t held() {
    const std::size_t held = renderer_->video_memory().held;
    EXPECT_EQ(held, bytes_in_driver());
    return held;
  }
  void keeps_to_limit() {
    const VideoMemory memory = renderer_->video_memory();
    if (memory.limit == 0 || memory.is_exceeded()) return;
    EXPECT_LE(held(), memory.limit);
  }
  struct Seen {
    std::vector<std::uint8_t> at_rest, in_pieces;
    std::vector<std::optional<mesh::ShellIndex>> picked;
    GivenUp given_up;  ///< for in_pieces
    std::size_t most = 0;
  };
  class StepClock final : public Clock {
   public:
    std::int64_t now_ns() override { return now_ += 10'000'000; }

   private:
    std::int64_t now_ = 0;
  };
  /// What a user does with a model: looks, turns, looks, picks, colours.
  Seen work(const test::TestSource& source, const RendererOptions& options) {
    make_renderer(options);
    Seen seen;
    const auto look = [&] {
      keeps_to_limit();
      seen.most = std::max(seen.most, renderer_->video_memory().held);
    };
    show(source);
    look();
    Picture picture = picture_of();
    seen.at_rest = draw(picture, kMemoryWidth, kMemoryHeight).rgb;
    look();
    EXPECT_TRUE(renderer_->set_levels(make_levels(source).value()));
    look();
    picture.moving = true;
    picture.view = stereo::orbit(picture.view, 0.3, 0);
    draw(picture, kMemoryWidth, kMemoryHeight);
    look();
    picture.view = stereo::orbit(picture.view, -0.3, 0);
    const std::vector<std::uint8_t> in_motion = draw(picture, kMemoryWidth, kMemoryHeight).rgb;
    picture.moving = false;
    StepClock clock;
    for (int piece = 0; piece < 1000; ++piece) {
      const Result<bool> whole = renderer_->draw_piece(picture, kMemoryWidth, kMemoryHeight, clock, 20'000'000);
      look();
      EXPECT_TRUE(whole);
      if (!whole || *whole) break;
      if (piece == 3) {  // something else changes meanwhile
        picture.waiting = true;
        draw(picture, kMemoryWidth, kMemoryHeight);
        picture.waiting = false;
      }
    }
    seen.in_pieces = draw(picture, kMemoryWidth, kMemoryHeight).rgb;
    seen.given_up = report_.memory.given_up;
    if (!seen.given_up.levels) {
      EXPECT_FALSE(seen.in_pieces == in_motion) << "what was drawn in motion isn't taken for the picture at rest";
    }
    const stereo::Aim aim = aim_of(picture, kMemoryWidth, kMemoryHeight);
    for (int y = 10; y < kMemoryHeight; y += 23)
      for (int x = 10; x < kMemoryWidth; x += 29) seen.picked.push_back(renderer_->shell_at(aim, {x, y}));
    look();
    EXPECT_TRUE(renderer_->set_field(Pane::model, std::vector<float>(source.positions.size(), 0.5F), true));
    look();
    draw(picture, kMemoryWidth, kMemoryHeight);
    look();
    return seen;
  }
};

TEST_F(RenderMemory, is_counted_as_the_driver_counts_it) {
  const test::TestSource source = sheets();
  EXPECT_LT(held(), kMiB) << "without a model";
  const Seen seen = work(source, {.samples = 4});
  EXPECT_GT(seen.most, 7 * kMiB);
  EXPECT_EQ(renderer_->video_memory().limit, 0u);
  EXPECT_EQ(renderer_->video_memory().given_up, GivenUp());
  held();
  EXPECT_TRUE(renderer_->set_other(std::make_shared<test::TestSource>(source)));
  EXPECT_TRUE(renderer_->set_part_paints(std::vector<PartPaint>{{}, {.transparent = true}}));
  EXPECT_TRUE(renderer_->set_cut(CutPicture{mesh::Vec3(300, 250, 0), mesh::Vec3::UnitX(), {{mesh::Vec3::Zero(), mesh::Vec3::UnitX()}}}));
  Picture picture = fitted("prism-mask", "iso", kMemoryWidth, kMemoryHeight);
  picture.colour = ColourMode::part_states;
  picture.two_views.emplace();
  picture.lasso = {{10, 10}, {100, 10}, {100, 90}};
  draw(picture, kMemoryWidth, kMemoryHeight);
  held();
}

TEST_F(RenderMemory, keeps_to_its_limit_and_shows_and_picks_every_shell) {
  const test::TestSource source = sheets();
  const Seen free = work(source, {.samples = 4});
  const Seen plain = work(source, {.samples = 1});
  ASSERT_FALSE(free.at_rest == plain.at_rest);
  int steps = 0;
  GivenUp before;
  for (std::size_t limit = free.most + 6 * kMiB; limit > kMiB; limit -= kMiB * 2 / 5) {
    const Seen seen = work(source, {.samples = 4, .video_memory = limit});
    const VideoMemory memory = renderer_->video_memory();
    if (memory.is_exceeded()) {
      EXPECT_EQ(memory.given_up, (GivenUp{true, true, true, true}));
      break;
    }
    EXPECT_LE(seen.most, limit);
    EXPECT_EQ(memory.given_up.with(before), memory.given_up) << "less memory, more is given up";
    if (!(memory.given_up == before)) ++steps;
    before = memory.given_up;
    EXPECT_EQ(seen.picked, free.picked);
    EXPECT_TRUE(seen.in_pieces == (seen.given_up.multisampling ? plain : free).in_pieces);
    EXPECT_TRUE(renderer_->levels_are_current()) << "none are made over and over";
  }
  EXPECT_EQ(steps, 4) << "each step was taken by itself";
}

TEST_F(RenderMemory, changes_no_bit_of_any_picture_where_the_limit_is_not_reached) {
  const test::TestSource source = sheets();
  const Seen free = work(source, {.samples = 4});
  const Seen limited = work(source, {.samples = 4, .video_memory = 1000 * kMiB});
  EXPECT_TRUE(free.at_rest == limited.at_rest && free.in_pieces == limited.in_pieces);
  EXPECT_EQ(renderer_->video_memory().given_up, GivenUp());
}

TEST_F(RenderMemory, frees_at_once_what_is_given_up) {
  const test::TestSource source = sheets();
  constexpr std::size_t kPixels = std::size_t{kMemoryWidth} * kMemoryHeight, kValues = 4'000'000;
  const auto show_both = [&](std::size_t limit) {
    make_renderer({.samples = 4, .video_memory = limit});
    show(source);
    Picture picture = fitted("mono", "iso", kMemoryWidth, kMemoryHeight);
    draw(picture, kMemoryWidth, kMemoryHeight);
    picture.moving = true;
    picture.view = stereo::orbit(picture.view, 0.3, 0);
    draw(picture, kMemoryWidth, kMemoryHeight);
    return renderer_->video_memory();
  };
  const std::size_t free = show_both(1000 * kMiB).planned;
  const std::size_t before = show_both(free + kValues * 8 - 3 * kMiB).held;
  EXPECT_EQ(report_.memory.given_up, GivenUp());
  EXPECT_TRUE(renderer_->set_field(Pane::model, std::vector<float>(kValues, 0.5F), true));
  EXPECT_EQ(renderer_->video_memory().given_up, (GivenUp{true, true, false, false}));
  EXPECT_EQ(held(), before + RowTexture::bytes_for(kValues, {0, 0, 0, 8}) - kPixels * (8 * 4 + 16) - kPixels * (8 + 16));
}

TEST_F(RenderMemory, gets_back_what_was_given_up_when_there_is_room_again) {
  const test::TestSource source = sheets();
  work(source, {.samples = 4});
  const std::size_t most = renderer_->video_memory().held;
  make_renderer({.samples = 4, .video_memory = most + 3 * kMiB});
  show(source);
  Picture picture = picture_of();
  EXPECT_TRUE(renderer_->set_levels(make_levels(source).value()));
  draw(picture, kMemoryWidth, kMemoryHeight);
  EXPECT_EQ(report_.memory.given_up, GivenUp()) << "nothing was in motion yet";
  picture.moving = true;
  picture.view = stereo::orbit(picture.view, 0.2, 0);
  draw(picture, kMemoryWidth, kMemoryHeight);
  picture.moving = false;
  draw(picture, kMemoryWidth, kMemoryHeight);
  EXPECT_TRUE(report_.memory.given_up.multisampling);
  draw(picture, kMemoryWidth / 2, kMemoryHeight / 2);
  EXPECT_EQ(report_.memory.given_up, GivenUp()) << "a smaller window";
  make_renderer({.samples = 4});
  show(source);
  const Image expected = draw(picture, kMemoryWidth / 2, kMemoryHeight / 2);
  make_renderer({.samples = 4, .video_memory = most + 3 * kMiB});
  show(source);
  draw(picture, kMemoryWidth, kMemoryHeight);
  EXPECT_TRUE(draw(picture, kMemoryWidth / 2, kMemoryHeight / 2).rgb == expected.rgb);
}

}  // namespace
}  // namespace prismesh::kiosk::render
