// What is known of the machine that figures were measured on. Inner to cli.
#pragma once

#include "cli/bench_figures.h"

namespace prismesh::cli {

/// Asks the kernel: how many threads can run at once, and what the processor is called.
MachineFacts machine_facts();

}  // namespace prismesh::cli
