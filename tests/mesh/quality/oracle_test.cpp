// Metrics against their definitions worked out another way: in the plane, by sides alone, by shape functions. For what the Verdict library
// doesn't have, and where it isn't installed.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "mesh/quality/judge.h"
#include "mesh/quality/mass.h"
#include "mesh/quality/measure.h"
#include "mesh/quality/metrics.h"
#include "mesh/quality/report.h"
#include "mesh/quality/time_step.h"
#include "tests/mesh/quality/mixed_grid.h"

namespace prismesh::mesh::quality {
namespace {

constexpr double kPi = 3.14159265358979323846;

using Flat = Eigen::Vector2d;

double metric(const std::vector<Vec3>& corners, Metric which) { return measure(corners)[static_cast<std::size_t>(which)]; }

/// Somewhere in space, lying askew.
std::vector<Vec3> in_space(const std::vector<Flat>& flat, std::mt19937& random) {
  std::uniform_real_distribution<double> any(-1, 1);
  const Eigen::AngleAxisd turn(3 * any(random), Vec3(any(random), any(random), 1.5).normalized());
  const Vec3 away(5 * any(random), 5 * any(random), 5 * any(random));
  std::vector<Vec3> corners;
  for (const Flat& p : flat) corners.push_back(turn * Vec3(p.x(), p.y(), 0) + away);
  return corners;
}

double doubled_area(const Flat& a, const Flat& b, const Flat& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// Counter-clockwise quads without crossing sides, some of them with a corner turned in.
std::vector<Flat> random_quad(std::mt19937& random) {
  for (;;) {
    std::uniform_real_distribution<double> away(-0.6, 0.6);
    std::vector<Flat> p = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (Flat& each : p) each += Flat(away(random), away(random));
    double whole = 0;
    int turned_in = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      whole += p[i].x() * p[(i + 1) % 4].y() - p[(i + 1) % 4].x() * p[i].y();
      turned_in += doubled_area(p[(i + 3) % 4], p[i], p[(i + 1) % 4]) < 0;
    }
    if (whole > 0.1 && turned_in < 2) return p;
  }
}

/// Interior angle at a corner, degrees, from 0 to 360: how far one turns from the next side to the one before.
double interior_angle(const Flat& before, const Flat& at, const Flat& after) {
  const Flat next = after - at, last = before - at;
  const double angle = std::atan2(last.y(), last.x()) - std::atan2(next.y(), next.x());
  return (angle < 0 ? angle + 2 * kPi : angle) * 180 / kPi;
}

double acute_between(const Flat& a, const Flat& b) {
  return std::acos(std::min(1.0, std::abs(a.dot(b)) / (a.norm() * b.norm()))) * 180 / kPi;
}

TEST(Oracle, angles_skew_and_taper_of_quads_in_the_plane) {
  std::mt19937 random(41);
  int with_a_corner_turned_in = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const std::vector<Flat> p = random_quad(random);
    const std::vector<Vec3> corners = in_space(p, random);
    double least = 360, most = 0, whole = 0, smallest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 4; ++i) {
      const Flat &before = p[(i + 3) % 4], &after = p[(i + 1) % 4];
      least = std::min(least, interior_angle(before, p[i], after));
      most = std::max(most, interior_angle(before, p[i], after));
      whole += 0.5 * (p[i].x() * after.y() - after.x() * p[i].y());
      smallest = std::min(smallest, 0.5 * doubled_area(before, p[i], after));
    }
    with_a_corner_turned_in += most > 180;
    EXPECT_NEAR(metric(corners, Metric::min_angle_quad), least, 2e-5 * 360) << trial;
    EXPECT_NEAR(metric(corners, Metric::max_angle_quad), most, 2e-5 * 360) << trial;
    EXPECT_NEAR(metric(corners, Metric::taper), std::clamp(1 - smallest / (whole / 2), 0.0, 2.0), 1e-5) << trial;
    const Flat across = 0.5 * (p[1] + p[2]) - 0.5 * (p[0] + p[3]), along = 0.5 * (p[2] + p[3]) - 0.5 * (p[0] + p[1]);
    EXPECT_NEAR(metric(corners, Metric::skew), 90 - acute_between(across, along), 1e-3) << trial;
  }
  EXPECT_GT(with_a_corner_turned_in, 50);
}

