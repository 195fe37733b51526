// Fields as clients get them, compared with values that the test computes from the decks' text: every node, every triangle.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <thread>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "daemon/modeld/daemon.h"
#include "ipc/model/client.h"
#include "mesh/document/edit_json.h"
#include "tests/daemon/modeld/folder.h"

namespace prismesh::modeld {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using Vec = Eigen::Vector3d;

constexpr auto kFieldPatience = 60s;
constexpr int kSide = 14;
constexpr double kNear = 2e-6;  ///< decks hold six decimals, values are floats

/// The distance to a triangle, from its plane and its three sides.
double distance_to_triangle(const Vec& p, const Vec& a, const Vec& b, const Vec& c) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
    const Vec side = to - from;
    const double t = std::clamp((p - from).dot(side) / side.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (p - from - t * side).norm());
  }
  const Vec normal = (b - a).cross(c - a).normalized();
  const Vec foot = p - (p - a).dot(normal) * normal;
  const bool inside =
      normal.dot((b - a).cross(foot - a)) >= 0 && normal.dot((c - b).cross(foot - b)) >= 0 && normal.dot((a - c).cross(foot - c)) >= 0;
  return inside ? std::min(least, (p - foot).norm()) : least;
}

/// A deck of a grid and its content, written by the test without the project's readers.
struct Grid {
  fs::path path;
  std::vector<Vec> nodes;  ///< row by row
  std::vector<std::array<std::size_t, 3>> triangles;
};
template <class Place>
Grid write_grid(const fs::path& path, int first_id, int side, const Place& place) {
  Grid grid{path, {}, {}};
  std::FILE* file = std::fopen(path.c_str(), "w");
  std::fprintf(file, "*KEYWORD\n*PART\nsheet\n         1         1         1\n*NODE\n");
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column) {
      Vec at = place(column, row);
      for (double& each : at) each = std::round(each * 1e6) / 1e6;
      std::fprintf(file, "%8d%16.6f%16.6f%16.6f\n", first_id + row * side + column, at.x(), at.y(), at.z());
      grid.nodes.push_back(at);
    }
  std::fprintf(file, "*ELEMENT_SHELL\n");
  for (int row = 0; row + 1 < side; ++row)
    for (int column = 0; column + 1 < side; ++column) {
      const int n = row * side + column, id = first_id + n;
      std::fprintf(file, "%8d%8d%8d%8d%8d%8d\n", id, 1, id, id + 1, id + side + 1, id + side);
      const auto at = static_cast<std::size_t>(n), up = static_cast<std::size_t>(n + side);
      grid.triangles.push_back({at, at + 1, up + 1});
      grid.triangles.push_back({at, up + 1, up});
    }
  std::fprintf(file, "*END\n");
  std::fclose(file);
  return grid;
}
Vec wavy(int column, int row) { return {5.0 * column, 5.0 * row, 4 * std::sin(0.5 * column) * std::cos(0.3 * row)}; }
Vec flatter(int column, int row) { return {4.7 * column - 1.3, 5.2 * row, 3 * std::sin(0.5 * column + 0.2) + 0.1 * row}; }

double distance_to(const Grid& grid, const Vec& point) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [a, b, c] : grid.triangles)
    least = std::min(least, distance_to_triangle(point, grid.nodes[a], grid.nodes[b], grid.nodes[c]));
  return least;
}

