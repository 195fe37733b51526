#include "mesh/contact/orientation.h"

#include <array>
#include <cmath>

namespace prismesh::mesh::contact {

namespace {

constexpr double kHalfUlp = 0x1p-53;
constexpr double kErrorOfThree = (7 + 56 * kHalfUlp) * kHalfUlp;  ///< o3derrboundA of [Shewchuk 1997]
constexpr double kErrorOfTwo = (3 + 16 * kHalfUlp) * kHalfUlp;    ///< ccwerrboundA

struct Pair {
  double high, low;  ///< high is the rounded result, low its error
};

Pair two_sum(double a, double b) {
  const double sum = a + b;
  const double of_b = sum - a, of_a = sum - of_b;
  return {sum, (a - of_a) + (b - of_b)};
}

Pair split(double a) {
  const double c = 0x1.0000002p27 * a;
  const double high = c - (c - a);
  return {high, a - high};
}

Pair two_product(double a, double b) {
  const double product = a * b;
  const auto [a_high, a_low] = split(a);
  const auto [b_high, b_low] = split(b);
  const double error = ((product - a_high * b_high) - a_low * b_high) - a_high * b_low;
  return {product, a_low * b_low - error};
}

/// A sum of doubles that don't overlap, from small to large; its sign is that of the last one.
template <std::size_t kMax>
struct Expansion {
  std::array<double, kMax> part;
  std::size_t size = 0;

  /// GROW-EXPANSION of [Shewchuk 1997], without parts that are 0.
  void add(double term) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const auto [sum, error] = two_sum(term, part[i]);
      if (error != 0) part[kept++] = error;
      term = sum;
    }
    if (term != 0) part[kept++] = term;
    size = kept;
  }
  template <std::size_t kOther>
  void add(const Expansion<kOther>& other, double sign = 1) {
    for (std::size_t i = 0; i < other.size; ++i) add(sign * other.part[i]);
  }
  double value() const { return size == 0 ? 0 : part[size - 1]; }
};

Expansion<2> difference(double a, double b) {
  const auto [high, low] = two_sum(a, -b);
  Expansion<2> result;
  result.add(low);
  result.add(high);
  return result;
}

template <std::size_t kA, std::size_t kB>
Expansion<2 * kA * kB> product(const Expansion<kA>& a, const Expansion<kB>& b) {
  Expansion<2 * kA * kB> result;
  for (std::size_t i = 0; i < a.size; ++i)
    for (std::size_t j = 0; j < b.size; ++j) {
      const auto [high, low] = two_product(a.part[i], b.part[j]);
      result.add(low);
      result.add(high);
    }
  return result;
}

using Differences = std::array<Expansion<2>, 3>;

Differences exact_difference(const Vec3& a, const Vec3& b) {
  return {difference(a[0], b[0]), difference(a[1], b[1]), difference(a[2], b[2])};
}

Expansion<16> exact_cross(const Differences& u, const Differences& v, std::size_t i, std::size_t j) {
  Expansion<16> result;
  result.add(product(u[i], v[j]));
  result.add(product(u[j], v[i]), -1);
  return result;
}

double exact_orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Differences u = exact_difference(b, a), v = exact_difference(c, a), w = exact_difference(d, a);
  Expansion<192> sum;
  for (std::size_t axis = 0; axis < 3; ++axis) sum.add(product(exact_cross(u, v, (axis + 1) % 3, (axis + 2) % 3), w[axis]));
  return sum.value();
}

}  // namespace

double orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = b - a, v = c - a, w = d - a;
  double value = 0, size = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t i = (axis + 1) % 3, j = (axis + 2) % 3;
    const double left = u[i] * v[j], right = u[j] * v[i];
    value += (left - right) * w[axis];
    size += (std::abs(left) + std::abs(right)) * std::abs(w[axis]);
  }
  if (size == 0) return 0;  // as in sheets along an axis
  return std::abs(value) > kErrorOfThree * size ? value : exact_orientation(a, b, c, d);
}

double orientation_without(std::size_t axis, const Vec3& a, const Vec3& b, const Vec3& c) {
  const std::size_t i = (axis + 1) % 3, j = (axis + 2) % 3;
  const double left = (b[i] - a[i]) * (c[j] - a[j]), right = (b[j] - a[j]) * (c[i] - a[i]);
  const double value = left - right;
  if (std::abs(value) > kErrorOfTwo * (std::abs(left) + std::abs(right))) return value;
  return exact_cross(exact_difference(b, a), exact_difference(c, a), i, j).value();
}

bool on_a_line(const Vec3& a, const Vec3& b, const Vec3& c) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (orientation_without(axis, a, b, c) != 0) return false;
  return true;
}

}  // namespace prismesh::mesh::contact
