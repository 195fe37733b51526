// The contacts about shells that moved: the search of the whole model is the oracle.
#include "mesh/contact/contacts_about.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string_view>

#include <gtest/gtest.h>

#include "mesh/quality/report.h"
#include "tests/mesh/contact/sheets_that_meet.h"

namespace prismesh::mesh::contact {
namespace {

/// Three sheets that wave, close to each other and through each other in places: regions from a shell to some dozens.
Model waving_sheets(std::mt19937& random) {
  const auto uniform = [&](double low, double high) { return low + (high - low) * (static_cast<double>(random()) / 4294967296.0); };
  test::SheetsThatMeet sheets;
  for (const int part : {1, 2, 3}) {
    const double phase = uniform(0, 6), off = uniform(0, 1), steep = uniform(0.3, 0.9);
    sheets.add(part, 26, 18, [=](int i, int j) {
      return Vec3(i + off, j + off, 0.9 * part + steep * std::sin(0.5 * i + phase) * std::cos(0.6 * j - phase));
    });
  }
  return sheets.model();
}

TEST(ContactsAbout, are_those_that_the_search_of_the_whole_model_finds_worse) {
  std::size_t worse = 0, found_of_all = 0, found_about = 0;
  for (std::uint32_t seed = 1; seed <= 12; ++seed) {
    std::mt19937 random(seed);
    const Model model = waving_sheets(random);
    const ContactThickness thickness = given_thickness(model, 0.35);
    const spatial::BoxTree tree(model);
    const quality::SizedCriteria criteria{quality::default_criteria(), 1};
    const auto states = quality::judge_model(model, criteria);
    const SeparationInput input{model, tree, thickness, criteria, states, {}, [](NodeIndex) { return std::string_view(); }};
    const SeparationWish wish;
    const FoundContacts found = find_contacts(input, wish, model, tree);
    const SeparatedModel before{model, tree, states, by_pair(found, 0), 0.35};
    SeparatedModel after = before;
    const Vec3 centre = model.positions[random() % model.node_count()];
    const double by = static_cast<double>(random() % 9) * 0.1 - 0.4;
    NodeSet nodes;
    for (std::size_t n = 0; n < model.node_count(); ++n)
      if ((model.positions[n] - centre).norm() < 2.2) {
        nodes.push_back(NodeIndex(n));
        after.model.positions.set(n, model.positions[n] + Vec3(0.05, 0, by));
      }
    after.tree.follow(after.model);
    const FoundContacts all = find_contacts(input, wish, after.model, after.tree);
    const FoundContacts about = find_contacts_about(input, wish, before, after, shells_touching(model, nodes), {});
    const Contacts contacts = by_pair(all, 0), contacts_about = by_pair(about, 0);
    const auto worse_of_all = worse_pairs(before.contacts, contacts, 0);
    EXPECT_EQ(worse_pairs(before.contacts, contacts_about, 0), worse_of_all) << "seed " << seed;
    for (const auto& [pair, contact] : contacts_about) {
      const auto same = contacts.find(pair);
      ASSERT_NE(same, contacts.end()) << "seed " << seed;
      EXPECT_EQ(same->second.crosses, contact.crosses);
      EXPECT_EQ(same->second.depth, contact.depth);
    }
    for (const auto& [pair, contact] : before.contacts)
      if (contacts.find(pair) == contacts.end()) {
        EXPECT_EQ(contacts_about.find(pair), contacts_about.end());
      }
    worse += worse_of_all.size();
    found_of_all += contacts.size();
    found_about += contacts_about.size();
  }
  EXPECT_GT(worse, 50u);
  EXPECT_LT(found_about, found_of_all) << "some regions are far from what moved";
}

}  // namespace
}  // namespace prismesh::mesh::contact
