#include "cli/batch_slurm.h"

#include <cerrno>
#include <set>

#include <sys/wait.h>

#include "base/child_process.h"
#include "base/file.h"
#include "cli/temporary_folder.h"
#include "mesh/report/id_list.h"

namespace prismesh::cli {

namespace {

/// A word of a shell script, whatever is in it.
std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

Result<void> write_text(const std::filesystem::path& file, const std::string& text) {
  const PendingFile pending{file, {text}};
  return replace_files({&pending, 1});
}

/// Runs sbatch. Returns the job's number.
Result<std::string> sbatch(const std::vector<std::string>& arguments) {
  const Result<TemporaryFolder> folder = TemporaryFolder::make();
  if (!folder) return fail(folder.error());
  std::vector<std::string> all{"sbatch", "--parsable"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  const std::filesystem::path out = folder->path() / "out", err = folder->path() / "err";
  const Result<pid_t> child = start_program(all, out, err);
  if (!child) return fail("sbatch", "Slurm's client can't be started, so nothing is submitted; the package slurm-client has it");
  int status = 0;
  while (waitpid(*child, &status, 0) < 0 && errno == EINTR) {
  }
  if (const auto failed = failure_words(status)) {
    const std::string said = last_line(err);
    return fail("sbatch", "the cluster refuses, and nothing is submitted: " + (said.empty() ? *failed : said));
  }
  const std::string job = last_line(out);
  return job.substr(0, job.find(';'));
}

}  // namespace

Result<SlurmJobs> submit(const SlurmWork& work) {
  const Result<std::filesystem::path> program = own_program();
  if (!program) return fail(program.error());
  std::set<std::int64_t> tasks;
  for (const std::size_t number : work.left) tasks.insert(static_cast<std::int64_t>(number % work.tasks));
  std::string array = mesh::report::id_list({tasks.begin(), tasks.end()});
  if (work.wish.max_at_once > 0) array += "%" + std::to_string(work.wish.max_at_once);

  const std::string command = "exec " + quoted(program->string()) + " batch " + quoted(work.study.string());
  const std::filesystem::path script = work.folder / "task.sh", collect = work.folder / "collect.sh";
  const std::string task = "#!/bin/sh\n" + command + " --task \"$SLURM_ARRAY_TASK_ID\" --tasks " + std::to_string(work.tasks) +
                           " --jobs \"${SLURM_CPUS_PER_TASK:-1}\"\n";
  if (Result<void> done = write_text(script, task); !done) return fail(done.error());
  if (Result<void> done = write_text(collect, "#!/bin/sh\n" + command + "\n"); !done) return fail(done.error());

  std::vector<std::string> arguments{"--array=" + array, "--job-name=" + work.name, "--requeue",
                                     "--output=" + (work.folder / "%A_%a.log").string()};
  arguments.insert(arguments.end(), work.wish.options.begin(), work.wish.options.end());
  arguments.push_back(script.string());
  const Result<std::string> job = sbatch(arguments);
  if (!job) return fail(job.error());
  SlurmJobs jobs;
  jobs.array = *job;
  std::vector<std::string> after{"--dependency=afterany:" + *job, "--job-name=" + work.name + ".tables",
                                 "--output=" + (work.folder / "%j.log").string()};
  after.insert(after.end(), work.wish.options.begin(), work.wish.options.end());
  after.push_back(collect.string());
  if (const Result<std::string> collector = sbatch(after))
    jobs.collector = *collector;
  else
    jobs.why = collector.error().message;
  return jobs;
}

}  // namespace prismesh::cli
