#include "ipc/model/snapshot_table.h"

#include <algorithm>
#include <string>

#include "ipc/wire/byte_stream.h"

namespace prismesh::ipc {

namespace {

constexpr std::uint64_t kSnapshotMagic = 0x3554'534d'5350'5250;  // "PRPSMST5"
// Indices into the arrays are 32 bits wide, and the last value means none.
constexpr std::uint64_t kMaxElements = 2 * std::uint64_t{0xffff'fffe};

tl::unexpected<Error> damaged(const std::string& what) { return fail("snapshot", "its table of contents is damaged: " + what); }

void put_info(ByteWriter& out, const SnapshotInfo& info) {
  out.put(info.generation);
  out.put(info.document);
  out.put(info.length_unit);
  out.put(info.target_size);
  out.put(info.criteria);
  for (const std::size_t number : {info.counts.ok, info.counts.warn, info.counts.fail}) out.put(std::uint64_t{number});
  out.put(info.nodes);
  out.put(info.selected_nodes);
  out.put(info.selected_shells);
  for (const bool flag : {info.can_undo, info.can_redo, info.changed}) out.put(static_cast<std::uint8_t>(flag));
  out.put(std::uint64_t{info.parts.size()});
  for (const SnapshotPart& part : info.parts) {
    out.put(part.id);
    out.put(part.name);
    out.put(static_cast<std::uint8_t>(part.hidden));
    out.put(static_cast<std::uint8_t>(part.locked));
    out.put(part.shells);
    out.put(part.target_size);
    out.put(static_cast<std::uint8_t>(part.size_from));
    out.put(part.criteria);
    out.put(part.thinnest);
    out.put(part.thickest);
  }
}

SnapshotInfo get_info(ByteReader& in) {
  SnapshotInfo info;
  info.generation = in.get<std::uint64_t>();
  info.document = in.text();
  info.length_unit = in.text();
  info.target_size = in.get<double>();
  info.criteria = in.text();
  info.counts.ok = in.get<std::uint64_t>();
  info.counts.warn = in.get<std::uint64_t>();
  info.counts.fail = in.get<std::uint64_t>();
  info.nodes = in.get<std::uint64_t>();
  info.selected_nodes = in.get<std::uint64_t>();
  info.selected_shells = in.get<std::uint64_t>();
  info.can_undo = in.get<std::uint8_t>() != 0;
  info.can_redo = in.get<std::uint8_t>() != 0;
  info.changed = in.get<std::uint8_t>() != 0;
  // A part takes 47 bytes at least: id, length of the name, two flags, number of shells, target size and where it comes from, length of the
  // criteria, thicknesses.
  const auto parts = in.get<std::uint64_t>();
  for (std::uint64_t i = 0; in.holds(parts - i, 47) && i < parts; ++i) {
    SnapshotPart part;
    part.id = in.get<std::int64_t>();
    part.name = in.text();
    part.hidden = in.get<std::uint8_t>() != 0;
    part.locked = in.get<std::uint8_t>() != 0;
    part.shells = in.get<std::uint32_t>();
    part.target_size = in.get<double>();
    part.size_from = static_cast<mesh::quality::SizeFrom>(std::min<std::uint8_t>(in.get<std::uint8_t>(), 2));
    part.criteria = in.text();
    part.thinnest = in.get<float>();
    part.thickest = in.get<float>();
    info.parts.push_back(std::move(part));
  }
  return info;
}

Result<TableArray> get_array(ByteReader& in, SnapshotArray array) {
  TableArray result;
  result.count = in.get<std::uint64_t>();
  const auto size = in.get<std::uint64_t>();
  const auto pieces = in.get<std::uint64_t>();
  if (!in.ok()) return damaged("it ends early");
  if (size != element_size(array)) return damaged("elements of " + std::to_string(size) + " bytes");
  if (result.count > kMaxElements || pieces != (result.count + mesh::kChunkSize - 1) / mesh::kChunkSize)
    return damaged(std::to_string(pieces) + " chunks for " + std::to_string(result.count) + " elements");
  if (!in.holds(pieces, sizeof(TablePiece))) return damaged("it ends early");
  result.pieces.reserve(static_cast<std::size_t>(pieces));
  for (std::uint64_t i = 0; i < pieces; ++i) {
    const auto piece = in.get<TablePiece>();
    if (piece.offset % kPieceAlignment != 0) return damaged("a chunk lies askew");
    result.pieces.push_back(piece);
  }
  return result;
}

/// Arrays by node must have the same count, and so must those by shell and those by line.
bool counts_agree(const SnapshotTable& table) {
  const auto count = [&](SnapshotArray array) { return table.arrays[static_cast<std::size_t>(array)].count; };
  for (const SnapshotArray array : {SnapshotArray::node_ids, SnapshotArray::node_marks})
    if (count(array) != count(SnapshotArray::positions)) return false;
  for (const SnapshotArray array : {SnapshotArray::shell_ids, SnapshotArray::shell_parts, SnapshotArray::shell_marks,
                                    SnapshotArray::shell_quality, SnapshotArray::shell_damage})
    if (count(array) != count(SnapshotArray::shell_nodes)) return false;
  return count(SnapshotArray::line_nodes) == 2 * count(SnapshotArray::line_parts);
}

}  // namespace

std::size_t element_size(SnapshotArray array) {
  switch (array) {
    case SnapshotArray::positions: return sizeof(mesh::Vec3);
    case SnapshotArray::node_ids:
    case SnapshotArray::shell_ids: return sizeof(std::int64_t);
    case SnapshotArray::node_marks:
    case SnapshotArray::shell_marks: return sizeof(std::uint8_t);
    case SnapshotArray::shell_nodes: return sizeof(mesh::ShellNodes);
    case SnapshotArray::shell_parts:
    case SnapshotArray::line_parts: return sizeof(mesh::PartIndex);
    case SnapshotArray::shell_quality:
    case SnapshotArray::shell_damage: return sizeof(mesh::quality::ShellState);
    case SnapshotArray::line_nodes: return sizeof(mesh::NodeIndex);
    case SnapshotArray::clusters: return sizeof(SnapshotCluster);
  }
  return 1;
}

std::vector<std::byte> encode_table(const SnapshotTable& table) {
  ByteWriter out;
  out.put(kSnapshotMagic);
  for (int i = 0; i < kSnapshotArrayCount; ++i) {
    const TableArray& array = table.arrays[static_cast<std::size_t>(i)];
    out.put(array.count);
    out.put(std::uint64_t{element_size(static_cast<SnapshotArray>(i))});
    out.put(std::uint64_t{array.pieces.size()});
    for (const TablePiece& piece : array.pieces) out.put(piece);
  }
  put_info(out, table.info);
  return out.bytes();
}

Result<SnapshotTable> decode_table(std::span<const std::byte> bytes) {
  ByteReader in(bytes);
  if (in.get<std::uint64_t>() != kSnapshotMagic) return damaged("it doesn't begin as one");
  SnapshotTable table;
  for (int i = 0; i < kSnapshotArrayCount; ++i) {
    Result<TableArray> array = get_array(in, static_cast<SnapshotArray>(i));
    if (!array) return fail(std::move(array.error()));
    table.arrays[static_cast<std::size_t>(i)] = std::move(*array);
  }
  table.info = get_info(in);
  if (!in.ok() || !in.at_end()) return damaged("its length is wrong");
  if (!counts_agree(table)) return damaged("its arrays differ in length");
  return table;
}

}  // namespace prismesh::ipc
