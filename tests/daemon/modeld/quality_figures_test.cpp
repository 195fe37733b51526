// Quality figures and previews of edits, compared with the test's own counts.
#include "mesh/document/quality_figures.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/modeld/edit_preview.h"
#include "mesh/document/edit_json.h"
#include "mesh/document/open.h"
#include "mesh/document/prepare.h"
#include "mesh/model/adjacency.h"
#include "mesh/model/node_set.h"
#include "mesh/quality/limits.h"
#include "tests/daemon/modeld/folder.h"

namespace prismesh::modeld {
namespace {

using namespace mesh::document;
using mesh::quality::Metric;

constexpr std::int64_t kMiddle = 1313;  ///< a node with four shells around it

class Figures : public ::testing::Test {
 protected:
  void SetUp() override {
    Result<Document> opened = mesh::document::open(folder_.sheet(), {});
    ASSERT_TRUE(opened) << opened.error().text();
    document_ = std::move(*opened);
  }
  void lift(std::int64_t node, double by) { move(node, mesh::Vec3(0, 0, by)); }
  void move(std::int64_t node, const mesh::Vec3& by) {
    Translate edit;
    edit.by = {by.x(), by.y(), by.z()};
    edit.shaping.on = std::to_string(node);
    const auto done = apply(document_, edit);
    ASSERT_TRUE(done) << done.error().text();
  }
  /// From one node to another, or a share of the way.
  void move_towards(std::int64_t node, std::int64_t other, double share) {
    const mesh::Model& model = document_.current().model;
    move(node, share * (model.position(model.find_node(other)) - model.position(model.find_node(node))));
  }
  ipc::Quality figures(const std::string& metric = {}, bool damaged = false) const {
    const Result<ipc::Quality> made = quality_figures(document_, {metric, damaged});
    EXPECT_TRUE(made) << made.error().text();
    return made.value_or(ipc::Quality{});
  }
  std::set<std::int64_t> ids_at(std::int64_t node) const {
    const mesh::Model& model = document_.current().model;
    std::set<std::int64_t> ids;
    for (const mesh::ShellIndex shell : shells_touching(model, {model.find_node(node)})) ids.insert(model.shell_ids[shell.value]);
    return ids;
  }
  std::uint64_t count(Metric metric, bool fail) const {
    std::uint64_t counted = 0;
    const auto& quality = document_.current().quality;
    for (std::size_t s = 0; s < quality.size(); ++s) {
      const bool fails = (quality[s].fail >> int(metric) & 1) != 0, warns = (quality[s].warn >> int(metric) & 1) != 0;
      counted += fail ? fails : warns && !fails;
    }
    return counted;
  }

