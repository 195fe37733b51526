// Flanges of the sample, whose geometry is known, and of two real decks, checked by hand.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "mesh/connections/find_flanges.h"
#include "mesh/deck/open.h"
#include "mesh/deck/sample.h"
#include "tests/support/real_deck.h"

namespace prismesh::mesh::connections {
namespace {

std::vector<std::int64_t> part_ids(const Model& model, const Flange& flange) {
  std::vector<std::int64_t> ids;
  for (const PartIndex part : flange.parts) ids.push_back((*model.parts)[part.value].id);
  return ids;
}

double distance_from_line(const std::vector<Vec3>& line, const Vec3& point) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const Vec3 along = line[i + 1] - line[i];
    const double share = std::clamp((point - line[i]).dot(along) / along.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (line[i] + share * along - point).norm());
  }
  return least;
}

/// The beams and springs whose middle lies on a flange, by the flange; and how many don't.
struct Welds {
  std::map<std::size_t, std::size_t> on;
  std::size_t elsewhere = 0;
};
Welds welds_on(const Model& model, const std::vector<Flange>& flanges) {
  Welds welds;
  for (const ElementClass kind : {ElementClass::beam, ElementClass::discrete}) {
    const ElementBlock& block = *model.elements[static_cast<std::size_t>(kind)];
    for (std::size_t e = 0; e < block.size(); ++e) {
      const std::size_t first = block.first_node[e];
      const Vec3 middle = (model.position(block.nodes[first]) + model.position(block.nodes[first + 1])) / 2;
      std::size_t nearest = 0;
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t f = 0; f < flanges.size(); ++f)
        if (const double distance = distance_from_line(flanges[f].middle, middle); distance < least) least = distance, nearest = f;
      if (least <= flanges[nearest].mean_width / 2 + 2)
        ++welds.on[nearest];
      else
        ++welds.elsewhere;
    }
  }
  return welds;
}

Model sample_model(std::size_t shells) {
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / ("flanges_" + std::to_string(getpid()) + ".k");
  EXPECT_TRUE(deck::write_sample(path, shells));
  auto opened = deck::open(path);
  std::filesystem::remove(path);
  EXPECT_TRUE(opened);
  return opened ? std::move(opened->model) : Model{};
}

TEST(FlangesOfTheSample, are_where_it_was_made_with_them) {
  const Model model = sample_model(5000);
  const std::vector<Flange> flanges = find_flanges(model, spatial::BoxTree(model)).all;
  using Ids = std::vector<std::int64_t>;
  std::map<Ids, std::vector<const Flange*>> by_parts;
  for (const Flange& flange : flanges) by_parts[part_ids(model, flange)].push_back(&flange);
  const auto lengths = [&](const Ids& ids) {
    double sum = 0;
    for (const Flange* flange : by_parts[ids]) sum += flange->length;
    return sum;
  };
  ASSERT_EQ(flanges.size(), 11u);
  // Rail on closing plate, 20 wide: the lower flange whole, the upper one before and behind the pillar's foot, where four sheets lie
  // on each other over some 2 x (178 + 20).
  EXPECT_EQ(by_parts[(Ids{1, 2})].size(), 3u);
  ASSERT_EQ(by_parts[(Ids{3, 1, 2, 4})].size(), 1u);
  EXPECT_EQ(by_parts[(Ids{3, 1, 2, 4})][0]->sheets(), 4u);
  EXPECT_NEAR(lengths({3, 1, 2, 4}), 396, 15) << "to a shell";
  EXPECT_NEAR(lengths({1, 2}) + lengths({3, 1, 2, 4}), 2 * 1680, 0.02 * 2 * 1680) << "the rail's line is some 1680 long";
  EXPECT_EQ(by_parts[(Ids{3, 4})].size(), 2u) << "the pillar's flanges";
  EXPECT_EQ(by_parts[(Ids{3, 5})].size(), 2u) << "the walls that the reinforcement lies on";
  EXPECT_EQ(by_parts[(Ids{6, 7})].size(), 2u) << "the crossmember on the floor";
  for (const Flange* flange : by_parts[(Ids{6, 7})]) EXPECT_NEAR(flange->length, 420, 0.5);
  ASSERT_EQ(by_parts[(Ids{2, 6})].size(), 1u) << "the floor on the closing plate";
  EXPECT_NEAR(lengths({2, 6}), 820, 1e-6);
  for (const Flange& flange : flanges) {
    const Ids ids = part_ids(model, flange);
    if (ids == Ids{3, 5} || ids == Ids{3, 4}) continue;
    EXPECT_NEAR(flange.mean_width, 20, 0.05);
    EXPECT_GT(flange.min_width, 19.5);
  }
  EXPECT_NEAR(by_parts[(Ids{1, 2})][0]->distance, (1.8 + 1.5) / 2, 1e-3);
  EXPECT_NEAR(by_parts[(Ids{2, 6})][0]->distance, (1.5 + 0.8) / 2, 1e-3);
}