class Fields : public ::testing::Test {
 protected:
  void SetUp() override {
    daemon_.emplace(Daemon::start({folder_.path() / "run", folder_.state()}).value());
    thread_ = std::thread([this] { daemon_->run(); });
    client_.emplace(ipc::Client::connect(ipc::model_socket_path(folder_.path() / "run"), "test").value());
    wavy_ = write_grid(folder_.path() / "wavy.k", 1, kSide, wavy);
  }
  void TearDown() override {
    client_.reset();
    daemon_->stop();
    thread_.join();
  }
  void open(std::optional<std::string> unit = {}) {
    ipc::Open request;
    request.path = wavy_.path.string();
    request.length_unit = unit;
    const auto opened = client_->call(request, kFieldPatience);
    ASSERT_TRUE(opened) << opened.error().text();
  }
  std::uint64_t edit(const std::string& json) {
    const auto parsed = mesh::document::parse_edit(json);
    EXPECT_TRUE(parsed) << json;
    const auto edited = client_->call(ipc::ApplyEdit{*parsed}, kFieldPatience);
    EXPECT_TRUE(edited) << json << ": " << edited.error().text();
    return edited ? std::get<ipc::Edited>(*edited).generation : 0;
  }
  struct Got {
    ipc::FieldMade made;
    std::vector<float> values;
  };
  Got get(const ipc::GetField& request) {
    const auto answer = client_->call(request, kFieldPatience);
    EXPECT_TRUE(answer) << answer.error().text();
    if (!answer) return {};
    const auto& made = std::get<ipc::FieldMade>(*answer);
    const auto taken = client_->take_field(made);
    EXPECT_TRUE(taken) << taken.error().text();
    EXPECT_EQ((*taken)->generation(), made.generation);
    EXPECT_EQ((*taken)->on_nodes(), made.on_nodes);
    const auto values = (*taken)->values();
    return {made, {values.begin(), values.end()}};
  }
  std::string refusal(const ipc::GetField& request) {
    const auto answer = client_->call(request, kFieldPatience);
    EXPECT_FALSE(answer);
    return answer ? "" : answer.error().text();
  }
  /// The nodes' present positions, as every view sees them.
  std::vector<Vec> places() {
    const auto view = client_->snapshot().value();
    std::vector<Vec> all;
    for (std::size_t n = 0; n < view->node_count(); ++n) all.push_back(view->position(n));
    return all;
  }
  /// Checks values by node, and the figures that belong to them.
  void expect_field(const Got& got, const std::vector<double>& expected) {
    ASSERT_EQ(got.values.size(), expected.size());
    double sum = 0;
    for (std::size_t n = 0; n < expected.size(); ++n) {
      EXPECT_NEAR(got.values[n], expected[n], kNear * (1 + expected[n])) << "node " << n + 1;
      sum += expected[n];
    }
    const auto [least, most] = std::minmax_element(expected.begin(), expected.end());
    EXPECT_EQ(got.made.measured, expected.size());
    EXPECT_NEAR(got.made.min, *least, kNear);
    EXPECT_NEAR(got.made.max, *most, kNear * (1 + *most));
    EXPECT_NEAR(got.made.mean, sum / static_cast<double>(expected.size()), kNear);
    EXPECT_EQ(got.made.max_at, "node:" + std::to_string(most - expected.begin() + 1));
    EXPECT_EQ(got.made.shells_without, 0u);
  }

  test::Folder folder_;
  std::optional<Daemon> daemon_;
  std::thread thread_;
  std::optional<ipc::Client> client_;
  Grid wavy_;
};

TEST_F(Fields, displacement_is_how_far_each_node_is_from_the_decks_text) {
  open();
  const std::uint64_t first = edit(R"({"edit":"translate","by":[0.5,-1,2],"on":"60-75"})");
  const std::vector<Vec> after_first = places();
  edit(R"({"edit":"lift","distance":3,"on":"90-110"})");
  const std::vector<Vec> now = places();
  std::vector<double> expected;
  for (std::size_t n = 0; n < now.size(); ++n) expected.push_back((now[n] - wavy_.nodes[n]).norm());
  EXPECT_GT(*std::max_element(expected.begin(), expected.end()), 2.9);
  const Got got = get({});
  expect_field(got, expected);
  EXPECT_EQ(got.made.unit, "mm");
  EXPECT_EQ(got.made.clear, 1);
  EXPECT_EQ(got.made.full, 5);
  EXPECT_EQ(got.made.against, "the deck as it was opened");
  // From the state in between, only the second edit counts.
  ipc::GetField between;
  between.against_generation = first;
  for (std::size_t n = 0; n < now.size(); ++n) expected[n] = (now[n] - after_first[n]).norm();
  expect_field(get(between), expected);
  // From the deck to an older state, only the first edit counts.
  ipc::GetField older;
  older.generation = first;
  for (std::size_t n = 0; n < now.size(); ++n) expected[n] = (after_first[n] - wavy_.nodes[n]).norm();
  expect_field(get(older), expected);
}

