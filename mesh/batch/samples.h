// The sets of values that a plan gives its parameters.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mesh/batch/plan.h"

namespace prismesh::mesh::batch {

/// A coordinate of a point of Sobol's sequence, in [0, 1). `index`: of the point, from 0, the origin; below 2^32. `dimension`: below
/// kMaxSobolParameters. Direction numbers: S. Joe, F. Y. Kuo, "Constructing Sobol sequences with better two-dimensional projections",
/// SIAM J. Sci. Comput. 30 (2008) 2635-2654, table new-joe-kuo-6.21201.
double sobol(std::uint64_t index, std::size_t dimension);

/// All sets of a plan. The same plan gives the same on every machine.
class Samples {
 public:
  explicit Samples(const Plan& plan);

  /// The values of set `sample`, in the order of the parameters.
  std::vector<ParameterValue> at(std::size_t sample) const;
  /// Where a set lies in the unit cube; only of plans that aren't full.
  double unit(std::size_t sample, std::size_t parameter) const;

 private:
  const Plan& plan_;
  std::vector<std::vector<std::uint32_t>> strata_;  ///< of latin_hypercube: by parameter and sample
  std::vector<std::vector<float>> within_;          ///< likewise: where in its stratum
};

}  // namespace prismesh::mesh::batch
