// Works variants of a study on this machine, each in a process of its own. Inner to cli.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "base/error.h"
#include "cli/context.h"
#include "mesh/batch/store.h"
#include "mesh/batch/study.h"

namespace prismesh::cli {

struct WorkToDo {
  std::filesystem::path study;       ///< the frozen study's file, which the workers read
  std::vector<std::size_t> numbers;  ///< of the variants, from 0
  std::vector<std::string> keys;     ///< of each
  std::size_t jobs = 1;              ///< workers at the same time; they share the processors
  double max_minutes = 60;           ///< a worker that takes longer is ended
};

/// Those of the given variants that have no result yet; of variants with the same key one. Errors: those of Variants::key.
Result<WorkToDo> work_left(const mesh::batch::Study& study, const mesh::batch::Store& store, const std::vector<std::size_t>& numbers);

/// Starts a worker for each, and notes why those failed that couldn't say it themselves. Returns how many got no result. Errors: a worker
/// can't be started.
Result<std::size_t> run_workers(const WorkToDo& work, const mesh::batch::Store& store, const Context& context);

}  // namespace prismesh::cli