TEST(FlangesOfTheSample, are_alike_on_a_finer_mesh) {
  const Model model = sample_model(50'000);
  const std::vector<Flange> flanges = find_flanges(model, spatial::BoxTree(model)).all;
  EXPECT_EQ(flanges.size(), 11u);
  EXPECT_NEAR(flanges.front().length, 1682, 1) << "the rail's lower flange";
  EXPECT_NEAR(flanges.front().mean_width, 20, 0.02);
  EXPECT_NEAR(flanges.front().min_width, 20, 0.1) << "from end to end";
}

/// bumper_beam_rad has 78 spot welds, all in parts named CONNECTION_SPOTWELD, some 20 apart. They were counted from the file's text by a
/// script that knows nothing of this code: each lies on one of the 16 flanges, and none of these is without. The deck's two sides mirror
/// each other.
TEST(FlangesOfRealDecks, bumper_beam_rad_has_one_under_each_of_its_welds) {
  const auto decks = test::real_decks();
  if (!decks) GTEST_SKIP() << "PRISMESH_MODELS isn't set";
  const Model model = test::open_real(*decks, "bumper_beam_rad");
  const std::vector<Flange> flanges = find_flanges(model, spatial::BoxTree(model)).all;
  ASSERT_EQ(flanges.size(), 16u);
  const Welds welds = welds_on(model, flanges);
  EXPECT_EQ(welds.elsewhere, 0u);
  ASSERT_EQ(welds.on.size(), 16u);
  std::size_t sum = 0;
  for (const auto& [f, count] : welds.on) {
    EXPECT_NEAR(static_cast<double>(count) * 20, flanges[f].length, 11) << f << ": one weld each 20 mm";
    sum += count;
  }
  EXPECT_EQ(sum, 78u);
  for (std::size_t f = 0; f < 16; f += 2) {
    EXPECT_NEAR(flanges[f].length, flanges[f + 1].length, 1e-3);
    EXPECT_NEAR(flanges[f].mean_width, flanges[f + 1].mean_width, 1e-3);
  }
}

/// hatprofile's hat has two flanges of 500 in the plane z = 2, from |y| = 29.99829 to 65, over its plate at z = 0; the deck ties just the
/// nodes there, 1,616, to the plate by its node set 1. All read off the file's text.
TEST(FlangesOfRealDecks, hatprofile_has_two_of_the_nodes_it_ties) {
  const auto decks = test::real_decks();
  if (!decks) GTEST_SKIP() << "PRISMESH_MODELS isn't set";
  const Model model = test::open_real(*decks, "hatprofile");
  const std::vector<Flange> flanges = find_flanges(model, spatial::BoxTree(model)).all;
  ASSERT_EQ(flanges.size(), 2u);
  std::size_t of_the_hat = 0;
  for (const Flange& flange : flanges) {
    EXPECT_EQ(part_ids(model, flange), (std::vector<std::int64_t>{1, 2}));
    EXPECT_NEAR(flange.length, 500, 1e-6);
    EXPECT_NEAR(flange.mean_width, 65 - 29.99829, 1e-4);
    EXPECT_NEAR(flange.min_width, 65 - 29.99829, 1e-4);
    EXPECT_NEAR(flange.distance, 2, 1e-9);
    for (const NodeIndex node : flange.nodes) of_the_hat += model.position(node).z() > 1 ? 1 : 0;
  }
  EXPECT_EQ(of_the_hat, 1616u);
}

}  // namespace
}  // namespace prismesh::mesh::connections
