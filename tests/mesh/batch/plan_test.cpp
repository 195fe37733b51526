// Plans: what their keys mean, and what is wrong with a plan, by file and line.
#include "mesh/batch/plan.h"

#include <filesystem>
#include <fstream>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace prismesh::mesh::batch {
namespace {

using ::testing::HasSubstr;

class PlanTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("prismesh-plan-" + std::to_string(std::random_device{}()));
    std::filesystem::create_directories(folder_);
    for (const char* file : {"a.k", "b.k", "s.jsonl"}) std::ofstream(folder_ / file) << "";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  Result<Plan> parse(const std::string& text) const { return parse_plan(text, folder_ / "study.toml"); }
  /// The error's line and message.
  std::string refused(const std::string& text) const {
    const Result<Plan> plan = parse(text);
    if (plan) return "not refused";
    EXPECT_EQ(plan.error().file, (folder_ / "study.toml").string());
    return std::to_string(plan.error().line) + ": " + plan.error().message;
  }
  std::filesystem::path folder_;
};

const std::string kHead = "decks = [\"a.k\"]\nscripts = [\"s.jsonl\"]\n";

TEST_F(PlanTest, defaults_and_every_key) {
  const Result<Plan> plain = parse(kHead);
  ASSERT_TRUE(plain) << plain.error().text();
  EXPECT_EQ(plain->name, "study");
  EXPECT_EQ(plain->decks, (std::vector{folder_ / "a.k"}));
  EXPECT_EQ(plain->output, folder_ / "study.results");
  EXPECT_EQ(plain->sampling, Sampling::full);
  EXPECT_EQ(plain->repair, RepairScope::damaged);
  EXPECT_TRUE(plain->pictures && plain->penetrations);
  EXPECT_EQ(variant_count(*plain), 1U) << "a script without parameters has one set of values";

  const Result<Plan> all = parse(
      "name = \"Beads\"\ndecks = [\"a.k\", \"b.k\"]\nscripts = [\"s.jsonl\"]\nplan = \"sobol\"\nsamples = 8\nseed = 3\nrepair = \"none\"\n"
      "penetrations = false\npictures = false\nlength_unit = \"mm\"\ntarget_size = 5\ncriteria = \"strict\"\noutput = \"out\"\nmax_minutes "
      "= 1.5\n"
      "[parameters]\nheight = {from = 2, to = 12}\npart = [\"part:1\", \"part:2\"]\npitch = {values = [1, 2.5]}\n"
      "[slurm]\noptions = [\"--partition=long\"]\nmax_at_once = 20\nmax_tasks = 50\n");
  ASSERT_TRUE(all) << all.error().text();
  EXPECT_EQ(all->name, "Beads");
  EXPECT_EQ(all->sampling, Sampling::sobol);
  EXPECT_EQ(variant_count(*all), 16U);
  EXPECT_EQ(all->seed, 3U);
  EXPECT_EQ(all->repair, RepairScope::none);
  EXPECT_EQ(all->output, folder_ / "out");
  EXPECT_EQ(all->max_minutes, 1.5);
  ASSERT_EQ(all->parameters.size(), 3U);
  EXPECT_EQ(all->parameters[0].name, "height");
  EXPECT_TRUE(all->parameters[0].values.empty());
  EXPECT_EQ(all->parameters[1].values, (std::vector<ParameterValue>{"part:1", "part:2"}));
  EXPECT_EQ(all->parameters[2].values, (std::vector<ParameterValue>{1.0, 2.5}));
  EXPECT_EQ(all->slurm.options, (std::vector<std::string>{"--partition=long"}));
}

TEST_F(PlanTest, levels_divide_a_range) {
  const Result<Plan> plan = parse(kHead + "[parameters]\nheight = {from = 2, to = 12, levels = 6}\npitch = [1, 2]\n");
  ASSERT_TRUE(plan) << plan.error().text();
  EXPECT_EQ(plan->parameters[0].values, (std::vector<ParameterValue>{2.0, 4.0, 6.0, 8.0, 10.0, 12.0}));
  EXPECT_EQ(variant_count(*plan), 12U);
}