TEST_F(Fields, distance_from_another_decks_surface_is_the_min_over_all_its_triangles) {
  const Grid other = write_grid(folder_.path() / "other.k", 5001, kSide, flatter);
  open();
  edit(R"({"edit":"translate","by":[0,0,1.5],"on":"60-75"})");
  const std::vector<Vec> now = places();
  std::vector<double> expected;
  for (const Vec& at : now) expected.push_back(distance_to(other, at));
  const std::vector<double> expected_of_other = expected;
  ipc::GetField request;
  request.field = "distance-to-original";
  request.against = other.path.string();
  const Got got = get(request);
  expect_field(got, expected);
  EXPECT_EQ(got.made.against, "other.k");
  EXPECT_EQ(got.made.clear, 0.05);
  // The deck is read again after it has changed.
  const Grid moved = write_grid(other.path, 5001, kSide, [](int column, int row) { return Vec(flatter(column, row) + Vec(0, 0, 7)); });
  fs::last_write_time(other.path, fs::last_write_time(other.path) + 2s);
  for (std::size_t n = 0; n < now.size(); ++n) expected[n] = distance_to(moved, now[n]);
  expect_field(get(request), expected);
  // It is also read again if only an include has changed.
  const Grid included = write_grid(folder_.path() / "included.k", 5001, kSide, flatter);
  std::ofstream(other.path) << "*KEYWORD\n*INCLUDE\nincluded.k\n*END\n";
  expect_field(get(request), expected_of_other);
  const Grid again = write_grid(included.path, 5001, kSide, [](int column, int row) { return Vec(flatter(column, row) + Vec(0, 0, 3)); });
  for (std::size_t n = 0; n < now.size(); ++n) expected[n] = distance_to(again, now[n]);
  expect_field(get(request), expected);
  // The same ids at other positions: displacement is matched by id.
  const Grid same_ids = write_grid(folder_.path() / "same_ids.k", 1, kSide, flatter);
  request.field = "displacement";
  request.against = same_ids.path.string();
  for (std::size_t n = 0; n < now.size(); ++n) expected[n] = (now[n] - same_ids.nodes[n]).norm();
  expect_field(get(request), expected);
}

TEST_F(Fields, distance_from_the_opened_surface_is_the_min_over_all_its_triangles) {
  open();
  edit(R"({"edit":"lift","distance":2.5,"on":"80-120"})");
  edit(R"({"edit":"translate","by":[1,0.5,0],"on":"30-40"})");
  const std::vector<Vec> now = places();
  std::vector<double> expected;
  for (const Vec& at : now) expected.push_back(distance_to(wavy_, at));
  ipc::GetField request;
  request.field = "distance-to-original";
  expect_field(get(request), expected);
}

TEST_F(Fields, distance_of_two_expressions_is_from_nodes_to_shells) {
  open();
  ipc::GetField request;
  request.field = "distance";
  request.from = "node:1-14";
  request.to = "shell:155-181";
  const Got got = get(request);
  for (std::size_t n = 0; n < wavy_.nodes.size(); ++n) {
    if (n >= 14) {
      EXPECT_TRUE(std::isnan(got.values[n]));
      continue;
    }
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [a, b, c] : wavy_.triangles)
      if (a >= 154 && a <= 180)
        least = std::min(least, distance_to_triangle(wavy_.nodes[n], wavy_.nodes[a], wavy_.nodes[b], wavy_.nodes[c]));
    EXPECT_NEAR(got.values[n], least, kNear * least) << n;
  }
  EXPECT_EQ(got.made.measured, 14u);
  EXPECT_EQ(got.made.of.find("node:1-14 of "), 0u) << got.made.of;
  EXPECT_EQ(got.made.against, "shell:155-181");
  EXPECT_EQ(got.made.shells_without, 0u) << "the others aren't meant to have a value";
}

