// The scripts of docs/examples on the sample, and the bead's on another mesh of the same shape and on a real deck.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "mesh/deck/data/deck.h"
#include "mesh/deck/open.h"
#include "tests/cli/cli_fixture.h"
#include "tests/support/places.h"

namespace prismesh::cli {
namespace {

const std::filesystem::path kExamples = test::source_folder() / "docs" / "examples";

struct Sum {
  std::size_t moved = 0;
  long new_fails = 0;  ///< from the first edit to the last
};

class Examples : public Cli {
 protected:
  std::string sample(int elements) {
    const std::string deck = path("sample-" + std::to_string(elements) + ".k");
    if (!std::filesystem::exists(deck)) {
      EXPECT_EQ(prismesh({"sample", "--elements", std::to_string(elements), "-o", deck}).status, 0);
    }
    return deck;
  }
  std::string edited(const std::string& deck, const std::string& script, Sum& sum) {
    const std::string out = path("edited.k");
    const Outcome outcome = prismesh({"edit", deck, "--script", script, "-o", out, "--json"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    std::istringstream lines(outcome.out);
    bool first = true;
    long before = 0;
    for (std::string line; std::getline(lines, line);) {
      const nlohmann::json report = nlohmann::json::parse(line);
      EXPECT_TRUE(report.at("ok").get<bool>()) << line;
      sum.moved += report.at("nodes_moved").get<std::size_t>();
      if (first) before = report.at("before").at("fail").get<long>();
      first = false;
      sum.new_fails = report.at("after").at("fail").get<long>() - before;
    }
    return out;
  }
};

/// How far the node nearest to `place` has moved, and how far away it is.
struct Shift {
  mesh::Vec3 by;
  double away = 0;
};
Shift shift_at(const std::string& before, const std::string& after, const mesh::Vec3& place) {
  const auto a = mesh::deck::open(before), b = mesh::deck::open(after);
  EXPECT_TRUE(a.has_value() && b.has_value());
  std::size_t nearest = 0;
  for (std::size_t i = 0; i < a->model.node_count(); ++i)
    if ((a->model.positions[i] - place).norm() < (a->model.positions[nearest] - place).norm()) nearest = i;
  return {b->model.positions[nearest] - a->model.positions[nearest], (a->model.positions[nearest] - place).norm()};
}

TEST_F(Examples, all_do_what_they_say_on_the_sample) {
  const std::string deck = sample(20000);
  for (const char* name : {"bead", "bulge", "flange", "rail"}) {
    Sum sum;
    edited(deck, (kExamples / (std::string(name) + ".jsonl")).string(), sum);
    EXPECT_GT(sum.moved, 50u) << name;
    EXPECT_LE(sum.new_fails, 0) << name;
  }
}

TEST_F(Examples, the_bead_is_the_same_on_a_remeshed_sample) {
  for (const int elements : {20000, 60000}) {
    const std::string deck = sample(elements);
    Sum sum;
    const std::string out = edited(deck, (kExamples / "bead.jsonl").string(), sum);
    EXPECT_LE(sum.new_fails, 0);
    const Shift middle = shift_at(deck, out, {1030, -84, 0});
    EXPECT_LT(middle.away, 8);
    EXPECT_NEAR(middle.by.y(), 7, 0.7) << elements;
    EXPECT_NEAR(middle.by.x(), 0, 1e-6);
    EXPECT_NEAR(shift_at(deck, out, {940, -84, 0}).by.y(), 7, 0.7) << "as deep along its length";
    EXPECT_NEAR(shift_at(deck, out, {1030, -84, 48}).by.y(), 0, 1e-6) << "beside it";
    EXPECT_NEAR(shift_at(deck, out, {800, -84, 0}).by.y(), 0, 1e-6) << "beyond its end";
    EXPECT_NEAR(shift_at(deck, out, {1030, 1.65, 0}).by.y(), 0, 1e-6) << "the plate behind it";
  }
}

TEST_F(Examples, a_bead_and_a_stretch_work_on_a_real_deck) {
  const char* models = std::getenv("PRISMESH_MODELS");
  if (models == nullptr) GTEST_SKIP() << "PRISMESH_MODELS isn't set";
  const std::string deck = std::string(models) + "/hatprofile/Hatprofile.k";
  for (const char* name : {"hatprofile_bead", "hatprofile_rail"}) {
    Sum sum;
    edited(deck, (kExamples / (std::string(name) + ".jsonl")).string(), sum);
    EXPECT_GT(sum.moved, 50u) << name;
    EXPECT_LE(sum.new_fails, 0) << name;
  }
}

/// Figure 12 of the 2004 paper on a public crash deck: stretch, signs, repair, relax, compare. States rules, no counts: repairing may get
/// better.
TEST_F(Examples, a_chain_on_a_real_deck_leaves_nothing_failing) {
  const char* models = std::getenv("PRISMESH_MODELS");
  if (models == nullptr) GTEST_SKIP() << "PRISMESH_MODELS isn't set";
  const std::string deck = std::string(models) + "/bumper_beam_rad/Bumper_Beam_AP_meshed_0000.rad", out = path("mended.rad");
  const Outcome outcome =
      prismesh({"edit", deck, "--script", (kExamples / "bumper_beam_stretch.jsonl").string(), "-o", out, "--target-size", "10", "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  std::map<std::string, nlohmann::json> step;
  std::istringstream lines(outcome.out);
  for (std::string line; std::getline(lines, line);) {
    nlohmann::json report = nlohmann::json::parse(line);
    const std::string name = report.at("edit");
    step[name] = std::move(report);
  }
  const auto bad = [&](const char* edit, const char* when) {
    const nlohmann::json& counts = step.at(edit).at(when);
    return std::pair(counts.at("fail").get<long>(), counts.at("warn").get<long>());
  };
  EXPECT_EQ(bad("translate", "before").first, 0) << "the deck is good";
  EXPECT_GT(bad("translate", "after").first, 0) << "the stretch makes shells fail";
  EXPECT_GT(bad("translate", "after").second, 100);
  EXPECT_EQ(bad("repair", "after").first, 0) << "none fails that didn't before";
  EXPECT_LT(bad("repair", "after").second, bad("translate", "after").second / 10);
  EXPECT_LE(bad("relax", "after"), bad("repair", "after"));
  const nlohmann::json check = prismesh({"check", out, "--target-size", "10", "--json"}).json();
  EXPECT_EQ(check.at("fail"), 0) << "nor in the saved deck";
  const nlohmann::json difference = prismesh({"diff", deck, out, "--json"}).json();
  EXPECT_NEAR(difference.at("max_displacement").get<double>(), 60, 1);
  EXPECT_EQ(difference.at("nodes_removed"), 0);
}

}  // namespace
}  // namespace prismesh::cli