TEST_F(PlanTest, what_is_wrong_is_said_with_its_line) {
  const std::pair<std::string, std::string> wrong[] = {
      {"decks = [", "not TOML"},
      {"scripts = [\"s.jsonl\"]\n", "0: decks is missing: the plan names no deck"},
      {"decks = []\nscripts = [\"s.jsonl\"]\n", "1: decks must be a list of files"},
      {"decks = [\"a.k\",\n\"none.k\"]\nscripts = [\"s.jsonl\"]\n", "2: there is no file "},
      {"decks = [\"a.k\", \"./a.k\"]\nscripts = [\"s.jsonl\"]\n", "1: names "},
      {kHead + "decs = 1\n", "3: a plan has no \"decs\"; the nearest known is \"decks\""},
      {kHead + "plan = \"random\"\n", "3: plan must be one of full, latin-hypercube, sobol"},
      {kHead + "plan = \"sobol\"\n[parameters]\nx = {from = 1, to = 2}\n", "3: this plan needs samples"},
      {kHead + "plan = \"sobol\"\nsamples = 4\n", "3: this plan has no parameters"},
      {kHead + "samples = 4\n", "3: samples are for latin-hypercube and sobol"},
      {kHead + "[parameters]\nheight = []\n", "4: the parameter height has no values"},
      {kHead + "[parameters]\nheight = {levels = 3}\n", "4: the parameter height has no values: it needs values = [..], or from and to"},
      {kHead + "[parameters]\nheight = {from = 1, to = 2}\n", "4: the parameter height needs levels"},
      {kHead + "[parameters]\nheight = {values = [1], from = 1}\n", "4: the parameter height has both values and a range"},
      {kHead + "[parameters]\nheight = [true]\n", "4: a value of height must be a number or a text"},
      {kHead + "[parameters]\nheight = [nan]\n", "4: a value of height must be a number"},
      {kHead + "[parameters]\nheight = [9007199254740993]\n", "4: a value of height must be a number from -1e15 to 1e15"},
      {kHead + "[parameters]\nheight = {from = 0, to = 9007199254740993, levels = 2}\n",
       "4: height.to must be a number from -1e15 to 1e15"},
      {kHead + "max_minutes = 9007199254740993\n", "3: max_minutes must be a number from -1e15 to 1e15"},
      {kHead + "target_size = 9007199254740993\n", "3: target_size must be a number from -1e15 to 1e15"},
      {kHead + "[parameters]\n\"a b\" = [1]\n", "4: \"a b\" is no name of a parameter"},
      {kHead + "[parameters]\na = {from = 0, to = 1, levels = 1001}\nb = {from = 0, to = 1, levels = 1001}\n",
       "0: the plan has more than 1000000 variants"},
      {kHead + "repair = \"some\"\n", "3: repair must be one of none, damaged, all"},
      {kHead + "pictures = \"yes\"\n", "3: pictures must be true or false"},
      {kHead + "target_size = -1\n", "3: target_size must be"},
      {kHead + "length_unit = \"km\"\n", "3: length_unit must be mm, m or in"},
      {kHead + "criteria = \"none.toml\"\n", "3: there is no file of criteria "},
      {kHead + "max_minutes = 0\n", "3: max_minutes must be above 0"},
      {kHead + "output = 3\n", "3: output must be a text in quotes"},
      {kHead + "[slurm]\noptions = [\"-p long\"]\n", "4: options are those of sbatch in their long form"},
      {kHead + "[slurm]\nmax_tasks = 0\n", "4: max_tasks must be a whole number from 1"},
      {kHead + "[slurm]\nqueue = 1\n", "4: slurm has no \"queue\""},
  };
  for (const auto& [text, words] : wrong) EXPECT_THAT(refused(text), HasSubstr(words)) << text;
  std::string many = kHead + "plan = \"sobol\"\nsamples = 4\n[parameters]\n";
  for (char c = 'a'; c <= 'k'; ++c) many += std::string(1, c) + " = {from = 0, to = 1}\n";
  EXPECT_THAT(refused(many), HasSubstr("a sobol plan takes up to 10 parameters"));
}

}  // namespace
}  // namespace prismesh::mesh::batch