  test::Folder folder_;
  Document document_;
};

TEST_F(Figures, count_the_states_by_metric) {
  lift(kMiddle, 3);
  lift(kMiddle + 60, 1.1);
  const ipc::Quality quality = figures();
  EXPECT_EQ(quality.generation, document_.current().number);
  std::uint64_t wrong = 0;
  for (int m = 0; m < mesh::quality::kMetricCount; ++m) {
    const ipc::QualityMetric& metric = quality.metrics.at(static_cast<std::size_t>(m));
    EXPECT_EQ(metric.name, mesh::quality::name(static_cast<Metric>(m)));
    EXPECT_EQ(metric.warn, count(static_cast<Metric>(m), false)) << metric.name;
    EXPECT_EQ(metric.fail, count(static_cast<Metric>(m), true)) << metric.name;
    wrong += metric.warn + metric.fail;
  }
  EXPECT_GT(wrong, 0u) << "the edit must have done some harm";
  EXPECT_EQ(quality.error_count, document_.current().counts.warn + document_.current().counts.fail);
  ASSERT_EQ(quality.parts.size(), 1u);
  EXPECT_EQ(quality.parts[0].fail, document_.current().counts.fail);
  EXPECT_LT(quality.parts[0].least_composite, 0) << "something fails";
  EXPECT_GT(quality.parts[0].composite, quality.parts[0].least_composite);
}

TEST_F(Figures, the_worst_error_comes_first_with_its_value_and_position) {
  lift(kMiddle + 120, 1.2);
  lift(kMiddle, 4);
  const ipc::Quality quality = figures("warpage");
  ASSERT_GT(quality.errors.size(), 4u);
  const std::set<std::int64_t> expected = ids_at(kMiddle);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_TRUE(expected.contains(quality.errors[i].shell)) << i;
  for (std::size_t i = 1; i < quality.errors.size(); ++i) {
    EXPECT_GE(quality.errors[i - 1].fail, quality.errors[i].fail);
    EXPECT_GE(*quality.errors[i - 1].value, *quality.errors[i].value) << "one metric, no thickness: worse is more";
  }
  EXPECT_EQ(quality.errors[0].unit, "deg");
  const mesh::Model& model = document_.current().model;
  const auto& nodes = model.shell(model.find_shell(quality.errors[0].shell)).node;
  mesh::Vec3 centre = mesh::Vec3::Zero();
  for (const mesh::NodeIndex node : nodes) centre += 0.25 * model.position(node);
  EXPECT_NEAR((centre - mesh::Vec3(quality.errors[0].at[0], quality.errors[0].at[1], quality.errors[0].at[2])).norm(), 0, 1e-12);
}

TEST_F(Figures, every_bar_selects_as_many_shells_as_it_shows) {
  lift(kMiddle, 3);
  for (int m = 0; m < mesh::quality::kMetricCount; ++m) {
    const std::string metric(mesh::quality::name(static_cast<Metric>(m)));
    const ipc::Quality quality = figures(metric);
    std::uint64_t shown = 0, failing = 0;
    for (const ipc::QualityBar& bar : quality.bars) {
      ipc::FindShells find{metric, std::nullopt, std::nullopt, false};
      if (!bar.open_below) find.from = bar.from;
      if (!bar.open_above) find.to = bar.to;
      const Result<ipc::ShellsFound> found = find_shells(document_, find);
      ASSERT_TRUE(found);
      EXPECT_EQ(found->shells, bar.ok + bar.warn + bar.fail) << metric << " from " << bar.from << " to " << bar.to;
      shown += found->shells;
      failing += bar.fail;
    }
    const bool of_triangles = static_cast<Metric>(m) == Metric::min_angle_tri || static_cast<Metric>(m) == Metric::max_angle_tri;
    EXPECT_EQ(shown, of_triangles ? 0u : document_.current().model.shell_count()) << metric;
    EXPECT_EQ(failing, count(static_cast<Metric>(m), true)) << metric;
  }
}

TEST_F(Figures, bars_have_equal_width_end_at_the_limit_and_show_their_shells_states) {
  lift(kMiddle, 3);
  lift(kMiddle + 60, 1.1);
  const Metric metric = Metric::warpage;
  const ipc::Quality quality = figures("warpage");
  const std::vector<ipc::QualityBar>& bars = quality.bars;
  ASSERT_GT(bars.size(), 10u);
  const double width = bars[0].to - bars[0].from;
  const double min_failing = mesh::quality::threshold_of(judged_by(document_), metric, false, {}).fail_high;
  EXPECT_GT(bars.back().to, min_failing) << "what fails can be seen";
  std::uint64_t ok = 0, warn = 0, fail = 0;
  for (std::size_t b = 0; b < bars.size(); ++b) {
    EXPECT_NEAR(bars[b].to - bars[b].from, width, width * 1e-9);
    if (b > 0) {
      EXPECT_EQ(bars[b].from, bars[b - 1].to);
    }
    // All shells of a bar below the limit pass, all of a bar above it fail.
    if (b + 1 < bars.size() && bars[b].to <= min_failing) {
      EXPECT_EQ(bars[b].fail, 0u) << b;
    }
    if (bars[b].from > min_failing) {
      EXPECT_EQ(bars[b].ok + bars[b].warn, 0u) << b;
    }
    ok += bars[b].ok, warn += bars[b].warn, fail += bars[b].fail;
  }
  EXPECT_EQ(warn, count(metric, false));
  EXPECT_EQ(fail, count(metric, true));
  EXPECT_GT(warn, 0u);
  EXPECT_GT(fail, 0u);
  EXPECT_EQ(ok + warn + fail, document_.current().model.shell_count());
}

TEST_F(Figures, a_degenerate_shell_counts_as_a_defect_only) {
  lift(kMiddle + 60, 3);
  move_towards(kMiddle, kMiddle + 1, 1);  // two shells lose an edge
  const std::uint64_t shells = document_.current().model.shell_count();
  std::uint64_t failing = 0;
  const auto& states = document_.current().quality;
  for (std::size_t s = 0; s < states.size(); ++s) failing += !states[s].has_defect() && (states[s].fail >> int(Metric::aspect) & 1) != 0;
  EXPECT_EQ(count(Metric::aspect, true), failing + 2) << "the states show both";

  const ipc::Quality quality = figures("aspect");
  EXPECT_EQ(quality.metrics.at(std::size_t(Metric::aspect)).fail, failing);
  for (const ipc::QualityMetric& metric : quality.metrics)
    if (metric.name == "repeated_node") {
      EXPECT_EQ(metric.fail, 2u);
    }
  EXPECT_EQ(quality.error_count,
            quality.metrics.at(std::size_t(Metric::aspect)).fail + quality.metrics.at(std::size_t(Metric::aspect)).warn)
      << "as many to step through as are counted";
  std::uint64_t in_bars = 0;
  for (const ipc::QualityBar& bar : quality.bars) in_bars += bar.ok + bar.warn + bar.fail;
  EXPECT_EQ(in_bars, shells - 2);
  EXPECT_LT(quality.bars.back().to, 1e6) << "and no bar reaches for the value of a shell that is none";
  const auto found = find_shells(document_, {"aspect", std::nullopt, std::nullopt, false});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->shells, shells - 2);
  const ipc::Quality of_all = figures();
  ASSERT_GE(of_all.errors.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(of_all.errors[i].metric, "repeated_node") << "the worst of all comes first";
    EXPECT_TRUE(of_all.errors[i].fail);
    EXPECT_FALSE(of_all.errors[i].value) << "a defect has none";
    EXPECT_TRUE(ids_at(kMiddle).contains(of_all.errors[i].shell));
  }
}

/// Criteria may depend on thickness and material: then each shell has its own limit.
TEST_F(Figures, the_worst_is_worst_by_its_own_limit) {
  const std::filesystem::path file = folder_.path() / "thick.toml";
  std::ofstream(file) << "[metrics.min_length]\nfail_below_thicknesses = 5\n";  // of 0.8: below 4
  OpenOptions options;
  options.criteria = file;
  Result<Document> opened = mesh::document::open(folder_.sheet(), options);
  ASSERT_TRUE(opened) << opened.error().text();
  document_ = std::move(*opened);
  ASSERT_EQ(document_.current().counts.fail, 0u);
  move_towards(kMiddle - 200, kMiddle - 199, 0.3);
  move_towards(kMiddle, kMiddle + 1, 0.6);
  move_towards(kMiddle + 120, kMiddle + 121, 0.4);
  const ipc::Quality quality = figures();
  ASSERT_GE(quality.errors.size(), 6u);
  for (std::size_t i = 0; i < quality.errors.size(); ++i) {
    EXPECT_EQ(quality.errors[i].metric, "min_length");
    if (i > 0) {
      EXPECT_LE(*quality.errors[i - 1].value, *quality.errors[i].value) << i;
    }
  }
  EXPECT_TRUE(ids_at(kMiddle).contains(quality.errors[0].shell));
}

TEST_F(Figures, damage_is_what_the_edits_did) {
  EXPECT_EQ(figures("", true).error_count, 0u);
  lift(kMiddle, 3);
  const ipc::Quality quality = figures("", true);
  ASSERT_GT(quality.error_count, 0u);
  const std::set<std::int64_t> touched = ids_at(kMiddle);
  for (const ipc::QualityError& error : quality.errors) EXPECT_TRUE(touched.contains(error.shell)) << error.shell;
  ASSERT_TRUE(apply(document_, Undo{}));
  EXPECT_EQ(figures("", true).error_count, 0u);
}

/// Two by two quads about the middle become eight triangles or six at a node.
TEST_F(Figures, a_node_with_too_many_triangles_is_an_error_of_its_own) {
  const mesh::Model& model = document_.current().model;
  const mesh::NodeIndex middle = model.find_node(kMiddle);
  std::vector<std::string> about;
  for (const mesh::ShellIndex shell : model.adjacency->shells_of(middle))
    about.push_back("shell:" + std::to_string(model.shell_ids[shell.value]));
  ASSERT_EQ(about.size(), 4u);
  for (const std::string& shell : about) {
    mesh::document::Restructure split;
    split.operation = mesh::repair::Operation::split;
    split.at = {shell};
    const Result<ipc::EditPreviewed> would = preview_edit(document_, split);
    ASSERT_TRUE(would) << would.error().text();
    std::vector<std::array<double, 3>> shown;
    for (const ipc::PreviewedShell& each : would->shells)
      for (std::size_t k = 0; k < 3; ++k)
        if ((each.clusters >> k & 1U) != 0) shown.push_back(would->points[each.corners[k]]);
    ASSERT_TRUE(apply(document_, split));
    std::vector<std::array<double, 3>> made;
    for (const auto& cluster : *document_.current().clusters) {
      const mesh::Vec3& at = document_.current().model.position(cluster.node);
      made.push_back({at.x(), at.y(), at.z()});
    }
    EXPECT_EQ(shown, made) << "the preview shows what the edit makes";
  }
  const auto& clusters = *document_.current().clusters;
  ASSERT_EQ(clusters.size(), 1u);
  for (const bool damaged : {false, true}) {
    const ipc::Quality quality = figures("", damaged);
    EXPECT_EQ(quality.metrics.back().name, "triangle_clusters");
    EXPECT_EQ(quality.metrics.back().warn, 1u);
    ASSERT_EQ(quality.error_count, 1u) << "the triangles themselves pass";
    const ipc::QualityError& error = quality.errors[0];
    EXPECT_EQ(error.metric, "triangle_clusters");
    EXPECT_EQ(error.node, kMiddle);
    EXPECT_FALSE(error.fail);
    EXPECT_EQ(error.value, static_cast<double>(clusters[0].triangles));
    EXPECT_GT(*error.value, 3);
    const mesh::Vec3& at = document_.current().model.position(middle);
    EXPECT_EQ(error.at, (std::array<double, 3>{at.x(), at.y(), at.z()}));
    EXPECT_TRUE(document_.current().model.shell(document_.current().model.find_shell(error.shell)).is_triangle());
  }
  EXPECT_EQ(figures("warpage").error_count, 0u) << "it is of no metric";
}

TEST_F(Figures, an_unknown_metric_is_refused_with_the_nearest) {
  const auto refused = quality_figures(document_, {"warpege", false});
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("\"warpage\""), std::string::npos);
  const auto not_found = find_shells(document_, {"warpege", std::nullopt, std::nullopt, false});
  ASSERT_FALSE(not_found);
  EXPECT_EQ(not_found.error().text(), refused.error().text());
}

