// Shells that move: the proxy is carried on its side, or lets go; nothing passes it.
#include <iostream>
#include <limits>
#include <random>
#include <utility>

#include <gtest/gtest.h>

#include "drivers/haptics/proxy.h"
#include "tests/drivers/haptics/field_rig.h"
#include "tests/support/seed.h"

namespace prismesh::drivers::haptics {
namespace {

using test::Triangles;

/// A field of shells that have moved since the last one. Small bricks about the pen, so that there can be many.
class MovingShells {
 public:
  explicit MovingShells(Triangles shells) : shells_(std::move(shells)), field_(std::make_unique<HapticField>()) {}

  const HapticField& move(Triangles now, const Eigen::Vector3d& pen_mm, const Triangles& still = {}) {
    const auto still_mm = [&](const Eigen::Vector3d& at) { return test::distance_to(still, at); };
    const auto distance_mm = [&](const Eigen::Vector3d& at) { return std::min(test::distance_to(now, at), still_mm(at)); };
    return move_filled(now, pen_mm, distance_mm, still_mm);
  }
  /// With a quicker distance than that of the triangles.
  template <class DistanceOf>
  const HapticField& move_alone(const Triangles& now, const Eigen::Vector3d& pen_mm, const DistanceOf& distance_mm) {
    return move_filled(now, pen_mm, distance_mm, [](const Eigen::Vector3d&) { return 1e3; });
  }
  HapticField& field() { return *field_; }
  const Triangles& now() const { return shells_; }
  Triangles at(double part) const {
    Triangles result = shells_;
    for (std::size_t i = 0; i < result.size(); ++i)
      for (int corner = 0; corner < 3; ++corner) result[i][corner] = before_[i][corner] + part * (shells_[i][corner] - before_[i][corner]);
    return result;
  }

 private:
  template <class DistanceOf, class StillOf>
  const HapticField& move_filled(const Triangles& now, const Eigen::Vector3d& pen_mm, const DistanceOf& distance_mm,
                                 const StillOf& still_mm) {
    test::fill_brick(field_->fine, pen_mm, 0.4, 26, distance_mm, still_mm);
    test::fill_brick(field_->coarse, pen_mm, 1.5, 12, distance_mm, still_mm);
    field_->moved_reach_mm = 2 * 0.4;
    ++field_->number;
    field_->before_generation = field_->mesh_generation++;
    before_ = std::exchange(shells_, now);
    test::enter_moved(*field_, before_, shells_);
    return *field_;
  }

