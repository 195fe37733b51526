// Puts arrays of pieces one after the other, in parallel. Private to assembly.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/large_memory.h"
#include "base/parallel_for.h"
#include "mesh/deck/assembly/piece_cards.h"
#include "mesh/deck/data/deck.h"

namespace prismesh::mesh::deck {

/// The index of each piece's first entry when all are put one after the other; one more entry than pieces. `count(piece)`: its entries.
template <class Count>
std::vector<std::size_t> starts_of(std::span<const PieceCards> cards, const Count& count) {
  std::vector<std::size_t> starts(cards.size() + 1);
  for (std::size_t p = 0; p < cards.size(); ++p) starts[p + 1] = starts[p] + count(cards[p]);
  return starts;
}

/// Fills an array from the pieces in parallel, a chunk at a time: `copy(piece, first, count, out)`. The chunks of a model as it is opened
/// live as long as the model, so they may share blocks of memory.
template <class T, class Copy>
ChunkedArray<T> gather(const std::vector<std::size_t>& starts, const Copy& copy) {
  ChunkedArray<T> array;
  array.reset(starts.back());
  LargePool pool;
  parallel_for(array.chunk_count(), 16, [&](std::size_t first_chunk, std::size_t last_chunk) {
    for (std::size_t c = first_chunk; c < last_chunk; ++c) {
      const std::span<T> out = array.put_chunk(c, pool.make<typename ChunkedArray<T>::Chunk>());
      const std::size_t begin = c * kChunkSize;
      auto piece = static_cast<std::size_t>(std::upper_bound(starts.begin(), starts.end(), begin) - starts.begin()) - 1;
      for (std::size_t done = 0; done < out.size(); ++piece) {
        const std::size_t first = begin + done - starts[piece];
        const std::size_t count = std::min(out.size() - done, starts[piece + 1] - starts[piece] - first);
        copy(piece, first, count, out.subspan(done, count));
        done += count;
      }
    }
  });
  return array;
}

/// `field(piece)`: the vector to copy.
template <class T, class Field>
ChunkedArray<T> gather_field(const std::vector<std::size_t>& starts, std::span<const PieceCards> cards, const Field& field) {
  return gather<T>(starts, [&](std::size_t piece, std::size_t first, std::size_t count, std::span<T> out) {
    const std::vector<T>& from = field(cards[piece]);
    std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(first), count, out.begin());
  });
}

template <class T, class Field>
std::vector<T> concatenate(const std::vector<std::size_t>& starts, std::span<const PieceCards> cards, const Field& field) {
  std::vector<T> all;
  reserve_large(all, starts.back());
  all.resize(starts.back());
  parallel_for(cards.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const std::vector<T>& from = field(cards[p]);
      std::copy(from.begin(), from.end(), all.begin() + static_cast<std::ptrdiff_t>(starts[p]));
    }
  });
  return all;
}

template <class Field>
std::shared_ptr<const IdIndex> index_of(const std::vector<std::size_t>& starts, std::span<const PieceCards> cards, const Field& ids) {
  return std::make_shared<const IdIndex>(concatenate<std::int64_t>(starts, cards, ids));
}

/// `free(piece)` for all. A large model doesn't keep what was copied; giving memory back takes time as well, so it is done in parallel.
template <class Free>
void free_each(std::span<PieceCards> cards, const Free& free) {
  parallel_for(cards.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) free(cards[p]);
  });
}

/// Keeps the entries with keep[i] set. An array of another length isn't filled and stays.
template <class T>
void keep_only(std::vector<T>& values, const std::vector<std::uint8_t>& keep) {
  if (values.size() != keep.size()) return;
  std::size_t out = 0;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (keep[i]) values[out++] = values[i];
  values.resize(out);
}

/// The index that each entry gets when only those with keep[i] set stay; one more entry than there were.
std::vector<std::uint32_t> indices_after(const std::vector<std::uint8_t>& keep);

/// `field(piece)`: the runs of nodes or of shells. A run goes on where file, style and frame stay the same; empty runs are left out.
template <class Field>
std::vector<CardRun> join_runs(const std::vector<std::size_t>& starts, std::span<const PieceCards> cards, const Field& field) {
  std::vector<CardRun> runs;
  for (std::size_t p = 0; p < cards.size(); ++p)
    for (const PieceRun& run : field(cards[p])) {
      const CardRun added{static_cast<std::uint32_t>(starts[p]) + run.first, cards[p].file, run.style, run.frame};
      if (!runs.empty() && runs.back().first == added.first) runs.pop_back();
      if (!runs.empty() && runs.back().file == added.file && runs.back().style == added.style && runs.back().frame == added.frame) continue;
      runs.push_back(added);
    }
  while (!runs.empty() && runs.back().first >= starts.back()) runs.pop_back();
  return runs;
}

}  // namespace prismesh::mesh::deck