TEST_F(Figures, warnings_come_after_errors_in_the_decks_order) {
  const std::filesystem::path file = folder_.path() / "own.toml";
  std::ofstream(file) << "[metrics.warpage]\nwarn_above = 2\n";
  OpenOptions options;
  options.criteria = file;
  Result<Document> opened = mesh::document::open(folder_.sheet(), options);
  ASSERT_TRUE(opened) << opened.error().text();
  document_ = std::move(*opened);
  lift(kMiddle, 6);
  lift(kMiddle - 120, 3);
  const ipc::Quality quality = figures("warpage");
  ASSERT_GE(quality.errors.size(), 8u);
  for (const ipc::QualityError& error : quality.errors) EXPECT_FALSE(error.fail) << error.shell;
  EXPECT_TRUE(std::is_sorted(quality.errors.begin(), quality.errors.end(),
                             [](const auto& one, const auto& other) { return one.shell < other.shell; }));
}

TEST_F(Figures, the_worst_comes_first_if_warn_and_fail_limits_are_equal) {
  for (const char* text : {"[metrics.warpage]\nwarn_above = 2\nfail_above = 2\n", "[metrics.warpage]\nwarn_above = 2\nfail_above = 9\n"}) {
    const std::filesystem::path file = folder_.path() / "own.toml";
    std::ofstream(file, std::ios::trunc) << text;
    OpenOptions options;
    options.criteria = file;
    Result<Document> opened = mesh::document::open(folder_.sheet(), options);
    ASSERT_TRUE(opened) << text << opened.error().text();
    document_ = std::move(*opened);
    lift(kMiddle - 120, 3);  // the smaller deviation comes first in the deck
    lift(kMiddle, 6);
    const ipc::Quality quality = figures("warpage");
    ASSERT_GE(quality.errors.size(), 8u) << text;
    EXPECT_TRUE(quality.errors.front().fail) << text;
    EXPECT_TRUE(ids_at(kMiddle).contains(quality.errors.front().shell)) << text;
    for (std::size_t i = 1; i < quality.errors.size(); ++i) EXPECT_GE(*quality.errors[i - 1].value, *quality.errors[i].value) << text << i;
  }
}

