// Gives the variants of a study to Slurm. Inner to cli.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "base/error.h"
#include "mesh/batch/plan.h"

namespace prismesh::cli {

struct SlurmWork {
  std::filesystem::path study;    ///< the frozen study's file
  std::filesystem::path folder;   ///< for scripts and logs
  std::string name;               ///< of the jobs
  std::size_t tasks = 1;          ///< task t works the variants t, t + tasks, ..
  std::vector<std::size_t> left;  ///< the variants without a result, from 0, ascending
  mesh::batch::SlurmWish wish;
};

struct SlurmJobs {
  std::string array;      ///< the number of the job array
  std::string collector;  ///< of the job that makes the tables when all tasks have ended; empty: it was refused
  std::string why;        ///< it was refused
};

/// Submits an array of those tasks that have work left, and a job that makes the tables after them. Errors: there is no sbatch, it refuses
/// (with its reason), a file can't be written; then nothing is submitted.
Result<SlurmJobs> submit(const SlurmWork& work);

}  // namespace prismesh::cli
