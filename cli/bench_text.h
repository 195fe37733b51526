// The table that `bench` prints. Inner to cli.
#pragma once

#include <iosfwd>

#include "cli/bench_figures.h"

namespace prismesh::cli {

/// Machine and deck in two lines, then a line for each figure.
void print_bench(std::ostream& out, const BenchReport& report);

}  // namespace prismesh::cli