TEST_F(Figures, a_preview_reports_an_edits_effect_and_changes_nothing) {
  const std::uint64_t number = document_.current().number;
  const std::set<std::int64_t> touched = ids_at(kMiddle);
  Translate edit;
  edit.by = {0, 0, 3};
  edit.shaping.on = std::to_string(kMiddle);
  const Result<ipc::EditPreviewed> preview = preview_edit(document_, edit);
  ASSERT_TRUE(preview) << preview.error().text();
  EXPECT_EQ(document_.current().number, number);
  EXPECT_FALSE(document_.can_undo());
  EXPECT_EQ(preview->generation, number);
  EXPECT_EQ(std::set(preview->replaced.begin(), preview->replaced.end()), touched);
  EXPECT_EQ(preview->shell_count, touched.size());
  EXPECT_EQ(preview->points.size(), 9u) << "four quads about a node";
  ASSERT_TRUE(apply(document_, edit));
  const mesh::Model& model = document_.current().model;
  for (const ipc::PreviewedShell& shell : preview->shells) {
    const mesh::ShellIndex index = model.find_shell(shell.shell);
    EXPECT_EQ(shell.fail, document_.current().quality[index.value].fail);
    EXPECT_EQ(shell.warn, document_.current().quality[index.value].warn);
    for (std::size_t k = 0; k < 4; ++k) {
      const auto& at = preview->points.at(shell.corners.at(k));
      EXPECT_EQ(mesh::Vec3(at[0], at[1], at[2]), model.position(model.shell(index).node[k]));
    }
  }
}

