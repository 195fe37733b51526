// Measures publishing a generation of a million shells to the views: first everything, afterwards what changed.
#include <cstdlib>
#include <iostream>

#include <benchmark/benchmark.h>

#include "ipc/model/snapshot_publisher.h"
#include "mesh/document/prepare.h"
#include "tests/bench/million_document.h"

namespace prismesh::ipc {
namespace {

using namespace mesh::document;

[[noreturn]] void give_up(const Error& error) {
  std::cerr << error.text() << '\n';
  std::abort();
}

std::uint64_t publish(SnapshotPublisher& publisher, const Document& document) {
  Result<PublishedSnapshot> snapshot = publisher.publish(document, true);
  if (!snapshot) give_up(snapshot.error());
  return snapshot->lease;
}

void first_snapshot_of_a_million(benchmark::State& state) {
  const Document document = mesh::bench::open_million();
  for (auto _ : state) {
    SnapshotPublisher publisher;
    publisher.release(publish(publisher, document));
  }
}
BENCHMARK(first_snapshot_of_a_million)->Unit(benchmark::kMillisecond);

/// A view holds the last generation while the next is published, as in the station.
void snapshot_after_moving_10k(benchmark::State& state) {
  Document document = mesh::bench::open_million();
  const Result<EditReport> selected = mesh::document::apply(document, Edit(Select{mesh::bench::patch_expression()}));
  if (!selected) give_up(selected.error());
  SnapshotPublisher publisher;
  std::uint64_t lease = publish(publisher, document);
  Translate pull;
  pull.by = mesh::Vec3(0, 0, 1);
  std::size_t copied = 0;
  for (auto _ : state) {
    state.PauseTiming();
    if (const Result<EditReport> moved = mesh::document::apply(document, Edit(pull)); !moved) give_up(moved.error());
    const std::size_t before = publisher.bytes_copied();
    state.ResumeTiming();
    const std::uint64_t next = publish(publisher, document);
    publisher.release(lease);
    lease = next;
    copied = publisher.bytes_copied() - before;
  }
  state.counters["bytes_copied"] = static_cast<double>(copied);
}
BENCHMARK(snapshot_after_moving_10k)->Unit(benchmark::kMicrosecond)->Iterations(100);

}  // namespace
}  // namespace prismesh::ipc
