#include "cli/bench_work.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

#include "base/file.h"
#include "cli/bench_patch.h"
#include "cli/measure.h"
#include "ipc/wire/descriptor.h"
#include "mesh/deck/data/deck.h"
#include "mesh/document/damage.h"
#include "mesh/document/drag.h"
#include "mesh/document/prepare.h"
#include "mesh/document/save.h"
#include "mesh/document/selection.h"
#include "mesh/report/check_figures.h"

namespace prismesh::cli {

namespace {

namespace document = mesh::document;

constexpr int kDragSteps = 20;  ///< steps from nothing to the whole lift, then again

/// What the figures share: the states of the document that they start from. None of them changes one: each run works on a copy, which
/// shares everything with it.
struct Bench {
  const BenchInput& input;
  const Stopwatches& stopwatches;
  Progress progress;
  BenchPatch patch;
  document::Document selected;  ///< with the patch selected
  document::Document lifted;    ///< with the patch lifted
};

Result<Timing> measure_on_copy(const Bench& bench, const document::Document& start, const document::Edit& edit,
                               document::EditReport& report) {
  document::Document copy;
  TimedWork work;
  work.prepare = [&] { copy = start; };
  work.run = [&]() -> Result<void> {
    Result<document::EditReport> done = document::apply(copy, edit, bench.progress);
    if (!done) return fail(std::move(done.error()));
    report = std::move(*done);
    return {};
  };
  return measure(work, bench.stopwatches);
}

Result<Timing> measure_open(Bench& bench, BenchFigure& figure) {
  const document::Document& opened = bench.input.opened;
  document::OpenOptions options = bench.input.options;
  options.progress = bench.progress;
  document::Document again;
  TimedWork work;
  work.prepare = [&] { again = {}; };
  work.run = [&]() -> Result<void> {
    Result<document::Document> done = document::open(opened.path, options);
    if (!done) return fail(std::move(done.error()));
    again = std::move(*done);
    return {};
  };
  for (const mesh::deck::SourceFile& file : opened.deck->files) figure.size += file.bytes.bytes().size();
  return measure(work, bench.stopwatches);
}

Result<Timing> measure_quality(Bench& bench, BenchFigure& figure) {
  if (bench.input.opened.current().model.shell_index->size() == 0) return fail("", std::string(kNoShells));
  mesh::report::CheckFigures checked;
  TimedWork work;
  work.run = [&]() -> Result<void> {
    checked = mesh::report::check_figures(bench.input.opened, nullptr, false);
    return {};
  };
  Result<Timing> timing = measure(work, bench.stopwatches);
  figure.size = checked.report.elements;
  return timing;
}

Result<Timing> measure_select_region(Bench& bench, BenchFigure& figure) {
  const document::Document& opened = bench.input.opened;
  document::SelectRegion edit;
  edit.at = opened.current().model.node_ids[bench.patch.centre.value];
  document::Document copy;
  TimedWork work;
  work.prepare = [&] { copy = opened; };
  work.run = [&]() -> Result<void> {
    Result<document::EditReport> done = document::apply(copy, edit);
    if (!done) return fail(std::move(done.error()));
    return {};
  };
  Result<Timing> timing = measure(work, bench.stopwatches);
  if (timing) figure.size = copy.current().selected_shells;
  return timing;
}

Result<Timing> measure_drag_begin(Bench& bench, BenchFigure& figure) {
  std::optional<document::Drag> drag;
  TimedWork work;
  work.prepare = [&] { drag.reset(); };
  work.run = [&]() -> Result<void> {
    Result<document::Drag> begun = document::Drag::begin(bench.patch.selected, bench.patch.lift);
    if (!begun) return fail(std::move(begun.error()));
    drag = std::move(*begun);
    return {};
  };
  figure.size = bench.patch.nodes;
  return measure(work, bench.stopwatches);
}

Result<Timing> measure_steps(const Bench& bench, const document::Edit& edit, const document::Displacement& whole) {
  Result<document::Drag> drag = document::Drag::begin(bench.patch.selected, edit);
  if (!drag) return fail(std::move(drag.error()));
  int step = 0;
  document::Displacement displacement;
  TimedWork work;
  work.prepare = [&] {
    step = step % kDragSteps + 1;
    const double share = static_cast<double>(step) / kDragSteps;
    displacement = {whole.by * share, whole.distance * share, 0};
  };
  work.run = [&]() -> Result<void> {
    drag->step(displacement);
    return {};
  };
  return measure(work, bench.stopwatches);
}

Result<Timing> measure_drag_step(Bench& bench, BenchFigure& figure) {
  figure.size = bench.patch.shells;
  return measure_steps(bench, bench.patch.lift, {mesh::Vec3::Zero(), bench.patch.lift.distance, 0});
}

Result<Timing> measure_slide_step(Bench& bench, BenchFigure& figure) {
  figure.size = bench.patch.nodes;
  document::Slide slide;
  slide.shaping = bench.patch.lift.shaping;
  return measure_steps(bench, slide, {bench.patch.slide_by, 0, 0});
}

Result<Timing> measure_lift(Bench& bench, BenchFigure& figure) {
  document::EditReport report;
  Result<Timing> timing = measure_on_copy(bench, bench.selected, bench.patch.lift, report);
  figure.size = report.nodes_moved;
  return timing;
}

/// An edit that names its nodes must follow what moves, not what is selected.
Result<Timing> measure_lift_beside(Bench& bench, BenchFigure& figure) {
  const mesh::Model& model = bench.input.opened.current().model;
  document::Document all = bench.input.opened;
  if (Result<document::EditReport> done = document::apply(all, document::Select{"all"}, bench.progress); !done)
    return fail(std::move(done.error()));
  std::string ids;
  for (const mesh::NodeIndex node : document::selected_nodes(*bench.patch.selected))
    ids += (ids.empty() ? "" : ",") + std::to_string(model.node_ids[node.value]);
  document::Lift lift = bench.patch.lift;
  lift.shaping.on = ids;
  document::EditReport report;
  Result<Timing> timing = measure_on_copy(bench, all, lift, report);
  figure.size = report.nodes_moved;
  return timing;
}

Result<Timing> measure_undo(Bench& bench, BenchFigure& figure) {
  document::EditReport report;
  Result<Timing> timing = measure_on_copy(bench, bench.lifted, document::Undo{}, report);
  figure.size = report.nodes_moved;
  return timing;
}

/// What an edit says that changed nothing.
std::string note_of(const document::EditReport& report) {
  const bool changed = report.nodes_moved + report.elements_added + report.elements_removed > 0;
  return changed || report.notes.empty() ? "" : report.notes.front();
}

Result<Timing> measure_relax(Bench& bench, BenchFigure& figure) {
  document::EditReport report;
  Result<Timing> timing = measure_on_copy(bench, bench.lifted, document::Relax{}, report);
  figure.size = bench.patch.nodes;
  figure.note = note_of(report);
  return timing;
}

Result<Timing> measure_relax_all(Bench& bench, BenchFigure& figure) {
  document::Relax relax;
  relax.scope = document::Scope::all;
  document::EditReport report;
  Result<Timing> timing = measure_on_copy(bench, bench.input.opened, relax, report);
  figure.size = bench.input.opened.current().model.node_index->size();
  figure.note = note_of(report);
  return timing;
}

Result<Timing> measure_repair(Bench& bench, BenchFigure& figure) {
  figure.size = document::damaged_shells(bench.lifted).size();
  if (figure.size == 0) return fail("", "the lift damages no shell, so there is nothing to repair");
  document::EditReport report;
  Result<Timing> timing = measure_on_copy(bench, bench.lifted, document::Repair{}, report);
  figure.note = note_of(report);
  return timing;
}

Result<Timing> measure_save(Bench& bench, BenchFigure& figure) {
  const bool has_lift = !bench.lifted.generations.empty();
  const document::Document& saved = has_lift ? bench.lifted : bench.input.opened;
  const std::filesystem::path folder = bench.input.save_folder / "saved";
  std::error_code ignored;
  mesh::deck::SaveReport report;
  TimedWork work;
  work.prepare = [&] { std::filesystem::remove_all(folder, ignored); };
  work.run = [&]() -> Result<void> {
    Result<mesh::deck::SaveReport> done = document::save(saved, folder / saved.path.filename(), bench.progress);
    if (!done) return fail(std::move(done.error()));
    report = std::move(*done);
    return {};
  };
  Result<Timing> timing = measure(work, bench.stopwatches);
  for (const std::filesystem::path& file : report.files_written)
    if (const std::uintmax_t bytes = std::filesystem::file_size(file, ignored); !ignored) figure.size += bytes;
  std::filesystem::remove_all(folder, ignored);
  if (!has_lift) figure.what = "the deck as it was read, flushed to disk";
  return timing;
}

/// What saving has to be compared with.
Result<Timing> measure_copy(Bench& bench, BenchFigure& figure) {
  namespace fs = std::filesystem;
  const fs::path folder = bench.input.save_folder / "copied";
  std::error_code failed;
  TimedWork work;
  work.prepare = [&] {
    fs::remove_all(folder, failed);
    fs::create_directory(folder, failed);
  };
  work.run = [&]() -> Result<void> {
    std::size_t number = 0;  // files of one name may lie in several folders
    for (const mesh::deck::SourceFile& file : bench.input.opened.deck->files) {
      const fs::path copy = folder / std::to_string(number++);
      if (!fs::copy_file(file.path, copy, failed)) return fail(file.path.string(), "can't be copied: " + failed.message());
      const ipc::Descriptor opened(::open(copy.c_str(), O_RDONLY | O_CLOEXEC));
      if (opened.get() < 0 || ::fsync(opened.get()) != 0) return fail(copy.string(), "can't be flushed to disk");
    }
    return flush_folder(folder);
  };
  for (const mesh::deck::SourceFile& file : bench.input.opened.deck->files)
    if (const std::uintmax_t bytes = fs::file_size(file.path, failed); !failed) figure.size += bytes;
  Result<Timing> timing = measure(work, bench.stopwatches);
  fs::remove_all(folder, failed);
  return timing;
}

/// What has to be there before a figure can be measured.
enum class Needs : std::uint8_t {
  deck,
  centre,        ///< of a patch: the deck has shells
  patch,         ///< one that can be lifted
  patch_if_any,  ///< the lifted deck, or the unchanged one where no patch can be lifted
};

struct FigureKind {
  std::string_view name;
  std::string_view what;
  SizeUnit unit;
  Needs needs;
  Result<Timing> (*measure)(Bench&, BenchFigure&);
};

constexpr std::array<FigureKind, 14> kFigures{{
    {"open", "read the deck, measure all shells", SizeUnit::bytes, Needs::deck, measure_open},
    {"quality", "all that check reports", SizeUnit::shells, Needs::deck, measure_quality},
    {"select_region", "a region up to its feature edges", SizeUnit::shells, Needs::centre, measure_select_region},
    {"drag_begin", "weights of the patch", SizeUnit::nodes, Needs::patch, measure_drag_begin},
    {"drag_step", "positions and quality of a preview", SizeUnit::shells, Needs::patch, measure_drag_step},
    {"slide_step", "positions and quality as the patch slides", SizeUnit::nodes, Needs::patch, measure_slide_step},
    {"lift", "the patch, as an edit", SizeUnit::nodes, Needs::patch, measure_lift},
    {"lift_beside", "the patch, named, with all nodes selected", SizeUnit::nodes, Needs::patch, measure_lift_beside},
    {"undo", "the lift", SizeUnit::nodes, Needs::patch, measure_undo},
    {"relax", "the lifted patch", SizeUnit::nodes, Needs::patch, measure_relax},
    {"relax_all", "the whole deck as it was read", SizeUnit::nodes, Needs::centre, measure_relax_all},
    {"repair", "what the lift damaged", SizeUnit::shells, Needs::patch, measure_repair},
    {"save", "the lifted deck, flushed to disk", SizeUnit::bytes, Needs::patch_if_any, measure_save},
    {"copy", "a copy of the deck's files, flushed to disk", SizeUnit::bytes, Needs::deck, measure_copy},
}};

/// The document with the patch selected, and with it lifted. Errors: cancelled.
Result<void> prepare_patch(Bench& bench) {
  const document::Document& opened = bench.input.opened;
  Result<BenchPatch> patch = find_bench_patch(opened, bench.input.patch_nodes, bench.progress);
  if (!patch) {
    bench.patch.refusal = patch.error().text();
    return {};
  }
  bench.patch = std::move(*patch);
  if (!bench.patch.selected) return {};
  bench.selected = opened;
  bench.selected.generations.push_back(bench.patch.selected);
  bench.selected.cursor = bench.selected.generations.size() - 1;
  bench.selected.next_number = bench.patch.selected->number + 1;
  document::Document lifted = bench.selected;
  if (Result<document::EditReport> done = document::apply(lifted, bench.patch.lift, bench.progress); !done)
    return fail(std::move(done.error()));
  bench.lifted = std::move(lifted);
  return {};
}

BenchFigure measure_figure(const FigureKind& kind, Bench& bench) {
  BenchFigure figure{kind.name, kind.what, {}, 0, kind.unit, {}};
  const bool no_patch = kind.needs == Needs::patch && !bench.patch.selected;
  const bool no_centre = kind.needs == Needs::centre && !bench.patch.centre.valid();
  if (no_patch || no_centre) {
    figure.note = bench.patch.refusal;
    return figure;
  }
  Result<Timing> timing = kind.measure(bench, figure);
  if (timing)
    figure.timing = *timing;
  else
    figure.note = timing.error().text();
  return figure;
}

void put_deck_facts(const document::Document& opened, BenchReport& report) {
  report.format = name(opened.deck->format);
  report.bytes = 0;
  for (const mesh::deck::SourceFile& file : opened.deck->files) report.bytes += file.bytes.bytes().size();
  report.nodes = opened.current().model.node_index->size();
  report.shells = opened.current().model.shell_index->size();
}

}  // namespace

std::vector<std::string_view> bench_figure_names() {
  std::vector<std::string_view> names;
  for (const FigureKind& kind : kFigures) names.push_back(kind.name);
  return names;
}

Result<void> measure_figures(const BenchInput& input, const Stopwatches& stopwatches, const Progress& progress, BenchReport& report) {
  put_deck_facts(input.opened, report);
  double share = 0;
  bool stopped = false;
  const Progress within = [&](double) {
    stopped = stopped || (progress && !progress(share));
    return !stopped;
  };
  Bench bench{input, stopwatches, within, {}, {}, {}};
  const auto is_wanted = [&](const FigureKind& kind) {
    return std::find(input.names.begin(), input.names.end(), kind.name) != input.names.end();
  };
  const auto uses_patch = [&](const FigureKind& kind) { return is_wanted(kind) && kind.needs != Needs::deck; };
  if (std::any_of(kFigures.begin(), kFigures.end(), uses_patch))
    if (Result<void> ready = prepare_patch(bench); !ready) return ready;
  if (bench.patch.selected) {
    report.patch_centre = input.opened.current().model.node_ids[bench.patch.centre.value];
    report.patch_nodes = bench.patch.nodes;
    report.patch_shells = bench.patch.shells;
  }
  for (const FigureKind& kind : kFigures) {
    if (!is_wanted(kind)) continue;
    report.figures.push_back(measure_figure(kind, bench));
    share = static_cast<double>(report.figures.size()) / static_cast<double>(input.names.size());
    if (!within(share)) return fail(cancelled());
  }
  return {};
}

}  // namespace prismesh::cli
