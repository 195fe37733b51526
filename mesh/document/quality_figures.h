// Sums up a generation's quality: counts by metric, a histogram, the worst shells, counts by part.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "mesh/document/document.h"

namespace prismesh::mesh::document {

struct QualityQuestion {
  std::string metric;    ///< for histogram and errors; empty: no histogram, the errors of all metrics
  bool damaged = false;  ///< only shells that the document's edits made worse
};
/// Names the shells whose metric is in [from, to). Without a bound that side is open.
struct ShellsWanted {
  std::string metric;
  std::optional<double> from, to;
  bool damaged = false;
};

struct QualityMetric {
  std::string name;  ///< a metric's, or a defect's: "not_finite", "repeated_node", "no_area"; "triangle_clusters", which counts nodes
  std::string unit;  ///< "deg", the deck's length unit, or nothing
  std::uint64_t warn = 0, fail = 0;  ///< a shell counts in one of them, or neither
};
struct QualityBar {
  double from = 0, to = 0;
  bool open_below = false, open_above = false;  ///< also counts all values beyond
  std::uint64_t ok = 0, warn = 0, fail = 0;     ///< shells, judged by the metric alone
};
/// A shell that warns or fails, and its worst metric; or a node with too many triangles about it.
struct QualityError {
  std::int64_t shell = 0;  ///< of a node: one of the triangles
  std::string metric;
  std::string unit;
  std::optional<double> value;  ///< absent for a defect
  bool fail = false;
  std::array<double, 3> at{};  ///< the shell's centre, or the node
  std::int64_t node = 0;       ///< 0: it is a shell
};
struct QualityPart {
  std::int64_t part = 0;
  std::uint64_t shells = 0, warn = 0, fail = 0;
  double composite = 1, least_composite = 1;  ///< mean and least over its shells: docs/quality/README.md
  double target_size = 0;                     ///< that they are judged by
  quality::SizeFrom size_from = quality::SizeFrom::part;
  std::string criteria{};  ///< the name of those that they are judged by
};
struct QualityFigures {
  std::uint64_t generation = 0;
  std::vector<QualityMetric> metrics;
  std::string metric;
  std::vector<QualityBar> bars;      ///< ascending
  std::vector<QualityError> errors;  ///< worst first; max kMaxQualityErrors
  std::uint64_t error_count = 0;
  std::vector<QualityPart> parts;  ///< those with counted shells, ascending by id
};
inline constexpr std::size_t kMaxQualityErrors = 500;
struct ShellsFound {
  std::uint64_t shells = 0;
  std::string expr;  ///< their ids, as an expression of kind element; empty: none
};
/// Cost: one pass over the shells, or over the damaged ones if only those are asked for. Errors: unknown metric, with the nearest name.
Result<QualityFigures> quality_figures(const Document& document, const QualityQuestion& question);
/// Finds the wanted shells, as an expression. Cost and errors: as above.
Result<ShellsFound> find_shells(const Document& document, const ShellsWanted& wanted);

}  // namespace prismesh::mesh::document
