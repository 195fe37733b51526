// The scripts of docs/examples on the sample, and the bead's on another mesh of the same shape and on a real deck.
#include <algorithm>
#include <cmath>
#include <cstdlib>
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

}  // namespace
}  // namespace prismesh::cli
