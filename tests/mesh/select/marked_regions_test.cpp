// Regions of real decks that were marked by hand: each is what an engineer would call one face or one fillet, given by its part, the box
// around its shells' centres and, where the box isn't enough, the direction it faces. A region must find it whichever angle within 10
// degrees of the default is used.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <iterator>
#include <string>
#include <string_view>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "mesh/deck/data/deck.h"
#include "mesh/deck/open.h"
#include "mesh/model/adjacency.h"
#include "mesh/select/region.h"

namespace prismesh::mesh::select {
namespace {

constexpr double kFar = 9999;
constexpr const char* kHat = "hatprofile/Hatprofile.k";
constexpr const char* kBracket = "dbend_rad/DBEND_44_0000.rad";
constexpr const char* kAircraft = "aero2728_dfem/Bulk_DFEM.bdf";

struct Mark {
  const char* deck;
  const char* name;
  std::int64_t start;  ///< a shell
  std::int64_t part;
  Vec3 low, high;              ///< around the centres of its shells
  Vec3 normal = Vec3::Zero();  ///< if not zero: their normals are within 10 degrees of it
};

const Mark kMarks[] = {
    {kHat, "roof", 1001501, 1, {-kFar, -kFar, 31.9}, {kFar, kFar, 32.1}},
    {kHat, "flange, left", 1000001, 1, {-kFar, -kFar, 1.9}, {kFar, -30, 2.1}},
    {kHat, "flange, right", 1003101, 1, {-kFar, 30, 1.9}, {kFar, kFar, 2.1}},
    {kHat, "wall, left", 1000901, 1, {-kFar, -25.2, 9}, {kFar, -24.3, 25}},
    {kHat, "wall, right", 1002501, 1, {-kFar, 24.3, 9}, {kFar, 25.2, 25}},
    {kHat, "lower fillet, left", 1000701, 1, {-kFar, -30, 2.5}, {kFar, -25.4, 5.5}},
    {kHat, "upper fillet, left", 1001301, 1, {-kFar, -24.2, 28.5}, {kFar, -20.5, 31.5}},
    {kHat, "upper fillet, right", 1002301, 1, {-kFar, 20.5, 28.5}, {kFar, 24.2, 31.5}},
    {kHat, "lower fillet, right", 1002901, 1, {-kFar, 25.4, 2.5}, {kFar, 30, 5.5}},
    {kBracket, "lower bracket, long leg", 100, 2, {31, -kFar, -0.5}, {kFar, kFar, 0}},
    {kBracket, "lower bracket, short leg", 1, 2, {25, -kFar, -kFar}, {26.1, kFar, -5}},
    {kBracket, "lower bracket, fillet", 52, 2, {26.01, -kFar, -5}, {31, kFar, -0.4}},
    {kBracket, "upper bracket, leg upwards", 300, 4, {24.9, -kFar, 5}, {26, kFar, kFar}},
    {kBracket, "upper bracket, fillet", 252, 4, {20, -kFar, 0.4}, {24.99, kFar, 5}},
    {kBracket, "upper bracket, leg along", 236, 4, {0, -kFar, 0}, {20, kFar, 0.4}},
    {kBracket, "stop, leg along", 176, 3, {32, -kFar, 0}, {80, kFar, 0.4}},
    {kBracket, "stop, fillet", 207, 3, {81, -kFar, 0.4}, {85.95, kFar, 5}},
    {kAircraft, "rib at 206, web", 91631689, 111, {11, 200, -122}, {137, 208, -12}, {0, 1, 0}},
    {kAircraft, "rib at -494, web", 91641082, 111, {11, -500, -119}, {137, -490, -20}, {0, 1, 0}},
    {kAircraft, "rib at -188, web", 91641722, 111, {11, -194, -119}, {137, -184, -20}, {0, 1, 0}},
    {kAircraft, "rib at 206, upper flange", 91633470, 111, {7, 130, -14}, {136, 205, -8}, {0, 0, 1}},
    {kAircraft, "rib at -188, upper flange", 91638638, 111, {7, -259, -22}, {136, -189, -16}, {0, 0, 1}},
    {kAircraft, "rib at -494, upper flange", 91633823, 111, {7, -565, -22}, {136, -495, -16}, {0, 0, 1}},
    {kAircraft, "rib at -188, lower flange", 91638457, 111, {7, -259, -124}, {136, -189, -118}, {0, 0, 1}},
    {kAircraft, "rib at 206, lower flange", 91631911, 111, {7, 130, -128}, {136, 205, -122}, {0, 0, 1}},
    {kAircraft, "rib at -494, lower flange", 91633852, 111, {7, -565, -124}, {136, -495, -118}, {0, 0, 1}},
};

/// Whether a shell's normal is within 10 degrees of the direction; true for no direction.
bool is_across(const Model& model, const ShellNodes& nodes, const Vec3& direction) {
  if (direction.isZero()) return true;
  const auto at = [&](std::size_t i) -> const Vec3& { return model.position(nodes.node[i]); };
  const Vec3 normal = (at(2) - at(0)).cross(at(3) - at(1)) + (at(1) - at(0)).cross(at(2) - at(0));
  return std::abs(normal.dot(direction)) > 0.9848 * normal.norm();
}

ShellSet marked(const Model& model, const Mark& mark) {
  ShellSet shells;
  for (std::size_t s = 0; s < model.shell_count(); ++s) {
    const PartIndex part = model.shell_parts[s];
    if (!part.valid() || (*model.parts)[part.value].id != mark.part) continue;
    const ShellNodes& nodes = model.shell(ShellIndex(s));
    Vec3 centre = Vec3::Zero();
    for (int i = 0; i < nodes.corners(); ++i) centre += model.position(nodes.node[static_cast<std::size_t>(i)]) / nodes.corners();
    if ((centre.array() < mark.low.array()).any() || (centre.array() > mark.high.array()).any()) continue;
    if (is_across(model, nodes, mark.normal)) shells.emplace_back(s);
  }
  return shells;
}

/// The shells that two sets share, as a share of all in either.
double agreement(const ShellSet& a, const ShellSet& b) {
  ShellSet both;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
  return static_cast<double>(both.size()) / static_cast<double>(a.size() + b.size() - both.size());
}

class MarkedRegions : public testing::TestWithParam<const char*> {};

TEST_P(MarkedRegions, are_found_with_every_angle_near_the_default) {
  const char* models = std::getenv("PRISMESH_MODELS");
  if (models == nullptr) GTEST_SKIP() << "PRISMESH_MODELS isn't set";
  const auto opened = deck::open(std::string(models) + "/" + GetParam());
  ASSERT_TRUE(opened) << opened.error().text();
  const Model& model = opened->model;
  int marks = 0;
  for (const Mark& mark : kMarks) {
    if (std::string_view(mark.deck) != GetParam()) continue;
    ++marks;
    std::size_t first = 0;
    while (first < model.shell_count() && model.shell_ids[first] != mark.start) ++first;
    ASSERT_LT(first, model.shell_count());
    const ShellSet hand = marked(model, mark);
    ASSERT_GT(hand.size(), 9u) << mark.name;
    for (const double angle : {20.0, 25.0, 30.0, 35.0, 40.0}) {
      const ShellSet found = region(model, {ShellIndex(first)}, {RegionBound::features, angle, {}, nullptr});
      EXPECT_GE(agreement(found, hand), 0.96) << mark.name << " at " << angle << ": " << found.size() << " shells, marked " << hand.size();
    }
  }
  EXPECT_GE(marks, 8);
}

INSTANTIATE_TEST_SUITE_P(Decks, MarkedRegions, testing::Values(kHat, kBracket, kAircraft));

}  // namespace
}  // namespace prismesh::mesh::select
