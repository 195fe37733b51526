#include "mesh/relax/local_fit.h"

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

namespace prismesh::mesh::relax {

namespace {

constexpr std::size_t kPointsForCubic = 14;
constexpr std::size_t kPointsForQuadric = 6;
constexpr double kSteepest = 1;    ///< slope: a fit whose tangent plane is steeper against the normal is rejected
constexpr double kRoughest = 0.1;  ///< a fit whose RMS distance from its points is larger, as a share of the scale, is rejected
constexpr double kDamping = 1e-9;  ///< regularisation: keeps terms that the points don't determine at zero

std::array<double, 9> monomials(double u, double v) { return {u, v, u * u, u * v, v * v, u * u * u, u * u * v, u * v * v, v * v * v}; }

void set_frame(const Vec3& normal, LocalFit& fit) {
  int axis = 0;
  normal.cwiseAbs().minCoeff(&axis);
  fit.normal = normal;
  fit.u = normal.cross(Vec3::Unit(axis)).normalized();
  fit.v = normal.cross(fit.u);
}

struct Solution {
  std::array<double, 9> height{};
  bool sound = false;
};

template <int kTerms>
Solution solve(const LocalFit& fit, std::span<const Vec3> around) {
  using Square = Eigen::Matrix<double, kTerms, kTerms>;
  using Column = Eigen::Matrix<double, kTerms, 1>;
  Square matrix = Square::Zero();
  Column right = Column::Zero();
  double heights2 = 0, weights = 0;
  for (const Vec3& point : around) {
    const Vec3 d = (point - fit.origin) / fit.scale;
    const std::array<double, 9> all = monomials(d.dot(fit.u), d.dot(fit.v));
    const Eigen::Map<const Column> row(all.data());
    const double height = d.dot(fit.normal);
    const double distance2 = d.squaredNorm();
    const double weight = 1 / (0.1 + distance2 * distance2);
    matrix.noalias() += weight * row * row.transpose();
    right += weight * height * row;
    heights2 += weight * height * height;
    weights += weight;
  }
  for (int i = 0; i < kTerms; ++i) matrix(i, i) += kDamping * weights;
  const Column found = matrix.ldlt().solve(right);
  Solution solution;
  if (!found.allFinite()) return solution;
  for (int i = 0; i < kTerms; ++i) solution.height[static_cast<std::size_t>(i)] = found[i];
  const double missed2 = heights2 - 2 * right.dot(found) + found.dot(matrix * found);
  solution.sound = missed2 <= kRoughest * kRoughest * weights && found[0] * found[0] + found[1] * found[1] <= kSteepest * kSteepest;
  return solution;
}

}  // namespace

LocalFit::FitPoint LocalFit::point_over(const Vec3& point) const {
  const Vec3 d = (point - origin) / scale;
  const double a = d.dot(u), b = d.dot(v);
  const auto& h = height;
  double up = h[0] * a + h[1] * b + h[2] * a * a + h[3] * a * b + h[4] * b * b;
  double by_u = h[0] + 2 * h[2] * a + h[3] * b;
  double by_v = h[1] + h[3] * a + 2 * h[4] * b;
  if (terms > 5) {
    up += a * a * (h[5] * a + h[6] * b) + b * b * (h[7] * a + h[8] * b);
    by_u += 3 * h[5] * a * a + 2 * h[6] * a * b + h[7] * b * b;
    by_v += h[6] * a * a + 2 * h[7] * a * b + 3 * h[8] * b * b;
  }
  return {origin + scale * (a * u + b * v + up * normal), normal - by_u * u - by_v * v};
}

LocalFit fit_about(const Vec3& node, const Vec3& normal, std::span<const Vec3> around, std::size_t ring) {
  LocalFit fit;
  fit.origin = node;
  set_frame(normal, fit);
  double size = 0;
  for (std::size_t i = 0; i < ring; ++i) size += (around[i] - node).norm();
  if (ring == 0 || !(size > 0) || !std::isfinite(size)) return fit;
  fit.scale = size / static_cast<double>(ring);
  const auto take = [&](const Solution& solution, int terms) {
    if (!solution.sound) return false;
    fit.height = solution.height;
    fit.terms = terms;
    return true;
  };
  if (around.size() >= kPointsForCubic && take(solve<9>(fit, around), 9)) return fit;
  if (around.size() >= kPointsForQuadric && take(solve<5>(fit, around), 5)) return fit;
  if (around.size() >= 2) take(solve<2>(fit, around.first(ring)), 2);
  return fit;
}

}  // namespace prismesh::mesh::relax
