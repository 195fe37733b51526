// Measures the figures of `bench` on a deck that is open. Inner to cli.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "base/progress.h"
#include "cli/bench_figures.h"
#include "cli/timing.h"
#include "mesh/document/document.h"
#include "mesh/document/open.h"

namespace prismesh::cli {

/// Names of all figures, in the order in which they are measured.
std::vector<std::string_view> bench_figure_names();

struct BenchInput {
  const mesh::document::Document& opened;  ///< the deck as `options` opens it; doesn't change
  mesh::document::OpenOptions options;     ///< for opening it again
  std::filesystem::path save_folder;       ///< a folder that exists; what is saved there is removed again before the next run
  std::size_t patch_nodes;                 ///< of the patch that is lifted, about; where it fits, else a smaller one
  std::vector<std::string_view> names;     ///< figures to measure, in the order of bench_figure_names
};

/// Measures each figure and fills the deck's facts and the figures of `report`. A figure that this deck doesn't allow has a note with the
/// reason and no timing. `progress` hears of the share of the figures that is done. Errors: cancelled.
Result<void> measure_figures(const BenchInput& input, const Stopwatches& stopwatches, const Progress& progress, BenchReport& report);

}  // namespace prismesh::cli
