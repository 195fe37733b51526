// Measures opening and saving a deck of a million shells: the sample's, or the one PRISMESH_BENCH_DECK names; and its twins in the other
// formats, which PRISMESH_BENCH_TWINS keeps in the folder it names. With PRISMESH_BENCH_LARGE also the sample of two and of five million
// shells.
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <string>

#include <benchmark/benchmark.h>

#include "base/file.h"
#include "mesh/deck/assembly/read_pieces.h"
#include "mesh/deck/data/deck.h"
#include "mesh/deck/open.h"
#include "mesh/deck/sample.h"
#include "mesh/deck/save.h"
#include "tests/bench/deck_twins.h"

namespace prismesh::mesh::deck {
namespace {

namespace fs = std::filesystem;

/// The deck's path and a folder to save into, removed at the end.
class Place {
 public:
  Place() {
    std::string name = (fs::temp_directory_path() / "prismesh-bench-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
    if (const char* named = std::getenv("PRISMESH_BENCH_DECK"))
      deck_ = named;
    else if (write_sample(folder_ / "million.k", 1000000))
      deck_ = folder_ / "million.k";
  }
  Place(const Place&) = delete;
  Place& operator=(const Place&) = delete;
  ~Place() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  const fs::path& deck() const { return deck_; }
  fs::path out() const { return folder_ / "out" / "deck.k"; }
  const fs::path& folder() const { return folder_; }

 private:
  fs::path folder_;
  fs::path deck_;
};

const Place& place() {
  static const Place place;
  return place;
}

/// Wall clock and the processor time of all threads, in milliseconds.
struct Moment {
  double wall = 0;
  double cpu = 0;
  static Moment now() {
    std::timespec cpu{};
    ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &cpu);
    const auto wall = std::chrono::steady_clock::now().time_since_epoch();
    return {std::chrono::duration<double, std::milli>(wall).count(),
            static_cast<double>(cpu.tv_sec) * 1e3 + static_cast<double>(cpu.tv_nsec) * 1e-6};
  }
};

/// Peak memory of this process, in MB.
double peak_mb() {
  struct rusage usage {};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024e-6;
}

/// Sums up the time from the start of opening to the end of each phase.
class Phases {
 public:
  Phases() : start_(Moment::now()) {}
  Progress progress() {
    return [this](double fraction) {
      if (fraction >= kWalked) reached(walked_);
      if (fraction >= kRead) reached(read_);
      if (fraction >= kAssembled) reached(entities_);
      return true;
    };
  }
  void add_to(Moment (&sums)[4]) {
    Moment end;
    reached(end);
    for (const auto& [sum, moment] : {std::pair(&sums[0], walked_), {&sums[1], read_}, {&sums[2], entities_}, {&sums[3], end}}) {
      sum->wall += moment.wall;
      sum->cpu += moment.cpu;
    }
  }

 private:
  void reached(Moment& moment) const {
    if (moment.wall > 0) return;
    const Moment now = Moment::now();
    moment = {now.wall - start_.wall, now.cpu - start_.cpu};
  }
  Moment start_, walked_, read_, entities_;
};

/// From the file to the complete model with adjacency. The counters are milliseconds from the start of opening, of wall clock and of
/// processor time: to the end of the walk, of reading the cards, to all entities in the model, to the model with adjacency.
void open_measured(benchmark::State& state, const fs::path& path) {
  Moment sums[4];
  double shells = 0;
  for (auto _ : state) {
    Phases phases;
    const auto opened = open(path, phases.progress());
    phases.add_to(sums);
    if (!opened) state.SkipWithError(opened.error().text().c_str());
    if (opened) shells = static_cast<double>(opened->model.shell_count());
  }
  state.counters["shells"] = shells;
  if (sums[3].cpu > 0) state.counters["shells_per_cpu_s"] = shells * static_cast<double>(state.iterations()) * 1e3 / sums[3].cpu;
  state.counters["peak_MB"] = peak_mb();
  const char* names[] = {"1walked", "2read", "3entities", "4complete"};
  for (int i = 0; i < 4; ++i) {
    state.counters[names[i]] = benchmark::Counter(sums[i].wall, benchmark::Counter::kAvgIterations);
    state.counters[std::string(names[i]) + "_cpu"] = benchmark::Counter(sums[i].cpu, benchmark::Counter::kAvgIterations);
  }
  std::error_code ignored;
  if (const auto size = fs::file_size(path, ignored); !ignored)
    state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(size));
}

void open_a_million(benchmark::State& state) { open_measured(state, place().deck()); }
BENCHMARK(open_a_million)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

/// The same mesh in another format. Errors: as those of opening the deck and of writing the twin; the format can't hold the model's ids.
Result<fs::path> write_twin(const char* name, std::string (*text_of)(const Model&)) {
  const Result<OpenedDeck> opened = open(place().deck());
  if (!opened) return fail(opened.error());
  const char* kept = std::getenv("PRISMESH_BENCH_TWINS");
  const fs::path twin = (kept != nullptr ? fs::path(kept) : place().folder()) / name;
  const std::string text = text_of(opened->model);
  if (text.empty()) return fail(twin.string(), "can't be written: an id has more digits than the format takes");
  const PendingFile file{twin, {text}};
  if (const Result<void> written = replace_files({&file, 1}); !written) return fail(written.error());
  return twin;
}

void open_a_twin(benchmark::State& state, const char* name, std::string (*text_of)(const Model&)) {
  if (const Result<fs::path> twin = write_twin(name, text_of))
    open_measured(state, *twin);
  else
    state.SkipWithError(twin.error().text().c_str());
}
BENCHMARK_CAPTURE(open_a_twin, nastran, "twin.bdf", bench::nastran_twin_text)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK_CAPTURE(open_a_twin, radioss, "twin_0000.rad", bench::radioss_twin_text)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK_CAPTURE(open_a_twin, abaqus, "twin.inp", bench::abaqus_twin_text)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

/// Checks that opening is linear: the counter shells_per_cpu_s should hardly decrease with the size.
void open_millions(benchmark::State& state) {
  const fs::path deck = place().folder() / "millions.k";
  if (const Result<void> written = write_sample(deck, static_cast<std::size_t>(state.range(0))); !written)
    state.SkipWithError(written.error().text().c_str());
  else
    open_measured(state, deck);
  std::error_code ignored;
  fs::remove(deck, ignored);
}
[[maybe_unused]] const bool kLarge = [] {
  if (std::getenv("PRISMESH_BENCH_LARGE") == nullptr) return false;
  benchmark::RegisterBenchmark("open_millions", open_millions)
      ->Arg(1'000'000)
      ->Arg(2'000'000)
      ->Arg(5'000'000)
      ->Unit(benchmark::kMillisecond)
      ->MeasureProcessCPUTime()
      ->UseRealTime();
  return true;
}();

/// Saving into another folder after `range(0)` nodes have moved; the disk's flush is part of it.
void save_a_million(benchmark::State& state) {
  const auto opened = open(place().deck());
  if (!opened) {
    state.SkipWithError(opened.error().text().c_str());
    return;
  }
  Model moved = opened->model;
  for (std::size_t i = 0; i < std::min(static_cast<std::size_t>(state.range(0)), moved.node_count()); ++i)
    moved.positions.set(i, moved.positions[i] + Vec3(0.1, 1.0 / 3, 0));
  for (auto _ : state)
    if (const auto saved = save(*opened->deck, opened->model, moved, place().out()); !saved)
      state.SkipWithError(saved.error().text().c_str());
}
BENCHMARK(save_a_million)->Arg(0)->Arg(10000)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

}  // namespace
}  // namespace prismesh::mesh::deck