  Triangles shells_, before_;
  std::unique_ptr<HapticField> field_;
};

Triangles moved(Triangles triangles, const Eigen::Isometry3d& motion) {
  for (test::Triangle& triangle : triangles)
    for (Eigen::Vector3d& corner : triangle) corner = motion * corner;
  return triangles;
}

Eigen::Isometry3d shift(double x, double y, double z) { return Eigen::Isometry3d(Eigen::Translation3d(x, y, z)); }

double side_of(const Triangles& triangles, const Eigen::Vector3d& at) {
  const test::Triangle& t = triangles.front();
  return (t[1] - t[0]).cross(t[2] - t[0]).normalized().dot(at - t[0]);
}

TEST(proxy_moving, a_sheet_that_sweeps_past_the_pen_takes_the_proxy_along) {
  for (const double sweep_mm : {0.1, 0.5, 2.0, 5.0, -5.0}) {
    MovingShells sheet(moved(test::plane_shape(), shift(0, 0, sweep_mm > 0 ? -1 : 1)));
    Proxy proxy;
    proxy.step(&sheet.move(sheet.now(), {0, 0, 0}), {0, 0, 0}, 0);
    double z = sheet.now()[0][0].z();
    while (z * sweep_mm < 3 * std::abs(sweep_mm)) {
      z += sweep_mm;
      const ProxyContact contact = proxy.step(&sheet.move(moved(test::plane_shape(), shift(0, 0, z)), {0, 0, 0}), {0, 0, 0}, 0);
      ASSERT_TRUE(contact.attached) << sweep_mm << ", sheet at " << z;
      ASSERT_GT((contact.proxy_mm.z() - z) * sweep_mm, 0) << "on its side";
      ASSERT_EQ(contact.touching, z * sweep_mm > 0 || contact.proxy_mm.norm() > 1e-6);
      // Beyond the fine brick it keeps the contact distance of the coarse one.
      if (z * sweep_mm > 0) {
        ASSERT_LT(std::abs(contact.proxy_mm.z() - z), 2.3);
      }
    }
  }
}

TEST(proxy_moving, two_sheets_that_close_on_it_are_not_passed) {
  MovingShells jaws(moved(test::plane_shape(), shift(0, 0, -3)));
  const Triangles still = moved(test::plane_shape(), shift(0, 0, 2));
  Proxy proxy;
  proxy.step(&jaws.move(jaws.now(), {0, 0, 0}, still), {0, 0, 0}, 0);
  bool let_go = false;
  for (double z = -3; z < 1.95 && !let_go; z += 0.25) {
    const ProxyContact contact = proxy.step(&jaws.move(moved(test::plane_shape(), shift(0, 0, z)), {0, 0, 0}, still), {0, 0, 0}, 0);
    let_go = contact.let_go;
    if (let_go) {
      EXPECT_GT(z, 0.5) << "there was room";
      break;
    }
    ASSERT_GT(contact.proxy_mm.z(), z);
    ASSERT_LT(contact.proxy_mm.z(), 2);
  }
  EXPECT_TRUE(let_go) << "it is pinched in the end";
}

TEST(proxy_moving, a_sheet_does_not_push_it_through_one_that_stays) {
  MovingShells sheet(moved(test::plane_shape(), shift(0, 0, -1)));
  const Triangles still = moved(test::plane_shape(), shift(0, 0, 1.5));
  Proxy proxy;
  ASSERT_TRUE(proxy.step(&sheet.move(sheet.now(), {0, 0, 0}, still), {0, 0, 0}, 0).attached);
  const ProxyContact contact = proxy.step(&sheet.move(moved(test::plane_shape(), shift(0, 0, 4)), {0, 0, 0}, still), {0, 0, 0}, 0);
  EXPECT_TRUE(contact.let_go);
}

TEST(proxy_moving, lets_go_when_buckets_lie_or_are_too_full) {
  const auto carried = [](auto&& change) {
    MovingShells sheet(moved(test::plane_shape(), shift(0, 0, -1)));
    Proxy proxy;
    proxy.step(&sheet.move(sheet.now(), {0, 0, 0}), {0, 0, 0}, 0);
    sheet.move(moved(test::plane_shape(), shift(0, 0, 1)), {0, 0, 0});
    change(sheet.field());
    return proxy.step(&sheet.field(), {0, 0, 0}, 0).attached;
  };
  EXPECT_TRUE(carried([](HapticField&) {}));
  EXPECT_FALSE(carried([](HapticField& f) { f.before_generation = 0; }));
  EXPECT_FALSE(carried([](HapticField& f) { f.moved_count = 1; }));
  EXPECT_FALSE(carried([](HapticField& f) { f.bucket_begin[kBuckets / 2 + kBucketSide * kBucketSide / 2 + 8] = 1'000'000; }));
  EXPECT_FALSE(carried([](HapticField& f) {
    for (std::int32_t b = 0; b <= kBuckets; ++b) f.bucket_begin[b] = static_cast<std::uint32_t>(b) * 129 % 65000;
  }));
  EXPECT_FALSE(carried([](HapticField& f) {
    for (MovedTriangle& triangle : f.moved) triangle.now_mm[1][2] = std::numeric_limits<float>::quiet_NaN();
  }));
}

/// Tests a tick's path against the motion: steps at one time against the shells at that time, waits against the relative way. Exact where
/// shells only shift.
bool passes(const ProxyPath& path, const MovingShells& shells) {
  const Triangles before = shells.at(0);
  const Eigen::Vector3d shifted = shells.now()[0][0] - before[0][0];
  for (std::size_t s = 1; s < path.count; ++s)
    if (test::meets(before, path.places_mm[s - 1] - path.part[s - 1] * shifted, path.places_mm[s] - path.part[s] * shifted)) return true;
  return false;
}

struct MovingFigures {
  int carried = 0, let_go = 0, touching = 0;
};

/// 100,000 ticks, ten for each motion. A hand that yields half of what pulls it.
template <class Motion, class DistanceOf, class Check>
MovingFigures sweep_at_random(const Triangles& sheet, unsigned seed, Motion&& motion, DistanceOf&& distance_of, Check&& check) {
  std::mt19937 random(test::seed(seed));
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto vector = [&](double length) -> Eigen::Vector3d { return Eigen::Vector3d(unit(random), unit(random), unit(random)) * length; };
  MovingShells shells(sheet);
  Proxy proxy;
  ProxyPath path;
  MovingFigures figures;
  Eigen::Vector3d pen = Eigen::Vector3d(0, 0, 2), velocity = Eigen::Vector3d::Zero();
  shells.move_alone(sheet, pen, distance_of(sheet));
  for (int tick = 0; tick < 100'000; ++tick) {
    const bool new_field = tick % 10 == 0;
    if (new_field) {
      const Triangles next = motion(random, pen);
      shells.move_alone(next, pen, distance_of(next));
    }
    velocity = 0.95 * velocity + vector(0.05);
    pen += velocity;
    if (pen.norm() > 6) pen *= 6 / pen.norm();
    const ProxyContact contact = proxy.step(&shells.field(), pen, 0, &path);
    figures.let_go += contact.let_go;
    figures.touching += contact.touching;
    if (new_field && contact.attached) ++figures.carried;
    if (!check(path, contact, shells, new_field)) {
      ADD_FAILURE() << "passed at tick " << tick;
      return figures;
    }
    if (contact.attached) pen += 0.5 * (contact.proxy_mm - pen);
  }
  return figures;
}

TEST(ProxyMovingLong, a_wide_sheet_that_tilts_and_sweeps_never_changes_sides) {
  double z = 0, tilt_x = 0, tilt_y = 0;
  double side = 0;
  const MovingFigures figures = sweep_at_random(
      test::plane_shape(), 20,
      [&](std::mt19937& random, const Eigen::Vector3d&) {
        std::uniform_real_distribution<double> unit(-1, 1);
        z = std::clamp(z + 3 * unit(random), -5.0, 5.0);
        tilt_x = std::clamp(tilt_x + 0.02 * unit(random), -0.15, 0.15);
        tilt_y = std::clamp(tilt_y + 0.02 * unit(random), -0.15, 0.15);
        return moved(test::plane_shape(), shift(0, 0, z) * Eigen::AngleAxisd(tilt_x, Eigen::Vector3d::UnitX()) *
                                              Eigen::AngleAxisd(tilt_y, Eigen::Vector3d::UnitY()));
      },
      [](const Triangles& wide) {
        const Eigen::Vector3d normal = (wide[0][1] - wide[0][0]).cross(wide[0][2] - wide[0][0]).normalized(), on = wide[0][0];
        return [normal, on](const Eigen::Vector3d& at) { return std::abs(normal.dot(at - on)); };
      },
      [&](const ProxyPath&, const ProxyContact& contact, const MovingShells& shells, bool) {
        if (!contact.attached) return side = 0, true;
        const double now = side_of(shells.now(), contact.proxy_mm);
        const bool kept = side == 0 || now * side > 0;
        side = now;
        return kept;
      });
  EXPECT_GT(figures.carried, 9'500);
  EXPECT_GT(figures.touching, 10'000);
  EXPECT_LT(figures.let_go, 10);
  std::cout << figures.carried << " motions carried, " << figures.touching << " ticks in contact, let go " << figures.let_go << " times\n";
}

TEST(ProxyMovingLong, a_small_sheet_with_edges_never_passes) {
  const Triangles sheet = test::quad({-4, -4, 0}, {4, -4, 0}, {4, 4, 0}, {-4, 4, 0});
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  const MovingFigures figures = sweep_at_random(
      sheet, 21,
      [&](std::mt19937& random, const Eigen::Vector3d&) {
        std::uniform_real_distribution<double> unit(-1, 1);
        place += 3 * Eigen::Vector3d(unit(random), unit(random), unit(random));
        for (double& axis : place) axis = std::clamp(axis, -5.0, 5.0);
        return moved(sheet, Eigen::Isometry3d(Eigen::Translation3d(place)));
      },
      [](const Triangles& small) {
        const Eigen::Vector3d low = small[0][0], high = small[0][2];
        return [low, high](const Eigen::Vector3d& at) { return (at - at.cwiseMax(low).cwiseMin(high)).norm(); };
      },
      [&](const ProxyPath& path, const ProxyContact&, const MovingShells& shells, bool new_field) {
        if (new_field) return !passes(path, shells);
        for (std::size_t s = 1; s < path.count; ++s)
          if (test::meets(shells.now(), path.places_mm[s - 1], path.places_mm[s])) return false;
        return true;
      });
  EXPECT_GT(figures.carried, 9'500);
  EXPECT_GT(figures.touching, 2'000);
  EXPECT_LT(figures.let_go, 10);
  std::cout << figures.carried << " motions carried, " << figures.touching << " ticks in contact, let go " << figures.let_go << " times\n";
}

}  // namespace
}  // namespace prismesh::drivers::haptics