TEST(Oracle, skew_and_height_of_triangles_in_the_plane) {
  std::mt19937 random(42);
  std::uniform_real_distribution<double> anywhere(0, 1);
  for (int trial = 0; trial < 2000; ++trial) {
    std::vector<Flat> p;
    for (int c = 0; c < 3; ++c) p.emplace_back(anywhere(random), anywhere(random));
    if (std::abs(doubled_area(p[0], p[1], p[2])) < 0.02) continue;
    double smallest = 90, height = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 3; ++i) {
      const Flat &at = p[i], &next = p[(i + 1) % 3], &last = p[(i + 2) % 3];
      const Flat median = 0.5 * (next + last) - at, middles = 0.5 * (at + next) - 0.5 * (at + last);
      smallest = std::min(smallest, acute_between(median, middles));
      // foot of the corner on the line through the other two
      const Flat line = last - next;
      const Flat foot = next + (at - next).dot(line) / line.squaredNorm() * line;
      height = std::min(height, (at - foot).norm());
    }
    const std::vector<Vec3> corners = in_space(p, random);
    EXPECT_NEAR(metric(corners, Metric::skew), 90 - smallest, 1e-3) << trial;
    EXPECT_NEAR(metric(corners, Metric::min_length), height, 1e-5) << trial;
  }
}

/// Determinants at the Gauss points from the derivatives of the shape functions, of warped quads too.
TEST(Oracle, jacobian_by_shape_functions) {
  std::mt19937 random(43);
  std::uniform_real_distribution<double> away(-0.4, 0.4);
  constexpr std::array<std::array<double, 2>, 4> kCorner = {{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  const double gauss = std::sqrt(1.0 / 3);
  for (int trial = 0; trial < 2000; ++trial) {
    std::vector<Vec3> p = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    for (Vec3& each : p) each += Vec3(away(random), away(random), 0.5 * away(random));
    const Vec3 normal = (p[2] - p[0]).cross(p[3] - p[1]).normalized();
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (const auto& at : kCorner) {
      const double xi = gauss * at[0], eta = gauss * at[1];
      Vec3 along_xi = Vec3::Zero(), along_eta = Vec3::Zero();
      for (std::size_t c = 0; c < 4; ++c) {
        along_xi += 0.25 * kCorner[c][0] * (1 + kCorner[c][1] * eta) * p[c];
        along_eta += 0.25 * kCorner[c][1] * (1 + kCorner[c][0] * xi) * p[c];
      }
      const double determinant = along_xi.cross(along_eta).dot(normal);
      least = std::min(least, determinant);
      most = std::max(most, determinant);
    }
    EXPECT_NEAR(metric(p, Metric::jacobian), least / most, 1e-5) << trial;
  }
}

/// Mass and the smallest time step of good, bad and crossed shells, shell by shell.
TEST(Oracle, mass_and_time_step_add_up_from_single_shells) {
  Model model = test::mixed_grid(30, 0.7, true, 44);
  Part steel;
  steel.id = 1;
  steel.thickness = 1.5;
  steel.density = 7.85e-9;
  steel.youngs_modulus = 210000;
  steel.poissons_ratio = 0.3;
  Part brass = steel;
  brass.density = 8.4e-9;
  brass.youngs_modulus = 100000;
  model.parts = std::make_shared<const std::vector<Part>>(std::vector<Part>{steel, brass});
  for (std::size_t s = 0; s < model.shell_count(); s += 2) model.shell_parts.set(s, PartIndex(std::size_t{1}));
  model.positions.set(31, Vec3(model.positions[32]));
  for (const int option : {0, 1, 2, 3}) {
    TimeStepControl control;
    control.shell_option = option;
    control.mass_scaled = -2e-7;
    double least = std::numeric_limits<double>::infinity(), added = 0;
    std::size_t without = 0, folded = 0;
    for (std::size_t s = 0; s < model.shell_count(); ++s) {
      const ShellNodes& nodes = model.shell_nodes[s];
      std::vector<Vec3> corners;
      for (std::size_t c = 0; c < static_cast<std::size_t>(nodes.corners()); ++c) corners.push_back(model.position(nodes.node[c]));
      const Part& part = (*model.parts)[model.shell_parts[s].value];
      const auto step = shell_time_step(part, corners, option);
      folded += judge(measure(corners), {default_criteria(), 1.0}).has(Defect::no_area);
      without += !step;
      if (!step) continue;
      least = std::min(least, 0.9 * *step);
      const double mass = mass_properties(model, ShellIndex(s)).mass;
      if (*step < 2e-7) added += mass * (4e-14 / (*step * *step) - 1);
    }
    EXPECT_EQ(without, folded) << option;
    EXPECT_GT(folded, 0u);
    const Report r = report(model, {default_criteria(), 1.0}, control);
    EXPECT_NEAR(r.time_step->seconds, least, 1e-12 * least) << option;
    EXPECT_GT(added, 0);
    EXPECT_NEAR(*r.added_mass, added, 1e-9 * added) << option;
    const MassProperties weight = mass_properties(model);
    EXPECT_NEAR(*r.mass, weight.mass, 1e-12 * weight.mass);
    EXPECT_NEAR((*r.centre_of_gravity - *weight.centre()).norm(), 0, 1e-9);
  }
}

}  // namespace
}  // namespace prismesh::mesh::quality
