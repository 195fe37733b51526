// Studies: decks, scripts and parameters, worked here or by Slurm. What a study is and what comes of it is mesh/batch's.
#include <algorithm>
#include <numeric>
#include <ostream>

#include "base/child_process.h"
#include "base/counted.h"
#include "base/file.h"
#include "base/hash.h"
#include "cli/batch_slurm.h"
#include "cli/batch_workers.h"
#include "cli/commands.h"
#include "cli/draw_picture.h"
#include "cli/json_output.h"
#include "cli/progress_bar.h"
#include "cli/report_text.h"
#include "mesh/batch/records.h"
#include "mesh/batch/store.h"
#include "mesh/batch/study.h"
#include "mesh/batch/tabulate.h"
#include "mesh/batch/work.h"

namespace prismesh::cli {

namespace {

namespace fs = std::filesystem;
using mesh::batch::RowState;
using mesh::batch::Store;
using mesh::batch::Study;
using mesh::batch::Table;

constexpr const char* kPictureSize = "240x150";

/// A job's name may hold few characters.
std::string file_name_of(std::string name) {
  for (char& c : name)
    if (!((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'))) c = '_';
  return name;
}

Result<void> write_file(const fs::path& file, const std::string& text) {
  const PendingFile pending{file, {text}};
  return replace_files({&pending, 1});
}

/// Writes the study where workers read it. Its name is its content's hash, so that it never changes.
Result<fs::path> keep_study(const Study& study) {
  const std::string text = mesh::batch::study_json(study);
  const fs::path file = study.plan.output / "studies" / (hash128(std::as_bytes(std::span(text.data(), text.size()))).hex() + ".json");
  std::error_code failed;
  if (fs::exists(file, failed)) return file;
  if (Result<void> made = make_folders(file.parent_path()); !made) return fail(made.error());
  if (Result<void> written = write_file(file, text); !written) return fail(written.error());
  return file;
}

/// A frozen study is a file of JSON; anything else is a plan.
Result<Study> read_plan_or_study(const fs::path& file, const Context& context) {
  if (file.extension() == ".json") return mesh::batch::read_study(file);
  MonotonicClock clock;
  ProgressBar bar(context, "reading " + file.filename().string(), clock);
  return mesh::batch::freeze(file, bar.progress());
}

mesh::batch::Painter painter_of(const Study& study, const Context& context) {
  if (!study.plan.pictures) return {};
  return [&context](const mesh::document::Document& document, const fs::path& file,
                    const std::optional<mesh::report::PartFigures::Box>& box) -> Result<void> {
    std::vector<std::string> how{"--size", kPictureSize, "--profile", "mono"};
    if (box) {
      how.insert(how.end(), {"--box", box_argument(*box)});
    }
    // coloured by displacement where a node has moved
    const mesh::Model& before = document.opened->model;
    const double most = mesh::largest_move(before, document.current().model, mesh::moved_nodes(before, document.current().model));
    std::optional<SealedField> field;
    if (most > 0) {
      Result<SealedField> sealed = seal_field(document, {}, &before, "the deck", displacement_limits(most));
      if (!sealed) return fail(sealed.error());
      field = std::move(*sealed);
      how.insert(how.end(), field->arguments.begin(), field->arguments.end());
      how.insert(how.end(), {"--legend", "none"});
    }
    const Result<int> drawn = draw_picture(document, file, how, field ? field->values.get() : -1, context);
    if (!drawn) return fail(drawn.error());
    if (*drawn != kDone) return fail("prismesh-kiosk", "couldn't draw it");
    return {};
  };
}

/// What a worker does: one variant, here, in this process.
int work_one(const Study& study, std::size_t number, const Context& context) {
  const Store store(study.plan.output);
  const mesh::batch::Variants variants(study);
  const auto refuse = [&](const Error& error) {
    say(context, error);
    return kFailed;
  };
  if (number < 1 || number > variants.count())
    return refuse({study.plan_file.string(), 0,
                   "has " + counted(variants.count(), "variant") + ", and none with the number " + std::to_string(number)});
  const mesh::batch::Variant variant = variants.at(number - 1);
  const Result<std::string> key = variants.key(variant);
  if (!key) return refuse(key.error());
  if (store.has(*key)) return kDone;
  MonotonicClock clock;
  const Progress progress([&context](double) { return !context.stop(); });
  const auto failed = [&](const Error& error) {
    if (!is_cancelled(error)) {
      // the disk may be full; who started this notes what was said then
      [[maybe_unused]] const Result<void> noted = store.note({*key, error.text(), 0});
    }
    return refuse(error);
  };
  store.forget_failure(*key);
  Result<mesh::batch::WorkFolder> folder = store.begin(*key);
  if (!folder) return failed(folder.error());
  const auto result = mesh::batch::work_variant(study, variants, variant, folder->path(), painter_of(study, context), clock, progress);
  if (!result) return failed(result.error());
  const Result<bool> accepted = store.accept(std::move(*folder), *result);
  return accepted ? kDone : failed(accepted.error());
}

/// A task of Slurm's array: its share of the variants, one process each.
int work_task(const Study& study, const BatchOptions& options, const Context& context) {
  const Store store(study.plan.output);
  std::vector<std::size_t> numbers;
  for (std::size_t number = *options.task; number < variant_count(study.plan); number += options.tasks) numbers.push_back(number);
  Result<WorkToDo> work = work_left(study, store, numbers);
  if (work) {
    work->study = options.plan;
    work->jobs = options.jobs.value_or(1);
    work->max_minutes = 1e9;  // Slurm has limits of its own
    const Result<std::size_t> without = run_workers(*work, store, context);
    if (without) return *without == 0 ? kDone : kFailed;
    work = fail(without.error());
  }
  say(context, work.error());
  return kFailed;
}

/// Writes the tables and the page, and says how it stands. The status is that of a command that did everything only where every variant has
/// a result.
int tell(const Study& study, const Common& common, const Context& context) {
  const Store store(study.plan.output);
  const auto refuse = [&](const Error& error) {
    say(context, error);
    return kFailed;
  };
  store.remove_left_work();
  const Result<Table> table = mesh::batch::tabulate(study, store);
  if (!table) return refuse(table.error());
  if (Result<void> made = make_folders(store.folder()); !made) return refuse(made.error());
  const fs::path page = store.folder() / "results.html";
  const std::string texts[] = {mesh::batch::table_csv(*table), mesh::batch::table_json(*table), mesh::batch::table_page(*table, store)};
  const PendingFile files[] = {
      {store.folder() / "results.csv", {texts[0]}}, {store.folder() / "results.json", {texts[1]}}, {page, {texts[2]}}};
  if (const Result<void> written = replace_files(files); !written) return refuse(written.error());
  const std::size_t lacking = table->count(RowState::failed) + table->count(RowState::missing);
  if (common.json) {
    context.out << batch_json(*table, page.string()) << '\n';
  } else {
    context.out << counted(table->rows.size(), "variant") << ": " << table->count(RowState::done) << " done, "
                << table->count(RowState::refused) << " refused, " << table->count(RowState::failed) << " failed, "
                << table->count(RowState::missing) << " missing\n"
                << printable(page.string()) << '\n';
  }
  for (const mesh::batch::Row& row : table->rows) {
    if (row.state != RowState::failed) continue;
    say(context, Error{study.plan_file.string(), 0,
                       "variant " + std::to_string(row.number) + " failed: " + row.reason +
                           (table->count(RowState::failed) > 1 ? " (the page has the others)" : "")});
    break;
  }
  return lacking == 0 ? kDone : kFailed;
}

int work_here(const Study& study, const BatchOptions& options, const Common& common, const Context& context) {
  const Store store(study.plan.output);
  const auto refuse = [&](const Error& error) {
    say(context, error);
    return kFailed;
  };
  const Result<fs::path> file = keep_study(study);
  if (!file) return refuse(file.error());
  std::vector<std::size_t> all(variant_count(study.plan));
  std::iota(all.begin(), all.end(), std::size_t{0});
  Result<WorkToDo> work = work_left(study, store, all);
  if (!work) return refuse(work.error());
  work->study = *file;
  work->jobs = options.jobs.value_or(own_cores().size());
  const Result<std::size_t> without = run_workers(*work, store, context);
  if (!without) return refuse(without.error());
  if (context.stop()) say(context, Error{options.plan.string(), 0, "stopped; the same command goes on with what is missing"});
  return tell(study, common, context);
}

int give_to_slurm(const Study& study, const Common& common, const Context& context) {
  const Store store(study.plan.output);
  const auto refuse = [&](const Error& error) {
    say(context, error);
    return kFailed;
  };
  const Result<fs::path> file = keep_study(study);
  if (!file) return refuse(file.error());
  std::vector<std::size_t> all(variant_count(study.plan));
  std::iota(all.begin(), all.end(), std::size_t{0});
  const Result<WorkToDo> work = work_left(study, store, all);
  if (!work) return refuse(work.error());
  if (work->numbers.empty()) return tell(study, common, context);
  SlurmWork slurm;
  slurm.study = *file;
  slurm.folder = store.folder() / "slurm";
  slurm.name = file_name_of(study.plan.name);
  slurm.tasks = std::min(variant_count(study.plan), study.plan.slurm.max_tasks);
  slurm.left = work->numbers;
  slurm.wish = study.plan.slurm;
  if (Result<void> made = make_folders(slurm.folder); !made) return refuse(made.error());
  const Result<SlurmJobs> jobs = submit(slurm);
  if (!jobs) return refuse(jobs.error());
  if (!jobs->why.empty()) say(context, Error{"sbatch", 0, "warning: no job makes the tables afterwards: " + jobs->why});
  if (common.json)
    context.out << submitted_json(work->numbers.size(), jobs->array, jobs->collector) << '\n';
  else
    context.out << counted(work->numbers.size(), "variant") << " submitted as job " << jobs->array
                << (jobs->collector.empty() ? std::string() : "; job " + jobs->collector + " makes the tables after it") << '\n';
  return kDone;
}

}  // namespace

int batch(const BatchOptions& options, const Common& common, const Context& context) {
  if (common.length_unit || !common.rules.empty()) {
    say(context, Error{"prismesh batch", 0, "the plan says length_unit, target_size and criteria, so that every worker has the same"});
    return kWrongUsage;
  }
  if (options.task && *options.task >= options.tasks) {
    say(context, Error{"--task", 0, "tasks count from 0 and there are " + std::to_string(options.tasks) + ": give --tasks as well"});
    return kWrongUsage;
  }
  const Result<Study> study = read_plan_or_study(options.plan, context);
  if (!study) {
    say(context, study.error());
    return kFailed;
  }
  if (options.variant) return work_one(*study, *options.variant, context);
  if (options.task) return work_task(*study, options, context);
  if (options.local) return work_here(*study, options, common, context);
  if (options.slurm) return give_to_slurm(*study, common, context);
  return tell(*study, common, context);
}

}  // namespace prismesh::cli