TEST_F(Fields, new_nodes_are_measured_from_between_their_source_nodes) {
  open();
  edit(R"({"edit":"translate","by":[0,0,2],"on":"1-196","falloff":{"profile":"constant"}})");
  edit(R"({"edit":"split","at":["shell:64","shell:65"]})");
  const std::vector<Vec> now = places();
  ASSERT_GT(now.size(), wavy_.nodes.size()) << "the split of two shells makes nodes";
  const Got got = get({});
  EXPECT_EQ(got.made.measured, wavy_.nodes.size()) << "as `diff` of the saved deck counts them";
  EXPECT_EQ(got.made.new_nodes, now.size() - wavy_.nodes.size());
  EXPECT_EQ(got.made.shells_without, 0u);
  for (std::size_t n = 0; n < wavy_.nodes.size(); ++n) EXPECT_NEAR(got.values[n], (now[n] - wavy_.nodes[n]).norm(), kNear);
  double farthest = 0;
  // A new node in the middle of an edge was made from its ends; the test finds the edge by itself.
  for (std::size_t n = wavy_.nodes.size(); n < now.size(); ++n) {
    double least = std::numeric_limits<double>::infinity(), expected = -1;
    for (std::size_t a = 0; a < wavy_.nodes.size(); ++a)
      for (std::size_t b = 0; b < a; ++b) {
        if ((wavy_.nodes[a] - wavy_.nodes[b]).norm() > 6.5) continue;
        if (const double off = (0.5 * (now[a] + now[b]) - now[n]).norm(); off < least) {
          least = off;
          expected = (now[n] - 0.5 * (wavy_.nodes[a] + wavy_.nodes[b])).norm();
        }
      }
    ASSERT_LT(least, 0.2) << "the middle of two neighbours, and a little off it where the surface is round";
    EXPECT_NEAR(got.values[n], expected, kNear) << n;
    farthest = std::max(farthest, expected);
  }
  EXPECT_GT(farthest, 0.9) << "the ends of one at least were moved";
}

TEST_F(Fields, counts_shells_with_a_missing_value) {
  open();
  edit(R"({"edit":"split","at":["shell:64"]})");
  ipc::GetField warpage;
  warpage.field = "metric:warpage";
  const Got got = get(warpage);
  EXPECT_FALSE(got.made.on_nodes);
  EXPECT_EQ(got.made.shells_without, 2u) << "triangles have no warpage";
  EXPECT_EQ(got.made.measured, static_cast<std::uint64_t>((kSide - 1) * (kSide - 1) - 1));
}

TEST_F(Fields, limits_are_the_same_lengths_in_a_deck_in_metres) {
  open("m");
  edit(R"({"edit":"translate","by":[0,0,0.002],"on":"60-75"})");
  const Got displacement = get({});
  EXPECT_EQ(displacement.made.unit, "m");
  EXPECT_DOUBLE_EQ(displacement.made.clear, 0.001);
  EXPECT_DOUBLE_EQ(displacement.made.full, 0.005);
  ipc::GetField request;
  request.field = "distance-to-original";
  const Got distance = get(request);
  EXPECT_DOUBLE_EQ(distance.made.clear, 0.00005);
  EXPECT_DOUBLE_EQ(distance.made.full, 0.001);
}

TEST_F(Fields, refuses_impossible_fields_with_a_sentence) {
  EXPECT_NE(refusal({}).find("no document"), std::string::npos);
  open();
  ipc::GetField request;
  request.field = "displacment";
  EXPECT_NE(refusal(request).find("the nearest is \"displacement\""), std::string::npos);
  request.field = "displacement";
  request.generation = 77;
  EXPECT_NE(refusal(request).find("no state 77"), std::string::npos);
  request.generation.reset();
  request.against = "other.k";
  EXPECT_NE(refusal(request).find("absolute path"), std::string::npos);
  request.against = (folder_.path() / "gone.k").string();
  EXPECT_NE(refusal(request).find("gone.k"), std::string::npos);
  request.against = write_grid(folder_.path() / "other.k", 5001, 3, flatter).path.string();
  EXPECT_NE(refusal(request).find("no node in common"), std::string::npos);
  request = {};
  request.field = "distance";
  request.from = "part:9";
  request.to = "part:1";
  EXPECT_FALSE(refusal(request).empty());
}

}  // namespace
}  // namespace prismesh::modeld
