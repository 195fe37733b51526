// What `bench` measures and prints. Inner to cli.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/timing.h"
#include "mesh/document/edit.h"
#include "mesh/document/generation.h"

namespace prismesh::cli {

inline constexpr std::string_view kNoShells = "the deck has no shells";

/// Nodes that are lifted, relaxed and repaired: rings of neighbours around one node.
struct BenchPatch {
  mesh::NodeIndex centre;
  std::size_t nodes = 0;
  std::size_t shells = 0;                                      ///< that touch the nodes
  std::shared_ptr<const mesh::document::Generation> selected;  ///< the deck with the nodes selected; null: see `refusal`
  mesh::document::Lift lift;                                   ///< of the centre; far enough that shells get worse, where that is possible
  mesh::Vec3 slide_by = mesh::Vec3::Zero();  ///< of the centre, deck's length unit: a tenth of the way to the farthest node
  std::string refusal;                       ///< why no patch of this deck can be lifted; then only `centre` is set
};

/// What a figure's rate counts.
enum class SizeUnit : std::uint8_t { bytes, nodes, shells };
constexpr std::string_view name(SizeUnit unit) { return unit == SizeUnit::bytes ? "bytes" : unit == SizeUnit::nodes ? "nodes" : "shells"; }

struct BenchFigure {
  std::string_view name;
  std::string_view what;         ///< the measured work in a few words
  std::optional<Timing> timing;  ///< absent: it can't be measured on this deck, and `note` says why
  std::size_t size = 0;          ///< what one run works on
  SizeUnit unit = SizeUnit::nodes;
  std::string note;
};

/// Of the median wall time; 0 without a timing.
inline double rate_per_s(const BenchFigure& figure) {
  const bool timed = figure.timing && figure.timing->median_ms > 0;
  return timed ? static_cast<double>(figure.size) / figure.timing->median_ms * 1e3 : 0;
}

struct MachineFacts {
  std::size_t threads = 0;
  std::string processor;  ///< as the kernel names it; empty where it doesn't
};

struct BenchReport {
  MachineFacts machine;
  bool is_sample = false;
  std::string deck;  ///< path of the deck; of the sample its file's name
  std::string format;
  std::size_t bytes = 0;  ///< of all files of the deck
  std::size_t nodes = 0;
  std::size_t shells = 0;
  /// The lifted patch; 0 nodes: no figure needs one, or none can be lifted.
  std::int64_t patch_centre = 0;  ///< a node's id
  std::size_t patch_nodes = 0;
  std::size_t patch_shells = 0;
  std::vector<BenchFigure> figures;
};

}  // namespace prismesh::cli
