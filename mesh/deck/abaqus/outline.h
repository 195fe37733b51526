// What the walk over an Abaqus deck finds: parts and instances, keywords in the order they are read, and the mesh cut into pieces.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mesh/deck/abaqus/element_type.h"
#include "mesh/deck/abaqus/keyword.h"
#include "mesh/deck/assembly/file_set.h"
#include "mesh/deck/assembly/warnings.h"
#include "mesh/deck/data/frame.h"

namespace prismesh::mesh::deck::abaqus {

inline constexpr std::uint32_t kNone = 0xffffffffu;

/// Consecutive data lines of one keyword in one file.
struct Segment {
  std::uint32_t file = 0;
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// A keyword with its data lines, which an include may interrupt.
struct Block {
  std::uint32_t file = 0;
  std::uint32_t scope = 0;         ///< the *PART it stands in; 0: none
  std::uint32_t instance = kNone;  ///< the *INSTANCE it stands in
  std::size_t begin = 0;           ///< of the keyword line
  std::size_t end = 0;             ///< of the keyword line
  std::uint32_t first_segment = 0;
  std::uint32_t segments = 0;
};

/// *PART ... *END PART, or (the first one) what stands outside of all parts. Ids and names are unique within a scope only.
struct Scope {
  std::string name;
  std::size_t begin = 0;
  std::uint32_t file = 0;
  std::vector<std::uint32_t> instances;
};

struct Instance {
  std::string name;
  std::uint32_t scope = 0;
  Eigen::Affine3d to_basic = Eigen::Affine3d::Identity();
  std::int64_t shift = 0;  ///< added to the ids of its nodes and elements, so that the model's ids are unique
};

struct MeshSegment {
  std::size_t begin = 0;
  std::size_t end = 0;
  bool nodes = false;
  std::uint32_t type = 0;   ///< elements: index into DeckOutline::types
  std::uint32_t group = 0;  ///< elements: index into DeckOutline::groups
  std::uint32_t frame = 0;  ///< nodes: index into DeckOutline::frames
};

/// Mesh text of one file that is read at a time, on any thread.
struct Piece {
  std::uint32_t file = 0;
  std::uint32_t scope = 0;
  std::uint32_t instance = kNone;
  bool held = false;  ///< its nodes stand for several places, or in a system that can't be worked out
  std::vector<MeshSegment> segments;
};

struct NamedType {
  std::string name;
  ElementType type;
};

/// Elements that *ELEMENT, ELSET= puts into one set; without ELSET=, those of a scope that are in none.
struct Group {
  std::uint32_t scope = 0;
  std::string elset;
  bool operator<(const Group& other) const { return scope != other.scope ? scope < other.scope : elset < other.elset; }
};

/// A keyword that isn't mesh.
struct KeptBlock {
  std::uint16_t word = 0;  ///< index into DeckOutline::words
  Block block;
};

/// *ELEMENT with OFFSET=.
struct OffsetElements {
  Block block;
  std::int64_t by = 0;
};

struct DeckOutline {
  explicit DeckOutline(FileSet found) : files(std::move(found)) {}

  std::string_view text(std::uint32_t file) const { return texts[file]; }
  bool is_shared(std::uint32_t file) const { return file < data_uses.size() && data_uses[file] > 1; }
  Parameters parameters(const Block& block) const { return {text(block.file), block.begin, block.end}; }

  FileSet files;
  std::vector<std::string_view> texts;   ///< by file; stay valid when the files are moved out of `files`
  std::vector<std::uint32_t> data_uses;  ///< by file: how many keywords take their data lines from it (INPUT=)
  Warnings warnings;
  std::vector<Scope> scopes{Scope()};
  std::vector<Instance> instances;
  std::map<std::string, std::uint32_t, std::less<>> instance_by_name;
  std::vector<Piece> pieces;  ///< of each instance on its own
  std::vector<NamedType> types;
  std::vector<Group> groups;
  std::vector<Frame> frames{Frame()};  ///< that *SYSTEM and *NODE, SYSTEM= give: within their scope
  std::vector<Segment> segments;
  std::map<std::string, double, std::less<>> values;  ///< *PARAMETER: those that are plain numbers
  std::vector<std::string> words;                     ///< keywords of `kept`
  std::vector<OffsetElements> offset_elements;
  std::vector<KeptBlock> kept;  ///< everything but the mesh, in the order it is read
};

}  // namespace prismesh::mesh::deck::abaqus
