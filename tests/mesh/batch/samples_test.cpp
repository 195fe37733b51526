// Samples: Sobol's sequence as it is published, strata of a Latin hypercube, all combinations of a full plan.
#include "mesh/batch/samples.h"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

namespace prismesh::mesh::batch {
namespace {

Plan plan_of(Sampling sampling, std::size_t samples, std::size_t parameters) {
  Plan plan;
  plan.sampling = sampling;
  plan.samples = samples;
  for (std::size_t p = 0; p < parameters; ++p) plan.parameters.push_back({"p" + std::to_string(p), {}, 0, 1});
  return plan;
}

TEST(SobolTest, its_first_points_are_those_that_are_published) {
  // Joe and Kuo, the example of their program sobol.cc: ten points in three dimensions
  const double published[10][3] = {{0, 0, 0},
                                   {0.5, 0.5, 0.5},
                                   {0.75, 0.25, 0.25},
                                   {0.25, 0.75, 0.75},
                                   {0.375, 0.375, 0.625},
                                   {0.875, 0.875, 0.125},
                                   {0.625, 0.125, 0.875},
                                   {0.125, 0.625, 0.375},
                                   {0.1875, 0.3125, 0.9375},
                                   {0.6875, 0.8125, 0.4375}};
  for (std::uint64_t i = 0; i < 10; ++i)
    for (std::size_t d = 0; d < 3; ++d) EXPECT_EQ(sobol(i, d), published[i][d]) << i << ' ' << d;
}

TEST(SobolTest, every_dimension_fills_its_strata_evenly_and_pairs_fill_quarters) {
  for (std::size_t d = 0; d < kMaxSobolParameters; ++d) {
    std::set<int> strata;
    for (std::uint64_t i = 0; i < 1024; ++i) strata.insert(static_cast<int>(sobol(i, d) * 1024));
    EXPECT_EQ(strata.size(), 1024U) << d;
    for (std::size_t other = 0; other < d; ++other) {
      // no two dimensions are the same sequence: all 16 x 16 cells are met equally within 4096 points
      int cells[16][16] = {};
      for (std::uint64_t i = 0; i < 4096; ++i) ++cells[static_cast<int>(sobol(i, d) * 16)][static_cast<int>(sobol(i, other) * 16)];
      for (const auto& row : cells)
        for (const int count : row) EXPECT_EQ(count, 16) << d << ' ' << other;
    }
  }
}

TEST(LatinHypercubeTest, each_stratum_of_each_parameter_has_one_sample) {
  Plan plan = plan_of(Sampling::latin_hypercube, 500, 4);
  plan.parameters[1].from = -1000;
  plan.parameters[1].to = 1000;
  plan.parameters[2].from = 12;
  plan.parameters[2].to = 2;
  const Samples samples(plan);
  for (std::size_t p = 0; p < 4; ++p) {
    const Parameter& parameter = plan.parameters[p];
    std::set<int> strata;
    for (std::size_t i = 0; i < 500; ++i) {
      const double value = std::get<double>(samples.at(i)[p]);
      strata.insert(static_cast<int>(std::floor((value - parameter.from) / (parameter.to - parameter.from) * 500)));
    }
    EXPECT_EQ(strata.size(), 500U);
    EXPECT_EQ(*strata.begin(), 0);
    EXPECT_EQ(*strata.rbegin(), 499);
  }
}

TEST(LatinHypercubeTest, the_seed_alone_decides_and_parameters_are_independent) {
  Plan plan = plan_of(Sampling::latin_hypercube, 200, 2);
  EXPECT_EQ(Samples(plan).at(17), Samples(plan).at(17));
  const std::vector<ParameterValue> one = Samples(plan).at(17);
  double together = 0;
  const Samples samples(plan);
  for (std::size_t i = 0; i < 200; ++i) together += (samples.unit(i, 0) - 0.5) * (samples.unit(i, 1) - 0.5) * 12 / 200;
  EXPECT_LT(std::abs(together), 0.25) << "correlation";
  plan.seed = 2;
  EXPECT_NE(Samples(plan).at(17), one);
}

TEST(SamplesTest, listed_values_are_met_equally) {
  for (const Sampling sampling : {Sampling::latin_hypercube, Sampling::sobol}) {
    Plan plan = plan_of(sampling, 64, 2);
    plan.parameters[0].values = {1.0, 2.0, 3.0, "four"};
    const Samples samples(plan);
    std::size_t fours = 0;
    for (std::size_t i = 0; i < 64; ++i) fours += samples.at(i)[0] == ParameterValue("four");
    EXPECT_EQ(fours, 16U);
  }
}

TEST(SamplesTest, a_full_plan_has_every_combination_once) {
  Plan plan = plan_of(Sampling::full, 0, 2);
  plan.parameters[0].values = {1.0, 2.0};
  plan.parameters[1].values = {"a", "b", "c"};
  const Samples samples(plan);
  std::set<std::pair<std::string, std::string>> seen;
  for (std::size_t i = 0; i < sample_count(plan); ++i) seen.emplace(words(samples.at(i)[0]), words(samples.at(i)[1]));
  EXPECT_EQ(seen.size(), 6U);
  EXPECT_EQ(words(samples.at(1)[1]), "b") << "the last parameter changes first";
}

}  // namespace
}  // namespace prismesh::mesh::batch
