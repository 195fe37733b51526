// The metric kernels: loops over lanes. They are inlined, so that each caller compiles them for its own target: shell_batch.cpp for several
// processors, the tests without extensions to compare the bits. Private to mesh/quality.
#pragma once

#include <limits>

#include "mesh/quality/shell_lanes.h"

#define PRISMESH_INLINE inline __attribute__((always_inline))

namespace prismesh::mesh::quality::kernels {

inline constexpr float kNotApplicable = std::numeric_limits<float>::quiet_NaN();
inline constexpr double kWorstAspect = 999999936.0;         ///< the float below kRepeatedAspect
inline constexpr double kWorstSkew = 89.99999237060546875;  ///< the float below kNoAreaSkew
inline constexpr double kMax2 = 1e76;                       ///< squared lengths beyond it count as not finite
/// Added to divisors that may be zero; far below any product of real lengths.
inline constexpr double kTiny = 1e-300;

struct Vector {
  double x, y, z;
};
PRISMESH_INLINE Vector operator+(Vector a, Vector b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
PRISMESH_INLINE Vector operator-(Vector a, Vector b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
PRISMESH_INLINE double dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
PRISMESH_INLINE Vector cross(Vector a, Vector b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
PRISMESH_INLINE double norm(Vector a) { return __builtin_sqrt(dot(a, a)); }
PRISMESH_INLINE double low(double a, double b) { return a < b ? a : b; }
PRISMESH_INLINE double high(double a, double b) { return a > b ? a : b; }
PRISMESH_INLINE double low(double a, double b, double c, double d) { return low(low(a, b), low(c, d)); }
PRISMESH_INLINE double high(double a, double b, double c, double d) { return high(high(a, b), high(c, d)); }

PRISMESH_INLINE Vector point(const ShellBatch& batch, std::size_t corner, std::size_t lane) {
  return {batch.p[corner][0][lane], batch.p[corner][1][lane], batch.p[corner][2][lane]};
}

// An angle between 0 and 180 degrees is carried as its "turn" u = cos / (|cos| + sin): 1 at 0, 0 at 90, -1 at 180,
// falling all the way and precise at both ends, where the cosine alone isn't. The smallest of several angles is the one
// with the highest turn, so one polynomial serves them all.
PRISMESH_INLINE double turn(double cosine, double sine) { return cosine / (__builtin_fabs(cosine) + sine + kTiny); }

/// Degrees of a turn. With x = 1 - 2|u| the angle is 45 + atan(x) for u >= 0; the polynomial is the interpolation of atan(x) / x
/// in x^2 at twelve Chebyshev points, in degrees, with 45 exactly at x = 1; its error is below 5e-9 degrees.
PRISMESH_INLINE double degrees(double u) {
  const double x = 1.0 - 2.0 * __builtin_fabs(u);
  const double z = x * x;
  double sum = -0.03800975984058245;
  sum = sum * z + 0.2711513708954496;
  sum = sum * z - 0.9068960902971699;
  sum = sum * z + 1.938099582880123;
  sum = sum * z - 3.0914900732751267;
  sum = sum * z + 4.141498423359225;
  sum = sum * z - 5.141821778389031;
  sum = sum * z + 6.355203725032931;
  sum = sum * z - 8.184022149071046;
  sum = sum * z + 11.459099238334735;
  sum = sum * z - 19.098592000793605;
  sum = sum * z + 57.2957795111641;
  const double angle = 45.0 + x * sum;
  return u < 0 ? 180.0 - angle : angle;
}

/// Warpage about one diagonal as a turn, from the normals of the two triangles; 1 (no angle) where one has no plane.
PRISMESH_INLINE double fold(Vector n, Vector m, double nn, double mm, double smallest) {
  const double u = turn(dot(n, m), norm(cross(n, m)));
  return low(nn, mm) > smallest ? u : 1.0;
}

/// Turn of an interior angle of a quad; a reentrant corner goes on from -1 (180 degrees) to -3 (360).
PRISMESH_INLINE double corner_turn(Vector before, Vector after, double area, double side) {
  const double u = turn(-dot(before, after), area);
  return side < 0 ? -2.0 - u : u;
}

PRISMESH_INLINE void quads(const ShellBatch& batch, BatchValues& values) {
  values.of_triangles = false;
  constexpr double kGauss = 0.57735026918962576;  // 1 / sqrt 3
  const std::size_t lanes = batch.padded();
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    const Vector p0 = point(batch, 0, lane), p1 = point(batch, 1, lane), p2 = point(batch, 2, lane), p3 = point(batch, 3, lane);
    const Vector e0 = p1 - p0, e1 = p2 - p1, e2 = p3 - p2, e3 = p0 - p3;
    const double l0 = dot(e0, e0), l1 = dot(e1, e1), l2 = dot(e2, e2), l3 = dot(e3, e3);
    const double shortest2 = low(l0, l1, l2, l3), longest2 = high(l0, l1, l2, l3);
    const double shortest = __builtin_sqrt(shortest2), longest = __builtin_sqrt(longest2);
    // twice the corner triangles' areas as vectors, and twice the quad's
    const Vector n0 = cross(e3, e0), n1 = cross(e0, e1), n2 = cross(e1, e2), n3 = cross(e2, e3);
    const Vector whole = cross(p2 - p0, p3 - p1);
    const double a0 = norm(n0), a1 = norm(n1), a2 = norm(n2), a3 = norm(n3), area = norm(whole);
    const double j0 = dot(n0, whole), j1 = dot(n1, whole), j2 = dot(n2, whole), j3 = dot(n3, whole);

    const bool finite = l0 + l1 + l2 + l3 < kMax2;  // no for NaN
    const double no_plane = kMinArea * longest2;
    // folded onto itself: its sides cross, so that two corners are turned in
    const double turned_in = -kMinArea * area * longest2;
    const auto counts = [&](double j) { return j < turned_in ? 1.0 : 0.0; };
    const double inward = counts(j0) + counts(j1) + counts(j2) + counts(j3);
    const bool has_area = (area > no_plane) & (inward < 1.5);
    const Vector d0 = p2 - p0, d1 = p3 - p1;
    const double closest2 = low(shortest2, low(dot(d0, d0), dot(d1, d1)));
    const bool has_edges = (closest2 > 1e-24 * longest2) & (longest2 > kTiny);
    const auto put = [&](Metric metric, double value) {
      values.value[int(metric)][lane] = finite ? static_cast<float>(value) : kNotApplicable;
    };

    const double folded = low(fold(n1, n3, a1, a3, no_plane), fold(n0, n2, a0, a2, no_plane));
    const double warpage = degrees(folded);
    put(Metric::warpage, has_area ? warpage : 180.0);

    const double aspect = longest / (shortest + kTiny);
    put(Metric::aspect, has_edges ? low(aspect, kWorstAspect) : double{kRepeatedAspect});

    const double askew = 90.0 - degrees(turn(__builtin_fabs(dot(e0 - e2, e1 - e3)), 2.0 * area));
    put(Metric::skew, has_area ? low(askew, kWorstSkew) : double{kNoAreaSkew});

    // the determinant runs linearly over the quad, so the Gauss points follow from the corners
    const double mean = j0 + j1 + j2 + j3;
    const double spread = kGauss * (__builtin_fabs(j1 + j2 - j0 - j3) + __builtin_fabs(j2 + j3 - j0 - j1));
    const double jacobian = (mean - spread) / (mean + spread + kTiny);
    put(Metric::jacobian, has_area ? jacobian : -1.0);

    const double smallest =
        low(__builtin_copysign(a0, j0), __builtin_copysign(a1, j1), __builtin_copysign(a2, j2), __builtin_copysign(a3, j3));
    const double taper = 1.0 - 2.0 * smallest / (area + kTiny);
    put(Metric::taper, has_area ? high(low(taper, 2.0), 0.0) : 2.0);

    const double t0 = corner_turn(e3, e0, a0, j0), t1 = corner_turn(e0, e1, a1, j1);
    const double t2 = corner_turn(e1, e2, a2, j2), t3 = corner_turn(e2, e3, a3, j3);
    const double widest = low(t0, t1, t2, t3);
    const double narrow = degrees(high(t0, t1, t2, t3));
    const double wide = widest < -1.0 ? 360.0 - degrees(-2.0 - widest) : degrees(widest);
    put(Metric::min_angle_quad, has_edges ? narrow : 0.0);
    put(Metric::max_angle_quad, has_edges ? wide : 360.0);
    values.value[int(Metric::min_angle_tri)][lane] = kNotApplicable;
    values.value[int(Metric::max_angle_tri)][lane] = kNotApplicable;
    put(Metric::min_length, shortest);
    put(Metric::max_length, longest);
  }
}

PRISMESH_INLINE void triangles(const ShellBatch& batch, BatchValues& values) {
  values.of_triangles = true;
  const std::size_t lanes = batch.padded();
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    const Vector p0 = point(batch, 0, lane), p1 = point(batch, 1, lane), p2 = point(batch, 2, lane);
    const Vector e0 = p1 - p0, e1 = p2 - p1, e2 = p0 - p2;
    const double l0 = dot(e0, e0), l1 = dot(e1, e1), l2 = dot(e2, e2);
    const double shortest2 = low(low(l0, l1), l2), longest2 = high(high(l0, l1), l2);
    const double shortest = __builtin_sqrt(shortest2), longest = __builtin_sqrt(longest2);
    const double area = norm(cross(e0, e1));  // twice the triangle's
    const double c0 = -dot(e2, e0), c1 = -dot(e0, e1), c2 = -dot(e1, e2);
    // half the difference of two sides' squares: median times side, without its sine, which is `area` for all three
    const double m0 = l0 - l2, m1 = l1 - l0, m2 = l2 - l1;

    const bool finite = l0 + l1 + l2 < kMax2;  // no for NaN
    const bool has_area = area > kMinArea * longest2;
    const bool has_edges = (shortest2 > 1e-24 * longest2) & (longest2 > kTiny);
    const auto put = [&](Metric metric, double value) {
      values.value[int(metric)][lane] = finite ? static_cast<float>(value) : kNotApplicable;
    };

    values.value[int(Metric::warpage)][lane] = kNotApplicable;
    const double aspect = longest / (shortest + kTiny);
    put(Metric::aspect, has_edges ? low(aspect, kWorstAspect) : double{kRepeatedAspect});
    const double flattest = 0.5 * high(high(__builtin_fabs(m0), __builtin_fabs(m1)), __builtin_fabs(m2));
    const double askew = 90.0 - degrees(turn(flattest, area));
    put(Metric::skew, has_area ? low(askew, kWorstSkew) : double{kNoAreaSkew});
    values.value[int(Metric::jacobian)][lane] = kNotApplicable;
    values.value[int(Metric::taper)][lane] = kNotApplicable;
    values.value[int(Metric::min_angle_quad)][lane] = kNotApplicable;
    values.value[int(Metric::max_angle_quad)][lane] = kNotApplicable;
    const double narrow = degrees(turn(high(high(c0, c1), c2), area));
    const double wide = degrees(turn(low(low(c0, c1), c2), area));
    put(Metric::min_angle_tri, has_edges ? narrow : 0.0);
    put(Metric::max_angle_tri, has_edges ? wide : 180.0);
    put(Metric::min_length, area / (longest + kTiny));
    put(Metric::max_length, longest);
  }
}

/// Mass and time step: areas, their moments, and the length that the step goes by.
template <bool kTriangles>
PRISMESH_INLINE void extents(const ShellBatch& batch, int shell_option, BatchExtents& out) {
  const std::size_t lanes = batch.padded();
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    const Vector p0 = point(batch, 0, lane), p1 = point(batch, 1, lane), p2 = point(batch, 2, lane);
    const Vector p3 = kTriangles ? p2 : point(batch, 3, lane);
    const Vector d0 = p2 - p0, d1 = p3 - p1;
    const double first = 0.5 * norm(cross(p1 - p0, d0));
    const double second = kTriangles ? 0.0 : 0.5 * norm(cross(d0, p3 - p0));
    out.area[lane] = first + second;
    const Vector a = p0 + p1 + p2, b = p0 + p2 + p3;
    out.moment[0][lane] = (first * a.x + second * b.x) / 3.0;
    out.moment[1][lane] = (first * a.y + second * b.y) / 3.0;
    out.moment[2][lane] = (first * a.z + second * b.z) / 3.0;

    const Vector e0 = p1 - p0, e1 = p2 - p1, e2 = p3 - p2, e3 = p0 - p3;
    const double l0 = dot(e0, e0), l1 = dot(e1, e1), l2 = dot(e2, e2), l3 = dot(e3, e3);
    const double flat = (kTriangles ? 1.0 : 0.5) * norm(cross(d0, d1));
    const double diagonal = __builtin_sqrt(high(dot(d0, d0), dot(d1, d1)));
    const double longest = shell_option == 1 ? diagonal : __builtin_sqrt(high(l0, l1, l2, l3));
    const double shortest = __builtin_sqrt(kTriangles ? low(low(l0, l1), l3) : low(l0, l1, l2, l3));
    const double over = longest > 0 ? flat / longest : 0.0;
    out.step_length[lane] = shell_option == 2 ? high(over, shortest) : over;
  }
}

}  // namespace prismesh::mesh::quality::kernels

#undef PRISMESH_INLINE
