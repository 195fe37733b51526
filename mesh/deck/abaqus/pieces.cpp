#include "mesh/deck/abaqus/pieces.h"

#include <algorithm>
#include <string>
#include <utility>

#include "mesh/deck/assembly/read_pieces.h"
#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::abaqus {
namespace {

/// A place to cut after about `wanted`: where a line's end is a card's end for certain. `end` if there is none soon.
std::size_t card_boundary(std::string_view text, std::size_t wanted, std::size_t end, bool elements) {
  constexpr int kMaxLines = 1000;
  constexpr std::ptrdiff_t kCommasOfFullLine = 15;  // a full line may go on without a comma at its end
  std::size_t begin = text.find('\n', wanted);
  if (begin == std::string_view::npos || ++begin >= end) return end;
  if (!elements) return begin;
  for (int line = 0; line < kMaxLines; ++line) {
    const std::size_t next = text.find('\n', begin);
    if (next == std::string_view::npos || next + 1 >= end) return end;
    const std::string_view shown = trim(text.substr(begin, next - begin));
    const bool comment = shown.substr(0, 2) == "**" || shown.empty();
    if (!comment && shown.back() != ',' && std::count(shown.begin(), shown.end(), ',') < kCommasOfFullLine) return next + 1;
    begin = next + 1;
  }
  return end;
}

std::size_t size_of(const Piece& piece) { return piece.segments.back().end - piece.segments.front().begin; }

bool can_take(const Piece& piece, const Piece& place, std::size_t begin) {
  return piece.file == place.file && piece.scope == place.scope && piece.instance == place.instance && piece.held == place.held &&
         size_of(piece) < kPieceBytes && piece.segments.back().end <= begin;
}

/// About the memory that a copy of each part takes, by scope.
std::vector<std::size_t> bytes_by_scope(const DeckOutline& outline) {
  constexpr std::size_t kBytesOfEntry = 64;
  std::vector<std::size_t> bytes(outline.scopes.size());
  for (const Piece& piece : outline.pieces)
    if (piece.instance == kNone) bytes[piece.scope] += size_of(piece) + kBytesOfEntry * piece.segments.size();
  for (const KeptBlock& kept : outline.kept) {
    const Block& block = kept.block;
    bytes[block.scope] += block.end - block.begin + kBytesOfEntry;
    for (std::uint32_t s = 0; s < block.segments; ++s) {
      const Segment& segment = outline.segments[block.first_segment + s];
      bytes[block.scope] += segment.end - segment.begin;
    }
  }
  return bytes;
}

/// Errors: as place_instances.
Result<void> check_instances(DeckOutline& outline) {
  constexpr std::size_t kMaxCopied = std::size_t{256} << 20;
  const std::vector<std::size_t> bytes = bytes_by_scope(outline);
  std::size_t copied = 0;
  for (std::size_t s = 1; s < outline.scopes.size(); ++s) {
    const Scope& scope = outline.scopes[s];
    if (scope.instances.empty()) {
      if (bytes[s] > 0)
        outline.warnings.note_each("unused-part", scope.file, scope.begin,
                                   "the part " + scope.name + " has no instance, so it isn't shown; it is kept as it is");
      continue;
    }
    const std::size_t copies = scope.instances.size() - 1;
    if (copies == 0) continue;
    const std::string has_instances = "the part " + scope.name + " has " + std::to_string(scope.instances.size()) + " instances";
    outline.warnings.note_each("repeated-part", scope.file, scope.begin, has_instances + ": each is shown, and their nodes can't be moved");
    if (bytes[s] > 0 && copies > (kMaxCopied - copied) / bytes[s])
      return fail(outline.files.files[scope.file].path.string(), line_number(outline.text(scope.file), scope.begin),
                  has_instances + "; all of them together are more than this version shows");
    copied += copies * bytes[s];
  }
  return {};
}

}  // namespace

void add_mesh(std::vector<Piece>& pieces, const Piece& place, const MeshSegment& segment, std::string_view text) {
  MeshSegment rest = segment;
  while (rest.begin < rest.end) {
    if (pieces.empty() || !can_take(pieces.back(), place, rest.begin)) pieces.push_back(place);
    Piece& piece = pieces.back();
    const std::size_t begin = piece.segments.empty() ? rest.begin : piece.segments.front().begin;
    MeshSegment part = rest;
    if (rest.end - begin > kPieceBytes + kPieceBytes / 2)
      part.end = card_boundary(text, std::max(begin + kPieceBytes, rest.begin), rest.end, !rest.nodes);
    piece.segments.push_back(part);
    rest.begin = part.end;
  }
}

Result<void> place_instances(DeckOutline& outline) {
  if (outline.instances.empty()) return {};
  if (Result<void> fine = check_instances(outline); !fine) return fine;
  std::vector<Piece> placed;
  for (Piece& piece : outline.pieces) {
    if (piece.instance != kNone || piece.scope == 0) {
      placed.push_back(std::move(piece));
      continue;
    }
    const Scope& scope = outline.scopes[piece.scope];
    for (const std::uint32_t instance : scope.instances) {
      Piece copy = piece;
      copy.instance = instance;
      copy.held |= scope.instances.size() > 1;
      placed.push_back(std::move(copy));
    }
  }
  outline.pieces = std::move(placed);
  return {};
}

}  // namespace prismesh::mesh::deck::abaqus
