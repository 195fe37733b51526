#include "mesh/batch/samples.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <utility>

namespace prismesh::mesh::batch {

namespace {

constexpr int kBits = 32;

/// A primitive polynomial by its degree and inner coefficients, and the first direction numbers.
struct Direction {
  int degree;
  std::uint32_t coefficients;
  std::array<std::uint32_t, 5> first;
};
constexpr std::array<Direction, kMaxSobolParameters - 1> kDirections{{{1, 0, {1}},
                                                                      {2, 1, {1, 3}},
                                                                      {3, 1, {1, 3, 1}},
                                                                      {3, 2, {1, 1, 1}},
                                                                      {4, 1, {1, 1, 3, 3}},
                                                                      {4, 4, {1, 3, 5, 13}},
                                                                      {5, 2, {1, 1, 5, 5, 17}},
                                                                      {5, 4, {1, 1, 5, 5, 5}},
                                                                      {5, 7, {1, 1, 7, 11, 19}}}};

using Directions = std::array<std::uint32_t, kBits>;

/// The recurrence of the direction numbers, shifted to the top bits.
Directions directions_of(std::size_t dimension) {
  Directions v{};
  if (dimension == 0) {
    for (int bit = 0; bit < kBits; ++bit) v[bit] = 1U << (kBits - 1 - bit);
    return v;
  }
  const Direction& given = kDirections[dimension - 1];
  for (int bit = 0; bit < kBits; ++bit) {
    if (bit < given.degree) {
      v[bit] = given.first[bit] << (kBits - 1 - bit);
      continue;
    }
    v[bit] = v[bit - given.degree] ^ (v[bit - given.degree] >> given.degree);
    for (int k = 1; k < given.degree; ++k)
      if ((given.coefficients >> (given.degree - 1 - k) & 1U) != 0) v[bit] ^= v[bit - k];
  }
  return v;
}

const std::array<Directions, kMaxSobolParameters>& all_directions() {
  static const std::array<Directions, kMaxSobolParameters> kAll = [] {
    std::array<Directions, kMaxSobolParameters> all{};
    for (std::size_t dimension = 0; dimension < kMaxSobolParameters; ++dimension) all[dimension] = directions_of(dimension);
    return all;
  }();
  return kAll;
}

/// SplitMix64: standard generators' distributions differ between libraries, and a plan must not.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15ULL);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31);
  }
  /// In [0, 1).
  double unit() { return static_cast<double>(next() >> 11) * 0x1p-53; }
  std::size_t below(std::size_t end) { return static_cast<std::size_t>(unit() * static_cast<double>(end)); }

 private:
  std::uint64_t state_;
};

/// Nine digits are enough for any mesh, and scripts and tables stay readable.
double rounded_to_nine(double value) {
  char text[32];
  const int size = std::snprintf(text, sizeof text, "%.9g", value);
  double read = value;
  std::from_chars(text, text + size, read);
  return read;
}

}  // namespace

double sobol(std::uint64_t index, std::size_t dimension) {
  const Directions& v = all_directions()[dimension];
  std::uint32_t x = 0;
  // Gray code: the order of Antonov and Saleev, in which the sequence is published
  for (std::uint64_t gray = index ^ (index >> 1), bit = 0; gray != 0; gray >>= 1, ++bit)
    if ((gray & 1U) != 0) x ^= v[bit];
  return x * 0x1p-32;
}

Samples::Samples(const Plan& plan) : plan_(plan) {
  if (plan.sampling != Sampling::latin_hypercube) return;
  Random random(plan.seed);
  for (std::size_t parameter = 0; parameter < plan.parameters.size(); ++parameter) {
    std::vector<std::uint32_t>& strata = strata_.emplace_back(plan.samples);
    std::iota(strata.begin(), strata.end(), 0U);
    for (std::size_t i = strata.size(); i > 1; --i) std::swap(strata[i - 1], strata[random.below(i)]);
    std::vector<float>& within = within_.emplace_back(plan.samples);
    // away from the ends, so that rounding keeps a value in its stratum
    for (float& place : within) place = static_cast<float>(0.01 + 0.98 * random.unit());
  }
}

double Samples::unit(std::size_t sample, std::size_t parameter) const {
  if (plan_.sampling == Sampling::sobol) return sobol(sample, parameter);
  return (strata_[parameter][sample] + static_cast<double>(within_[parameter][sample])) / static_cast<double>(plan_.samples);
}

std::vector<ParameterValue> Samples::at(std::size_t sample) const {
  std::vector<ParameterValue> values(plan_.parameters.size());
  for (std::size_t p = plan_.parameters.size(); p-- > 0;) {
    const Parameter& parameter = plan_.parameters[p];
    if (plan_.sampling == Sampling::full) {  // the last parameter changes first
      values[p] = parameter.values[sample % parameter.values.size()];
      sample /= parameter.values.size();
    } else if (parameter.values.empty()) {
      values[p] = rounded_to_nine(parameter.from + unit(sample, p) * (parameter.to - parameter.from));
    } else {
      values[p] = parameter.values[static_cast<std::size_t>(unit(sample, p) * static_cast<double>(parameter.values.size()))];
    }
  }
  return values;
}

}  // namespace prismesh::mesh::batch
