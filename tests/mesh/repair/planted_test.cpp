// Defects planted in good meshes: all are found, all are repaired, and the shape stays what it was.
#include <set>

#include <gtest/gtest.h>

#include "mesh/quality/judge.h"
#include "mesh/quality/measure.h"
#include "mesh/quality/metrics.h"
#include "tests/mesh/repair/sheets.h"
#include "tests/mesh/repair/validator.h"

namespace prismesh::mesh::repair {
namespace {

using Shells = std::vector<std::array<std::size_t, 4>>;
struct Mesh {
  std::vector<Vec3> positions;
  Shells shells;
  Model model() const { return model_of(positions, shells); }
};

quality::Grade grade_of(const Model& model, ShellIndex shell) {
  std::vector<Vec3> corners;
  for (int i = 0; i < model.shell(shell).corners(); ++i)
    corners.push_back(model.position(model.shell(shell).node[static_cast<std::size_t>(i)]));
  return quality::judge(quality::measure(corners), {quality::default_criteria(), 1.0}).grade();
}

ShellSet bad_shells(const Model& model, quality::Grade least) {
  ShellSet bad;
  for (const ShellIndex shell : all_shells(model))
    if (grade_of(model, shell) >= least) bad.push_back(shell);
  return bad;
}

struct Mended {
  Model model;
  Repaired repaired;
};

/// Repairs all bad shells; the surface is that of `good`.
Mended mend(const Model& bad, const Model& good, const Rules& rules = {}) {
  const relax::ReferenceSurface surface(good, all_shells(good), 30);
  const quality::SizedCriteria criteria{quality::default_criteria(), 1.0};
  Options options;
  options.max_triangles_percent = 25;  // of a hundred shells
  Result<Repaired> repaired = repair({bad, surface, rules, criteria, options}, bad_shells(bad, quality::Grade::warn));
  EXPECT_TRUE(repaired.has_value());
  return {carried_out(bad, repaired->change), std::move(*repaired)};
}

void expect_same_shape(const Model& before, const Model& after, double area_tolerance = 0.005) {
  const Shape a = shape_of(before), b = shape_of(after);
  EXPECT_EQ(what_is_wrong(after), "");
  EXPECT_EQ(a.euler, b.euler);
  EXPECT_EQ(a.free_loops, b.free_loops);
  EXPECT_EQ(a.pieces, b.pieces);
  EXPECT_EQ(a.most_shells_an_edge, b.most_shells_an_edge);
  EXPECT_NEAR(a.free_length, b.free_length, 1e-3 * a.free_length);
  EXPECT_NEAR(a.junction_length, b.junction_length, 1e-6 * a.junction_length);
  EXPECT_NEAR(a.crease_length, b.crease_length, 1e-6 * a.crease_length);
  EXPECT_NEAR(a.area, b.area, area_tolerance * a.area);
}

/// A defect: what it does to a mesh at a grid's place.
struct Defect {
  const char* name;
  void (*plant)(Mesh& mesh, const Grid& grid, std::size_t i, std::size_t j);
};

/// Two neighbouring nodes of a row nearly meet.
void plant_short_edge(Mesh& mesh, const Grid& grid, std::size_t i, std::size_t j) {
  const double x = static_cast<double>(i), y = static_cast<double>(j);
  mesh.positions[grid.node(i, j)] = grid.place(x + 0.45, y);
  mesh.positions[grid.node(i + 1, j)] = grid.place(x + 0.55, y);
}
/// A quad's diagonal is so long that the corner across is nearly straight.
void plant_sliver(Mesh& mesh, const Grid& grid, std::size_t i, std::size_t j) {
  const std::size_t shell = grid.shell(i, j);
  const auto q = mesh.shells[shell];
  mesh.shells[shell] = {q[0], q[1], q[2], q[2]};
  mesh.shells.push_back({q[0], q[2], q[3], q[3]});
  mesh.positions[q[1]] = grid.place(static_cast<double>(i) + 0.6, static_cast<double>(j) + 0.4);
}
/// A quad with a triangle's shape: one corner on the line between its neighbours.
void plant_flat_corner(Mesh& mesh, const Grid& grid, std::size_t i, std::size_t j) {
  mesh.positions[grid.node(i + 1, j + 1)] = grid.place(static_cast<double>(i) + 0.5, static_cast<double>(j) + 0.5);
}
/// The quad's triangles.
void plant_pair(Mesh& mesh, const Grid& grid, std::size_t i, std::size_t j) {
  const std::size_t shell = grid.shell(i, j);
  const auto q = mesh.shells[shell];
  mesh.shells[shell] = {q[0], q[1], q[2], q[2]};
  mesh.shells.push_back({q[0], q[2], q[3], q[3]});
  // The triangles' corners become sharper than those of the quad.
  mesh.positions[q[2]] = grid.place(static_cast<double>(i) + 1.42, static_cast<double>(j) + 1.42);
}
/// A corner stands out of the sheet, and the sheet is meant so.
void plant_warped(Mesh& mesh, const Grid& grid, std::size_t i, std::size_t j) { mesh.positions[grid.node(i, j)] += Vec3(0.25, 0.1, 0.25); }
/// Two quads divided along the wrong edge of their hexagon.
void plant_wrong_edge(Mesh& mesh, const Grid& grid, std::size_t i, std::size_t j) {
  const std::size_t left = grid.shell(i, j), right = grid.shell(i + 1, j);
  const auto a = mesh.shells[left], b = mesh.shells[right];
  mesh.shells[left] = {a[0], a[1], b[1], b[2]};
  mesh.shells[right] = {a[0], b[2], b[3], a[3]};
}
/// Four quads in a row whose nodes lie two and a half times as far apart as they ought to.
void plant_stretched(Mesh& mesh, const Grid& grid, std::size_t, std::size_t) {
  for (std::size_t n = 0; n < mesh.positions.size(); ++n) {
    const double x = static_cast<double>(n % (grid.columns + 1)), y = static_cast<double>(n / (grid.columns + 1));
    mesh.positions[n] = grid.place(x <= 5 ? x : x <= 6 ? 5 + 2.6 * (x - 5) : x + 1.6, y);
  }
}

struct Place {
  const char* name;
  Grid (*grid)();
  std::size_t i, j;
};

class Planted : public testing::TestWithParam<std::tuple<Defect, Place>> {};

TEST_P(Planted, is_found_and_repaired) {
  const auto& [defect, place] = GetParam();
  const Grid grid = place.grid();
  Mesh mesh{grid.positions(), grid.shells()};
  const Model good = mesh.model();
  ASSERT_TRUE(bad_shells(good, quality::Grade::warn).empty());
  defect.plant(mesh, grid, place.i, place.j);
  const Model bad = mesh.model();
  const ShellSet failing = bad_shells(bad, quality::Grade::fail);
  ASSERT_FALSE(failing.empty());
  const bool is_meant = defect.plant == plant_warped || defect.plant == plant_stretched;
  const Mended mended = mend(bad, is_meant ? bad : good);
  EXPECT_GE(mended.repaired.bad_before, failing.size());
  EXPECT_EQ(bad_shells(mended.model, quality::Grade::fail).size(), 0U);
  EXPECT_TRUE(mended.repaired.unrepaired.empty());
  // Where one quad alone is warped its triangles may have no other place.
  EXPECT_LE(triangle_pairs(mended.model), triangle_pairs(bad) + (defect.plant == plant_warped ? 1 : 0));
  expect_same_shape(is_meant ? bad : good, mended.model);
}

INSTANTIATE_TEST_SUITE_P(Repair, Planted,
                         testing::Combine(testing::Values(Defect{"short_edge", plant_short_edge}, Defect{"sliver", plant_sliver},
                                                          Defect{"flat_corner", plant_flat_corner}, Defect{"pair", plant_pair},
                                                          Defect{"wrong_edge", plant_wrong_edge}, Defect{"warped", plant_warped},
                                                          Defect{"stretched", plant_stretched}),
                                          testing::Values(Place{"flat", [] { return flat(); }, 5, 5}, Place{"cylinder", cylinder, 9, 5},
                                                          Place{"l_profile", l_profile, 5, 10})),
                         [](const auto& planted) {
                           return std::string(std::get<0>(planted.param).name) + "_on_" + std::get<1>(planted.param).name;
                         });

TEST(PlantedTogether, are_all_repaired) {
  const Grid grid = flat(16, 16);
  Mesh mesh{grid.positions(), grid.shells()};
  const Model good = mesh.model();
  plant_short_edge(mesh, grid, 3, 3);
  plant_wrong_edge(mesh, grid, 10, 3);
  plant_flat_corner(mesh, grid, 3, 10);
  plant_sliver(mesh, grid, 11, 11);
  plant_pair(mesh, grid, 7, 7);
  const Mended mended = mend(mesh.model(), good);
  EXPECT_TRUE(bad_shells(mended.model, quality::Grade::fail).empty());
  EXPECT_TRUE(mended.repaired.unrepaired.empty());
  expect_same_shape(good, mended.model);
}

TEST(PlantedTogether, give_the_same_result_every_time) {
  const Grid grid = cylinder();
  Mesh mesh{grid.positions(), grid.shells()};
  const Model good = mesh.model();
  plant_short_edge(mesh, grid, 3, 3);
  plant_wrong_edge(mesh, grid, 10, 3);
  const Mended once = mend(mesh.model(), good), again = mend(mesh.model(), good);
  ASSERT_EQ(once.model.shell_count(), again.model.shell_count());
  for (std::size_t s = 0; s < once.model.shell_count(); ++s) EXPECT_EQ(once.model.shell_nodes[s], again.model.shell_nodes[s]);
  ASSERT_EQ(once.model.node_count(), again.model.node_count());
  for (std::size_t n = 0; n < once.model.node_count(); ++n) EXPECT_EQ(once.model.positions[n], again.model.positions[n]);
}

TEST(PlantedOnATube, a_narrow_strip_stays_where_longer_edges_would_leave_the_surface) {
  // Edges of 1 on a radius of 3 are 0.042 off in their middles; those beside a strip that goes would be 0.05 off. Nodes can't go elsewhere.
  constexpr double kTube = 3;
  const auto place = [](double x, double y) {
    const double along = x <= 4 ? x : x - 0.9;  // the fifth column is a tenth wide
    return Vec3(kTube * std::sin(along / kTube), y, kTube * std::cos(along / kTube));
  };
  const Grid grid{8, 8, place, {}};
  const Model model = model_of(grid.positions(), grid.shells());
  const relax::ReferenceSurface surface(model, all_shells(model), 30);
  const quality::SizedCriteria criteria{quality::default_criteria(), 1.0};
  Rules rules;
  rules.node = [](NodeIndex) { return static_cast<std::uint8_t>(kStays); };
  const auto left_with = [&](double max_off_surface) {
    Options options;
    options.max_off_surface = max_off_surface;
    const Result<Repaired> repaired = repair({model, surface, rules, criteria, options}, bad_shells(model, quality::Grade::fail));
    EXPECT_TRUE(repaired.has_value());
    return repaired ? repaired->unrepaired.size() : 999;
  };
  EXPECT_EQ(left_with(0.02), 8U);
  EXPECT_EQ(left_with(0.1), 0U);
}

/// A sheet of quads of this length and a width of 1.
Mended mend_all_of_length(double length) {
  const Grid grid{6, 6, [=](double x, double y) { return Vec3(length * x, y, 0); }, {}};
  const Model model = model_of(grid.positions(), grid.shells());
  const relax::ReferenceSurface surface(model, all_shells(model), 30);
  Result<Repaired> repaired = repair({model, surface, {}, {quality::default_criteria(), 1.0}, {}}, all_shells(model));
  EXPECT_TRUE(repaired.has_value());
  return {carried_out(model, repaired->change), std::move(*repaired)};
}

TEST(Margin, what_a_decks_fewer_digits_may_bring_over_a_limit_is_repaired_too) {
  // longer than 1.5 is a warning
  const Mended just_within = mend_all_of_length(1.4995), well_within = mend_all_of_length(1.495);
  EXPECT_EQ(just_within.repaired.bad_before, 0U);
  EXPECT_FALSE(just_within.repaired.change.empty());
  EXPECT_TRUE(well_within.repaired.change.empty());
}

TEST(Untouched, shells_far_from_the_scope_keep_their_nodes_and_places) {
  const Grid grid = flat(40, 12);
  Mesh mesh{grid.positions(), grid.shells()};
  const Model good = mesh.model();
  plant_short_edge(mesh, grid, 3, 5);
  plant_short_edge(mesh, grid, 35, 5);
  const Model bad = mesh.model();
  ShellSet scope;
  for (const ShellIndex shell : bad_shells(bad, quality::Grade::warn))
    if (bad.position(bad.shell(shell).node[0]).x() < 20) scope.push_back(shell);
  const relax::ReferenceSurface surface(good, all_shells(good), 30);
  const auto repaired = repair({bad, surface, {}, {quality::default_criteria(), 1.0}, {}}, scope);
  ASSERT_TRUE(repaired.has_value());
  EXPECT_FALSE(repaired->change.empty());
  for (const auto& [shell, nodes] : repaired->change.reshaped) EXPECT_LT(bad.position(bad.shell(shell).node[0]).x(), 20);
  for (const ShellIndex shell : repaired->change.removed_shells) EXPECT_LT(bad.position(bad.shell(shell).node[0]).x(), 20);
  for (const auto& [node, position] : repaired->change.moved) EXPECT_LT(bad.position(node).x(), 20);
}

TEST(Scope, what_fails_beside_it_is_left_as_it_is) {
  // two defects that one patch holds; the second one's strip and rows aren't those of the first
  const Grid grid = flat(16, 16);
  Mesh mesh{grid.positions(), grid.shells()};
  const Model good = mesh.model();
  plant_wrong_edge(mesh, grid, 4, 4);
  plant_wrong_edge(mesh, grid, 7, 7);
  const Model bad = mesh.model();
  ShellSet scope, beside;
  for (const ShellIndex shell : bad_shells(bad, quality::Grade::warn))
    (shell == shell_at(grid.shell(4, 4)) || shell == shell_at(grid.shell(5, 4)) ? scope : beside).push_back(shell);
  ASSERT_EQ(scope.size(), 2u);
  ASSERT_EQ(beside.size(), 2u);
  const relax::ReferenceSurface surface(good, all_shells(good), 30);
  const auto repaired = repair({bad, surface, {}, {quality::default_criteria(), 1.0}, {}}, scope);
  ASSERT_TRUE(repaired.has_value());
  EXPECT_EQ(repaired->bad_before, 2u);
  EXPECT_TRUE(repaired->unrepaired.empty()) << "what isn't in scope isn't told";
  const Model after = carried_out(bad, repaired->change);
  for (const ShellIndex shell : scope) EXPECT_EQ(grade_of(after, shell), quality::Grade::ok);
  for (const ShellIndex shell : beside) EXPECT_EQ(after.shell(shell), bad.shell(shell));
}

TEST(Scope, what_is_left_is_told_by_the_models_numbers) {
  // in a corner of the sheet, so that the patch holds a part of it only; and nothing may be changed
  const Grid grid = flat(16, 16);
  Mesh mesh{grid.positions(), grid.shells()};
  const Model good = mesh.model();
  plant_wrong_edge(mesh, grid, 12, 13);
  Rules rules;
  rules.node = [](NodeIndex) { return static_cast<std::uint8_t>(kStays | kNeeded); };
  rules.shell = [](ShellIndex) { return static_cast<std::uint8_t>(kKeepsNodes | kIndivisible | kLasting); };
  const Model bad = mesh.model();
  const ShellSet failing = bad_shells(bad, quality::Grade::fail);
  ASSERT_FALSE(failing.empty());
  ShellSet told;
  const Mended mended = mend(bad, good, rules);
  for (const Unrepaired& left : mended.repaired.unrepaired) told.push_back(left.shell);
  EXPECT_EQ(told, failing);
}

/// Why what fails can't be repaired.
std::set<std::string> reasons(const Model& model, const Rules& rules, double max_triangles_percent = 5) {
  const relax::ReferenceSurface surface(model, all_shells(model), 30);
  Options options;
  options.max_triangles_percent = max_triangles_percent;
  const auto repaired = repair({model, surface, rules, {quality::default_criteria(), 1.0}, options}, all_shells(model));
  EXPECT_TRUE(repaired.has_value());
  std::set<std::string> why;
  for (const Unrepaired& left : repaired->unrepaired) why.insert(left.why);
  return why;
}

TEST(Reasons, are_told_for_what_is_left) {
  const Grid divide_in_three{8, 1, [](double x, double y) { return Vec3(x, 0.1 * y, 0); }, {}};
  EXPECT_EQ(reasons(model_of(divide_in_three.positions(), divide_in_three.shells()), {}),
            std::set<std::string>{"it lies between edges of the part that have to stay"});
  Rules rules;
  rules.node = [](NodeIndex) { return static_cast<std::uint8_t>(kStays | kNeeded); };
  rules.shell = [](ShellIndex) { return static_cast<std::uint8_t>(kKeepsNodes | kIndivisible | kLasting); };
  const Grid grid = flat();
  Mesh mesh{grid.positions(), grid.shells()};
  plant_wrong_edge(mesh, grid, 5, 5);
  EXPECT_EQ(reasons(mesh.model(), rules), std::set<std::string>{"no operation makes it better"});
  Mesh warped{grid.positions(), grid.shells()};
  warped.positions[grid.node(5, 5)] += Vec3(0, 0, 0.6);
  EXPECT_EQ(reasons(warped.model(), {}, 0), std::set<std::string>{"there would be too many triangles"});
}

/// A flat sheet with three defects, repaired until it is stopped.
struct Interrupted {
  Grid grid = flat();
  Model bad;
  relax::ReferenceSurface surface;
  Interrupted() : bad(planted(grid)), surface(bad, all_shells(bad), 30) {}
  static Model planted(const Grid& grid) {
    Mesh mesh{grid.positions(), grid.shells()};
    plant_short_edge(mesh, grid, 2, 5);
    plant_short_edge(mesh, grid, 5, 5);
    plant_wrong_edge(mesh, grid, 8, 8);
    return mesh.model();
  }
  Repaired repair_until(const Progress& progress, std::vector<std::uint64_t> stop_at = {}) const {
    Options options;
    options.stop_at = std::move(stop_at);
    return repair({bad, surface, {}, {quality::default_criteria(), 1.0}, options}, bad_shells(bad, quality::Grade::warn), progress).value();
  }
};

TEST(Stopped, a_repair_returns_what_it_has_reached_and_the_same_again_at_that_step) {
  const Interrupted sheet;
  std::size_t calls = 0;
  const Repaired whole = sheet.repair_until([&](double) { return ++calls > 0; });
  EXPECT_FALSE(whole.stopped);
  ASSERT_GT(calls, 10u);
  std::size_t changed = 0;
  for (std::size_t stop = 0; stop < calls; stop += 1 + stop / 4) {
    std::size_t asked = 0;
    const Repaired stopped = sheet.repair_until([&](double) { return asked++ < stop; });
    ASSERT_TRUE(stopped.stopped) << stop;
    EXPECT_EQ(asked, stop + 1) << "asked no more";
    const Model kept = carried_out(sheet.bad, stopped.change);
    EXPECT_EQ(what_is_wrong(kept), "");
    EXPECT_EQ(bad_shells(kept, quality::Grade::warn).size(), stopped.bad_left);
    for (const ShellIndex shell : bad_shells(kept, quality::Grade::fail))
      EXPECT_TRUE(shell.value >= sheet.bad.shell_count() || grade_of(sheet.bad, shell) == quality::Grade::fail) << shell.value;
    const Repaired again = sheet.repair_until({}, stopped.stopped->steps);
    ASSERT_TRUE(again.stopped);
    EXPECT_EQ(again.change.moved, stopped.change.moved);
    EXPECT_EQ(again.change.reshaped, stopped.change.reshaped);
    EXPECT_EQ(again.done, stopped.done);
    EXPECT_EQ(again.bad_left, stopped.bad_left);
    changed += stopped.change.empty() ? 0 : 1;
  }
  EXPECT_GT(changed, 3u);
}

}  // namespace
}  // namespace prismesh::mesh::repair
