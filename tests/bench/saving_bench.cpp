// Measures a save in place as modeld makes it, of the sample of a million shells after 10,000 nodes moved: staged, journalled and put in
// place, with the disk's flushes. Beside it, copying the same file and flushing it.
#include <fcntl.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include <benchmark/benchmark.h>

#include "base/file.h"
#include "daemon/modeld/document_keeper.h"
#include "mesh/deck/sample.h"
#include "mesh/document/edit_json.h"

namespace prismesh::modeld {
namespace {

namespace fs = std::filesystem;

class SavingPlace {
 public:
  SavingPlace() {
    std::string name = (fs::temp_directory_path() / "prismesh-saving-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
    fs::create_directory(folder_ / "state");
    fs::permissions(folder_ / "state", fs::perms::owner_all);
  }
  SavingPlace(const SavingPlace&) = delete;
  SavingPlace& operator=(const SavingPlace&) = delete;
  ~SavingPlace() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  fs::path deck() const { return folder_ / "million.k"; }
  fs::path copy() const { return folder_ / "copy.k"; }
  fs::path state() const { return folder_ / "state"; }

 private:
  fs::path folder_;
};

void save_in_place(benchmark::State& state) {
  const SavingPlace place;
  if (!mesh::deck::write_sample(place.deck(), 1'000'000)) return state.SkipWithError("the sample can't be written");
  DocumentKeeper keeper{StateFolder(place.state())};
  ipc::Open request;
  request.path = place.deck().string();
  if (const auto opened = keeper.open(request, {}); !opened) return state.SkipWithError(opened.error().text().c_str());
  const mesh::document::Edit edit =
      mesh::document::parse_edit(R"({"edit":"translate","on":"5000001-5010000","by":[0,0,0.5],"falloff":{"profile":"constant"}})").value();
  for (auto _ : state) {
    state.PauseTiming();
    if (const auto edited = keeper.edit(edit); !edited) return state.SkipWithError(edited.error().text().c_str());
    state.ResumeTiming();
    if (const auto saved = keeper.save(std::nullopt); !saved) return state.SkipWithError(saved.error().text().c_str());
  }
}
BENCHMARK(save_in_place)->Iterations(7)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

void copy_and_flush(benchmark::State& state) {
  const SavingPlace place;
  if (!mesh::deck::write_sample(place.deck(), 1'000'000)) return state.SkipWithError("the sample can't be written");
  for (auto _ : state) {
    fs::remove(place.copy());
    fs::copy_file(place.deck(), place.copy());
    const int file = ::open(place.copy().c_str(), O_RDONLY | O_CLOEXEC);
    if (::fsync(file) != 0) state.SkipWithError("the copy can't be flushed");
    ::close(file);
  }
}
BENCHMARK(copy_and_flush)->Iterations(7)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

}  // namespace
}  // namespace prismesh::modeld
