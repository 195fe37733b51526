// A snapshot's table of contents: which bytes of which segment hold each chunk, and what a view shows beside the arrays.
// Written by the publisher, read by views (docs/protocol.md has its layout).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/error.h"
#include "ipc/snapshot_info.h"

namespace prismesh::ipc {

struct TablePiece {
  std::uint64_t segment = 0;  ///< position in the snapshot's list of segments
  std::uint64_t offset = 0;   ///< bytes from the segment's start; a multiple of kPieceAlignment
  std::uint64_t version = 0;
};
inline constexpr std::size_t kPieceAlignment = 64;

struct TableArray {
  std::uint64_t count = 0;  ///< elements
  std::vector<TablePiece> pieces;
};

struct SnapshotTable {
  SnapshotInfo info;
  std::array<TableArray, kSnapshotArrayCount> arrays;
};

std::vector<std::byte> encode_table(const SnapshotTable& table);
/// Checks everything that can be checked without the segments: counts that agree with each other and with the table's size,
/// alignment. Memory used stays in proportion to the bytes given.
Result<SnapshotTable> decode_table(std::span<const std::byte> bytes);

}  // namespace prismesh::ipc
