// What became of a variant.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "mesh/batch/plan.h"

namespace prismesh::mesh::batch {

/// Figures of a deck in one state; absent ones aren't known. Deck's units.
struct Measured {
  std::size_t shells = 0, warn = 0, fail = 0;
  double triangles_percent = 0, composite_min = 1, composite_mean = 1;
  std::optional<double> mass, time_step;
  std::optional<std::size_t> perforations, penetrations;  ///< absent: they weren't searched
  std::optional<double> depth;                            ///< the greatest of these; absent also: no depth is known
};

struct NamedValue {
  std::string name;
  ParameterValue value;
};

enum class Outcome : std::uint8_t {
  done,     ///< the deck is written
  refused,  ///< an edit can't be done with these values; the same again would be refused again
};

/// The accepted result of a variant: there is one of each key, and it never changes.
struct VariantResult {
  std::string key;
  Outcome outcome = Outcome::done;
  std::string reason;  ///< of a refusal
  std::string version;
  std::string deck, script;  ///< file names
  std::vector<NamedValue> values;
  Measured before, after;
  std::size_t nodes_moved = 0;
  double max_displacement = 0;
  std::size_t elements_added = 0, elements_removed = 0;
  std::size_t lines_changed = 0;
  std::string written;  ///< the deck's main file in the result's folder; empty: none
  std::string picture;  ///< likewise
  std::vector<std::string> notes;
  double seconds = 0;
  double peak_mb = 0;  ///< memory
  std::string length_unit;
};

/// Why a variant has no result yet. Another try may have one.
struct Failure {
  std::string key;
  std::string reason;
  double seconds = 0;
};

}  // namespace prismesh::mesh::batch
