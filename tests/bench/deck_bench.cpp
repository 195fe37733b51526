// Opening and saving a deck of a million shells: the sample's, or the one PRISMESH_BENCH_DECK names.
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include <benchmark/benchmark.h>

#include "mesh/deck/deck.h"
#include "mesh/deck/sample.h"

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

 private:
  fs::path folder_;
  fs::path deck_;
};

const Place& place() {
  static const Place place;
  return place;
}

/// From the file to the complete model with adjacency.
void open_a_million(benchmark::State& state) {
  const fs::path& path = place().deck();
  for (auto _ : state) {
    const auto opened = open(path);
    if (!opened) state.SkipWithError(opened.error().text().c_str());
    if (opened) state.counters["shells"] = static_cast<double>(opened->model.shell_count());
  }
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(fs::file_size(path)));
}
BENCHMARK(open_a_million)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

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
