// The store of models: uploading and publishing a file, beside writing, flushing and hashing the same bytes.
#include <stdlib.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <string>

#include <benchmark/benchmark.h>

#include "daemon/intake/store/store.h"
#include "ipc/store/folder.h"

namespace prismesh::intake {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPiece = std::size_t{32} << 10;  // as the connections hand it over

/// In the current folder: /tmp may be memory.
class Place {
 public:
  Place() {
    std::string name = (fs::current_path() / "intake_bench_XXXXXX").string();
    path_ = ::mkdtemp(name.data());
  }
  ~Place() { fs::remove_all(path_); }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// Others each time, so that nothing is there already.
std::string bytes_of(std::int64_t megabytes, std::uint64_t run) {
  std::string bytes(static_cast<std::size_t>(megabytes) << 20, 'x');
  for (std::size_t i = 0; i < bytes.size(); i += 512) bytes.replace(i, sizeof run, reinterpret_cast<const char*>(&run), sizeof run);
  return bytes;
}

void write_flush_and_hash(benchmark::State& state) {
  const Place place;
  const auto folder = ipc::store::Folder::open(place.path());
  std::uint64_t run = 0;
  for (auto _ : state) {
    state.PauseTiming();
    const std::string bytes = bytes_of(state.range(0), ++run);
    state.ResumeTiming();
    ipc::store::Sha256 hash;
    const auto file = folder->create(std::to_string(run));
    for (std::size_t at = 0; at < bytes.size(); at += kPiece) {
      const std::string_view piece = std::string_view(bytes).substr(at, kPiece);
      (void)ipc::store::write_at(*file, piece, at, place.path());
      hash.add(piece);
    }
    (void)ipc::store::flush_file(*file, place.path());
    benchmark::DoNotOptimize(hash.hash());
  }
  state.SetBytesProcessed(state.iterations() * (state.range(0) << 20));
}

void upload_and_publish(benchmark::State& state) {
  const Place place;
  MonotonicClock clock;
  std::vector<std::string> notes;
  std::uint64_t names = 0;
  StoreLimits limits;
  limits.quota_bytes = std::uint64_t{1} << 50;
  limits.reserved_bytes = 0;
  Result<Store> store = Store::open(
      place.path() / "store", limits, clock,
      [&](std::span<std::byte> bytes) { std::memcpy(bytes.data(), &++names, std::min(bytes.size(), sizeof names)); }, notes);
  std::uint64_t run = 0;
  for (auto _ : state) {
    state.PauseTiming();
    const std::string bytes = bytes_of(state.range(0), ++run);
    const ipc::store::Manifest manifest{"a.k", {{ipc::store::sha256(bytes), bytes.size(), "a.k"}}};
    state.ResumeTiming();
    const auto begun = store->begin_upload({"ann", bytes.size(), "", std::nullopt});
    const auto chunk = store->uploads().begin_chunk("ann", begun->id, 0, std::nullopt);
    for (std::size_t at = 0; at < bytes.size(); at += kPiece)
      if (!store->uploads().add(begun->id, *chunk, std::string_view(bytes).substr(at, kPiece))) return state.SkipWithError("not taken");
    if (!store->uploads().end_chunk(begun->id, *chunk)) return state.SkipWithError("not complete");
    if (!store->publish({"ann", ipc::store::encode_manifest(manifest), "", std::nullopt, false, 0}))
      return state.SkipWithError("not published");
  }
  state.SetBytesProcessed(state.iterations() * (state.range(0) << 20));
}

BENCHMARK(write_flush_and_hash)->Arg(64)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(upload_and_publish)->Arg(64)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace prismesh::intake
