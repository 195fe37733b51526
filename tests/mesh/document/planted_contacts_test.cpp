// Contacts planted in real decks: about random nodes a sheet is pulled through its neighbour, and separated. What separating promises is
// checked on each: nothing new crosses or is too close, no shell more fails, no weld or tie is lost. With PRISMESH_PLANTED set it prints
// the rows of docs/contact.md and why each region is left.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <map>
#include <optional>
#include <random>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "mesh/contact/find_penetrations.h"
#include "mesh/contact/find_perforations.h"
#include "mesh/contact/shell_crossings.h"
#include "mesh/deck/sample.h"
#include "mesh/document/contacts.h"
#include "mesh/spatial/closest_point.h"
#include "tests/mesh/document/document_fixture.h"
#include "tests/support/real_deck.h"

namespace prismesh::mesh::document {
namespace {

struct PlantedDeck {
  const char* name;
  const char* path;  ///< below the real decks; empty: the sample
  int planted;
  int least_rings, most_rings;
  int least_removed;
};

void PrintTo(const PlantedDeck& deck, std::ostream* out) { *out << deck.name; }

using Pairs = std::map<std::pair<std::uint32_t, std::uint32_t>, double>;  ///< the depth; of what crosses the greatest

constexpr double kCrosses = 1e30;
const bool kPrints = std::getenv("PRISMESH_PLANTED") != nullptr;

Pairs contact_pairs(const Document& document) {
  const Model& model = document.current().model;
  const spatial::BoxTree tree(model);
  Pairs pairs;
  const auto add = [&](ShellIndex a, ShellIndex b, double depth) {
    double& known = pairs[std::minmax<std::uint32_t>(static_cast<std::uint32_t>(a.value), static_cast<std::uint32_t>(b.value))];
    known = std::max(known, depth);
  };
  const auto crossings = contact::find_shell_crossings(model, tree);
  for (const auto& crossing : crossings) add(crossing.a, crossing.b, kCrosses);
  for (const auto& region : contact::find_penetrations(model, tree, contact_thickness(document.current()), crossings))
    for (const auto& pair : region.pairs) add(pair.a, pair.b, pair.depth);
  return pairs;
}

/// Numbers as the C++ standard fixes them, so that the same places are planted everywhere.
class Places {
 public:
  explicit Places(std::uint32_t seed) : random_(seed) {}
  double uniform(double low, double high) { return low + (high - low) * (static_cast<double>(random_()) / 4294967296.0); }
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(uniform(0, static_cast<double>(count))); }

