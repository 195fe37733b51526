// Writes and reads a snapshot's table of contents: segment and offset of each chunk, and what a view shows besides the arrays. Layout:
// docs/protocol.md.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/error.h"
#include "ipc/model/snapshot_info.h"

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
/// Checks what can be checked without the segments: that counts agree with each other and with the table's size, and alignment. Uses memory
/// in proportion to the bytes.
Result<SnapshotTable> decode_table(std::span<const std::byte> bytes);

}  // namespace prismesh::ipc