TEST_F(Figures, a_preview_of_a_split_shows_the_shells_that_it_makes) {
  const Edit edit = parse_edit(R"({"edit":"split","at":["shell:64"]})").value();
  const Result<ipc::EditPreviewed> preview = preview_edit(document_, edit);
  ASSERT_TRUE(preview) << preview.error().text();
  EXPECT_EQ(preview->shell_count, 2u);
  EXPECT_EQ(preview->points.size(), 4u);
  EXPECT_EQ(preview->replaced, (std::vector<std::int64_t>{64}));
  std::set<std::int64_t> shown;
  for (const ipc::PreviewedShell& shell : preview->shells) {
    shown.insert(shell.shell);
    EXPECT_EQ(shell.corners.at(2), shell.corners.at(3)) << "a triangle";
  }
  EXPECT_EQ(shown.size(), 2u);
  EXPECT_TRUE(shown.contains(64));
}

TEST_F(Figures, a_preview_skips_shells_whose_corners_have_no_position) {
  // A corner of two of the node's shells has no position.
  auto broken = std::make_shared<Generation>(document_.current());
  const std::set<std::int64_t> touched = ids_at(kMiddle), nowhere = ids_at(kMiddle + 1);
  broken->model.positions.set(broken->model.find_node(kMiddle + 1).value, mesh::Vec3::Constant(std::nan("")));
  document_.generations.back() = broken;
  Translate edit;
  edit.by = {0, 0, 3};
  edit.shaping.on = std::to_string(kMiddle);
  const Result<ipc::EditPreviewed> preview = preview_edit(document_, edit);
  ASSERT_TRUE(preview) << preview.error().text();
  std::set<std::int64_t> shown;
  for (const ipc::PreviewedShell& shell : preview->shells) {
    shown.insert(shell.shell);
    for (std::size_t k = 0; k < 4; ++k) {
      const mesh::NodeIndex node = broken->model.shell(broken->model.find_shell(shell.shell)).node[k];
      if (broken->model.node_ids[node.value] == kMiddle) continue;
      const auto& at = preview->points.at(shell.corners.at(k));
      EXPECT_EQ(mesh::Vec3(at[0], at[1], at[2]), broken->model.position(node)) << shell.shell;
    }
  }
  std::set<std::int64_t> expected;
  std::set_difference(touched.begin(), touched.end(), nowhere.begin(), nowhere.end(), std::inserter(expected, expected.end()));
  EXPECT_EQ(expected.size(), 2u);
  EXPECT_EQ(shown, expected);
}

TEST_F(Figures, an_impossible_edit_is_refused_with_its_own_message) {
  Translate edit;
  edit.by = {0, 0, 3};
  edit.shaping.on = "99999999";
  const auto preview = preview_edit(document_, edit);
  const auto done = apply(document_, edit);
  ASSERT_FALSE(preview);
  ASSERT_FALSE(done);
  EXPECT_EQ(preview.error().text(), done.error().text());
}

}  // namespace
}  // namespace prismesh::modeld
