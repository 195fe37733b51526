// A snapshot's table and a preview from a hostile daemon: refused, or every chunk can be read.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <vector>

#include "ipc/model/preview.h"
#include "ipc/model/snapshot.h"
#include "ipc/model/snapshot_table.h"

namespace {

using namespace prismesh::ipc;

void look_through(const SnapshotView& view) {
  unsigned sum = 0;
  for (int a = 0; a < kSnapshotArrayCount; ++a)
    for (std::size_t c = 0; c < view.chunk_count(static_cast<SnapshotArray>(a)); ++c)
      for (const std::byte byte : view.chunk_bytes(static_cast<SnapshotArray>(a), c)) sum += static_cast<unsigned>(byte);
  if (sum != 0) std::abort();  // the segment is all zero
}

void look_through(const PreviewReader& preview) {
  std::uint64_t sum = preview.drag();
  for (const auto node : preview.nodes()) sum += node.value;
  for (const auto shell : preview.shells()) sum += shell.value;
  PreviewFrame frame;
  if (preview.latest(frame) && (frame.positions.size() != preview.nodes().size() || frame.states.size() != preview.shells().size()))
    std::abort();
  // The sum keeps the reads from being left out.
  if (sum == 0x5EED'0000'0000'0001) std::fputs("a rare sum\n", stderr);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const auto segment =
      std::make_shared<const Mapping>(std::move(Mapping::map(make_shared_memory("fuzz", 8192).value(), false).value()));
  if (size == 0) return 0;
  const auto memory = make_sealed_memory("fuzz", std::as_bytes(std::span(data, size)));
  if (!memory) return 0;
  if (const auto view = SnapshotView::map(*memory, std::vector{segment})) look_through(**view);
  if (const auto preview = PreviewReader::map(*memory)) look_through(*preview);
  // A sound table survives a round trip.
  if (const auto table = decode_table(std::as_bytes(std::span(data, size))))
    if (!decode_table(encode_table(*table))) std::abort();
  return 0;
}
