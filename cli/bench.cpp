// The core's own figures on this machine: what users wait for, measured on a deck or on the generated sample.
#include <algorithm>
#include <ostream>
#include <regex>
#include <system_error>

#include "cli/bench_text.h"
#include "cli/bench_work.h"
#include "cli/commands.h"
#include "cli/cpu_clock.h"
#include "cli/json_output.h"
#include "cli/machine_facts.h"
#include "cli/open_deck.h"
#include "cli/progress_bar.h"
#include "cli/report_text.h"
#include "cli/temporary_folder.h"
#include "mesh/deck/sample.h"

namespace prismesh::cli {

namespace {

constexpr const char* kCommand = "prismesh bench";
constexpr std::size_t kMaxFilterLength = 100;  ///< the library that reads regular expressions recurses for each character

/// What the arguments mean.
struct BenchPlan {
  std::optional<std::filesystem::path> deck;  ///< absent: the sample
  std::vector<std::string_view> names;        ///< of the figures wanted
  std::size_t patch_nodes = kBenchPatchDefault;
};

std::string all_names() {
  std::string all;
  for (const std::string_view name : bench_figure_names()) all += (all.empty() ? "" : ", ") + std::string(name);
  return all;
}

/// The figures whose names the filter finds itself in. Errors: it is no regular expression.
Result<std::vector<std::string_view>> matching_names(const std::string& filter) {
  if (filter.size() > kMaxFilterLength)
    return fail(kCommand, "the filter has more than " + std::to_string(kMaxFilterLength) + " characters");
  try {
    const std::regex pattern(filter, std::regex::ECMAScript | std::regex::icase);
    std::vector<std::string_view> names = bench_figure_names();
    std::erase_if(names, [&](std::string_view name) { return !std::regex_search(name.begin(), name.end(), pattern); });
    return names;
  } catch (const std::regex_error&) {
    return fail(kCommand, "the filter \"" + filter + "\" is no regular expression");
  }
}

bool is_there(const std::string& path) {
  std::error_code ignored;
  return std::filesystem::exists(path, ignored);
}

/// Errors: wrong usage.
Result<BenchPlan> plan_bench(const BenchOptions& options) {
  BenchPlan plan{{}, bench_figure_names(), options.patch.value_or(kBenchPatchDefault)};
  std::optional<std::string> filter = options.filter;
  if (options.deck && !options.filter && !is_there(*options.deck))
    filter = options.deck;
  else if (options.deck)
    plan.deck = *options.deck;
  if (plan.deck && options.elements) return fail(kCommand, "--elements is the size of the sample: leave it out with a deck");
  if (!filter) return plan;
  Result<std::vector<std::string_view>> names = matching_names(*filter);
  if (!names) return fail(std::move(names.error()));
  if (names->empty()) {
    const std::string no_deck = plan.deck ? "" : "there is no deck \"" + *filter + "\", and ";
    return fail(kCommand, no_deck + "no figure matches \"" + *filter + "\"; the figures are " + all_names());
  }
  plan.names = std::move(*names);
  return plan;
}

Result<void> write_sample_shown(const std::filesystem::path& path, std::size_t shells, const Context& context) {
  MonotonicClock clock;
  ProgressBar bar(context, "making the sample", clock);
  return mesh::deck::write_sample(path, shells, bar.progress());
}

Result<BenchReport> measure_shown(const std::filesystem::path& deck, const BenchPlan& plan, const std::filesystem::path& folder,
                                  const Common& common, const Context& context) {
  const Result<mesh::document::Document> opened = open_deck(deck, common, context);
  if (!opened) return fail(opened.error());
  say_warnings(context, *opened);
  BenchReport report;
  report.machine = machine_facts();
  report.is_sample = !plan.deck;
  report.deck = report.is_sample ? deck.filename().string() : deck.string();
  MonotonicClock wall;
  ProcessCpuClock cpu;
  ProgressBar bar(context, "measuring", wall);
  const BenchInput input{*opened, open_options(common), folder, plan.patch_nodes, plan.names};
  if (Result<void> measured = measure_figures(input, {wall, cpu}, bar.progress(), report); !measured)
    return fail(kCommand, measured.error().message);
  return report;
}

}  // namespace

int bench(const BenchOptions& options, const Common& common, const Context& context) {
  const auto refuse = [&](const Error& error, int status) {
    say(context, error);
    return status;
  };
  const Result<BenchPlan> plan = plan_bench(options);
  if (!plan) return refuse(plan.error(), kWrongUsage);
  const Result<TemporaryFolder> folder = TemporaryFolder::make();
  if (!folder) return refuse(folder.error(), kFailed);
  const std::filesystem::path deck = plan->deck.value_or(folder->path() / "sample.k");
  if (!plan->deck)
    if (const auto written = write_sample_shown(deck, options.elements.value_or(kBenchShellsDefault), context); !written)
      return refuse(written.error(), kFailed);
  const Result<BenchReport> report = measure_shown(deck, *plan, folder->path(), common, context);
  if (!report) return refuse(report.error(), kFailed);
  if (common.json)
    context.out << bench_json(*report) << '\n';
  else
    print_bench(context.out, *report);
  return kDone;
}

}  // namespace prismesh::cli