 private:
  std::mt19937 random_;
};

double mean_side_at(const Model& model, ShellIndex shell) {
  const ShellNodes& nodes = model.shell(shell);
  double around = 0;
  for (int i = 0; i < nodes.corners(); ++i)
    around += (model.position(nodes.node[(i + 1) % nodes.corners()]) - model.position(nodes.node[i])).norm();
  return around / nodes.corners();
}

class PlantedContacts : public testing::TestWithParam<PlantedDeck> {
 protected:
  /// The deck with a place pulled through the nearest sheet of another part, where there is one within two shells.
  std::optional<Vec3> plant(Document& document, Places& places) const {
    const Model& model = document.current().model;
    const NodeIndex node(places.below(model.node_count()));
    const int rings = GetParam().least_rings +
                      static_cast<int>(places.below(static_cast<std::size_t>(GetParam().most_rings - GetParam().least_rings + 1)));
    const double beyond = places.uniform(0.05, 0.5);
    const auto own = model.adjacency->shells_of(node);
    if (own.empty() || (document.current().node_marks[node.value] & kLocked) != 0 || model.node_holds[node.value] != 0) return {};
    const PartIndex part = model.shell_parts[own.front().value];
    const double side = mean_side_at(model, own.front());
    ShellSet others;
    for (std::size_t s = 0; s < model.shell_count(); ++s)
      if (!model.is_removed(ShellIndex(s)) && model.shell_parts[s] != part) others.push_back(ShellIndex(s));
    const Vec3 from = model.position(node);
    const auto nearest = spatial::ShellTree(model, others).closest(from, 2 * side);
    if (!nearest || nearest->distance <= 1e-6 * side) return {};
    const Vec3 by = (nearest->point - from) * (1 + beyond * side / nearest->distance);
    const std::string id = std::to_string(model.node_ids[node.value]);
    must_apply(document, R"({"edit":"select","expr":"node:)" + id + R"("})");
    must_apply(document, R"({"edit":"grow","rings":)" + std::to_string(rings) + "}");
    const std::string move = R"({"edit":"translate","by":[)" + std::to_string(by.x()) + "," + std::to_string(by.y()) + "," +
                             std::to_string(by.z()) + R"(],"grab":)" + id + "}";
    if (!try_apply(document, edit_of(move))) return {};
    return document.current().model.position(node);
  }
};

TEST_P(PlantedContacts, are_removed_or_left_with_the_reason) {
  const PlantedDeck& planted = GetParam();
  const Folder folder;
  std::filesystem::path path = folder / "sample.k";
  if (*planted.path == '\0') {
    ASSERT_TRUE(deck::write_sample(path, 2000));
  } else {
    const auto models = test::real_decks();
    if (!models) GTEST_SKIP() << "PRISMESH_MODELS doesn't point to the real decks";
    path = *models / planted.path;
  }
  const Result<Document> opened = open(path, {});
  ASSERT_TRUE(opened) << opened.error().text();
  const Document deck = *opened;
  const Pairs of_deck = contact_pairs(deck);
  Places places(20261127);
  std::map<std::string, int> left;
  int done = 0, removed = 0;
  double farthest = 0, its_depth = 0;
  for (int tries = 0; done < planted.planted && tries < 5000; ++tries) {
    Document document = deck;
    const std::optional<Vec3> at = plant(document, places);
    if (!at) continue;
    ++done;
    const Pairs before = contact_pairs(document);
    const std::size_t failing = document.current().counts.fail;
    const std::string where = "[" + std::to_string(at->x()) + "," + std::to_string(at->y()) + "," + std::to_string(at->z()) + "]";
    const EditReport report = must_apply(document, R"({"edit":"separate","joined":true,"at":)" + where + "}");
    EXPECT_LE(document.current().counts.fail, failing) << "at " << where;
    EXPECT_EQ(report.lost_connections, 0u) << "at " << where;
    ASSERT_TRUE(report.separated);
    for (const auto& [pair, depth] : contact_pairs(document)) {
      const auto known = before.find(pair);
      EXPECT_TRUE(known != before.end() && depth <= known->second * 1.001 + 1e-6)
          << "at " << where << " shells " << pair.first << " and " << pair.second << " are " << depth << " too close, before "
          << (known != before.end() ? known->second : 0.0);
    }
    if (report.separated->regions_before == 0) {
      ++left["nothing found"];
      continue;
    }
    for (const RegionLeft& region : report.separated->regions_left) {
      if (kPrints) std::cout << "  at " << where << ": " << region.a << " and " << region.b << ": " << region.why << "\n";
      std::string why;  // without the numbers
      for (const char c : region.why)
        if (!(c >= '0' && c <= '9') && c != '.') why += c;
      ++left[why];
    }
    if (report.separated->regions_left.empty()) {
      ++removed;
      if (report.separated->largest_move > farthest) {
        farthest = report.separated->largest_move;
        its_depth = report.separated->depth_before;
      }
    }
  }
  EXPECT_GE(removed, planted.least_removed);
  if (!kPrints) return;
  std::cout << planted.name << ": planted " << done << ", removed " << removed << ", the farthest move " << farthest << " at a depth of "
            << its_depth << "\n";
  for (const auto& [why, count] : left) std::cout << "  left " << count << ": " << why << "\n";
}

INSTANTIATE_TEST_SUITE_P(RealDecks, PlantedContacts,
                         testing::Values(PlantedDeck{"sample", "", 30, 2, 3, 20},
                                         PlantedDeck{"bumper_beam", "bumper_beam_rad/Bumper_Beam_AP_meshed_0000.rad", 24, 2, 3, 15},
                                         PlantedDeck{"simple_car", "simplecar_nas/full_car.nas", 24, 2, 3, 5},
                                         PlantedDeck{"hat_profile", "hatprofile/Hatprofile.k", 10, 2, 3, 9},
                                         PlantedDeck{"bumper_beam_wide", "bumper_beam_rad/Bumper_Beam_AP_meshed_0000.rad", 24, 5, 7, 20},
                                         PlantedDeck{"hat_profile_wide", "hatprofile/Hatprofile.k", 16, 5, 7, 10}),
                         [](const auto& deck) { return std::string(deck.param.name); });

}  // namespace
}  // namespace prismesh::mesh::document
