#include "cli/batch_workers.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include <sys/wait.h>
#include <unistd.h>

#include "base/child_process.h"
#include "cli/progress_bar.h"
#include "cli/temporary_folder.h"
#include "mesh/batch/read_many.h"

namespace prismesh::cli {

namespace {

using mesh::batch::Store;

constexpr useconds_t kPauseMicroseconds = 5000;

/// A place for one worker after another, with processors of its own.
struct Slot {
  std::vector<std::size_t> cores;
  std::filesystem::path out, err;
  pid_t child = 0;  ///< 0: free
  std::size_t index = 0;
  std::int64_t begun_ns = 0;
  bool is_late = false;
};

/// Shares the processors among the slots; where there are more slots, several have the same one.
std::vector<Slot> make_slots(std::size_t jobs, const std::filesystem::path& folder) {
  const std::vector<std::size_t> cores = own_cores();
  std::vector<Slot> slots(jobs);
  for (std::size_t s = 0; s < std::max(jobs, cores.size()); ++s) slots[s % jobs].cores.push_back(cores[s % cores.size()]);
  for (std::size_t s = 0; s < jobs; ++s) {
    slots[s].out = folder / ("out" + std::to_string(s));
    slots[s].err = folder / ("err" + std::to_string(s));
  }
  return slots;
}

/// Notes a failure that the worker couldn't note: it crashed, took too long or had no room.
void note_failure(const Slot& slot, int status, const std::string& key, double seconds, const WorkToDo& work, const Store& store) {
  if (store.failure_of(key)) return;
  std::string reason = "the worker " + failure_words(status).value_or("left no result");
  if (slot.is_late) reason = "the worker was ended after " + std::to_string(work.max_minutes) + " minutes";
  if (const std::string said = last_line(slot.err); !said.empty() && WIFEXITED(status)) reason = said;
  // the disk may be full; then the table says "missing"
  [[maybe_unused]] const Result<void> noted = store.note({key, reason, seconds});
}

class Crew {
 public:
  Crew(const WorkToDo& work, const Store& store, const Context& context, std::vector<std::string> command, std::vector<Slot> slots)
      : work_(work), store_(store), context_(context), command_(std::move(command)), slots_(std::move(slots)) {}
  ~Crew() {
    for (const Slot& slot : slots_)
      if (slot.child != 0) kill(slot.child, SIGKILL), waitpid(slot.child, nullptr, 0);
  }
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;

  Result<std::size_t> run() {
    ProgressBar bar(context_, "batch", clock_);
    const Progress progress = bar.progress();
    bool is_stopping = false;
    while (busy_ > 0 || (next_ < work_.numbers.size() && !is_stopping)) {
      if (!is_stopping && context_.stop()) {
        is_stopping = true;
        for (const Slot& slot : slots_)
          if (slot.child != 0) kill(slot.child, SIGTERM);
      }
      bool changed = false;
      for (Slot& slot : slots_) {
        if (slot.child != 0) changed = look_at(slot) || changed;
        if (slot.child == 0 && !is_stopping && next_ < work_.numbers.size()) {
          if (Result<void> begun = begin(slot); !begun) return fail(begun.error());
          changed = true;
        }
      }
      if (!changed) usleep(kPauseMicroseconds);
      progress(static_cast<double>(ended_) / static_cast<double>(work_.numbers.size()), [this] {
        return std::to_string(ended_) + " of " + std::to_string(work_.numbers.size()) + " variants, " + std::to_string(without_) +
               " without a result";
      });
    }
    return without_ + (work_.numbers.size() - ended_);
  }

 private:
  Result<void> begin(Slot& slot) {
    slot.index = next_++;
    std::vector<std::string> arguments = command_;
    arguments.push_back(std::to_string(work_.numbers[slot.index] + 1));
    Result<pid_t> child = start_program(arguments, slot.out, slot.err, slot.cores);
    if (!child) return fail(child.error());
    slot.child = *child;
    slot.begun_ns = clock_.now_ns();
    slot.is_late = false;
    ++busy_;
    return {};
  }

  /// Whether its worker has ended.
  bool look_at(Slot& slot) {
    const double seconds = static_cast<double>(clock_.now_ns() - slot.begun_ns) * 1e-9;
    if (!slot.is_late && seconds > work_.max_minutes * 60) slot.is_late = kill(slot.child, SIGKILL) == 0;
    int status = 0;
    const pid_t ended = waitpid(slot.child, &status, WNOHANG);
    if (ended == 0 || (ended < 0 && errno == EINTR)) return false;
    const pid_t worker = std::exchange(slot.child, 0);
    --busy_;
    ++ended_;
    const std::string& key = work_.keys[slot.index];
    if (store_.has(key)) return true;
    ++without_;
    store_.remove_work(key, worker);  // of a worker that was killed
    if (!context_.stop()) note_failure(slot, status, key, seconds, work_, store_);
    return true;
  }

  const WorkToDo& work_;
  const Store& store_;
  const Context& context_;
  std::vector<std::string> command_;
  std::vector<Slot> slots_;
  MonotonicClock clock_;
  std::size_t next_ = 0, busy_ = 0, ended_ = 0, without_ = 0;
};

}  // namespace

Result<WorkToDo> work_left(const mesh::batch::Study& study, const Store& store, const std::vector<std::size_t>& numbers) {
  enum class Found : std::uint8_t { nothing, damaged, result };
  const mesh::batch::Variants variants(study);
  std::vector<Result<std::string>> keys(numbers.size());
  std::vector<Found> found(numbers.size(), Found::nothing);
  mesh::batch::read_many(numbers.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      keys[i] = variants.key(variants.at(numbers[i]));
      if (keys[i] && store.has(*keys[i])) found[i] = store.result_of(*keys[i]) ? Found::result : Found::damaged;
    }
  });
  WorkToDo work;
  work.max_minutes = study.plan.max_minutes;
  std::set<std::string> seen;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (!keys[i]) return fail(keys[i].error());
    if (!seen.insert(*keys[i]).second || found[i] == Found::result) continue;
    if (found[i] == Found::damaged)
      if (Result<void> aside = store.set_aside(*keys[i]); !aside) return fail(aside.error());
    work.numbers.push_back(numbers[i]);
    work.keys.push_back(std::move(*keys[i]));
  }
  return work;
}

Result<std::size_t> run_workers(const WorkToDo& work, const Store& store, const Context& context) {
  if (work.numbers.empty()) return 0;
  const Result<std::filesystem::path> program = own_program();
  if (!program) return fail(program.error());
  const Result<TemporaryFolder> folder = TemporaryFolder::make();
  if (!folder) return fail(folder.error());
  const std::size_t jobs = std::clamp<std::size_t>(work.jobs, 1, work.numbers.size());
  Crew crew(work, store, context, {program->string(), "batch", work.study.string(), "--variant"}, make_slots(jobs, folder->path()));
  return crew.run();
}

}  // namespace prismesh::cli
