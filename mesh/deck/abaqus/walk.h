// The quick pass over an Abaqus deck: files, keywords in the order they are read, parts and instances; cuts what holds the mesh into
// pieces of about equal size.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/deck/abaqus/element_type.h"
#include "mesh/deck/abaqus/keyword.h"
#include "mesh/deck/assembly/file_set.h"
#include "mesh/deck/assembly/warnings.h"
#include "mesh/deck/data/frame.h"

namespace prismesh::mesh::deck::abaqus {

inline constexpr std::uint32_t kNone = 0xffffffffu;

/// A stretch of data lines of one keyword in one file.
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

/// *PART ... *END PART, or (the first one) what stands outside of all: ids and names mean nothing beyond.
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
  /// Added to the ids of its nodes and elements in the model, so that they are nobody else's.
  std::int64_t shift = 0;
};

struct MeshSegment {
  std::size_t begin = 0;
  std::size_t end = 0;
  bool nodes = false;
  std::uint32_t type = 0;   ///< elements: index into Walk::types
  std::uint32_t group = 0;  ///< elements: index into Walk::groups
  std::uint32_t frame = 0;  ///< nodes: index into Walk::frames
};

/// Mesh text of one file, read at one go.
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

/// Elements that *ELEMENT, ELSET= puts into one set; without it, those of a scope that are in none.
struct Group {
  std::uint32_t scope = 0;
  std::string elset;
  bool operator<(const Group& other) const { return scope != other.scope ? scope < other.scope : elset < other.elset; }
};

class Walk {
 public:
  explicit Walk(FileSet found);
  /// Errors: instances that would need more memory than is sensible.
  Result<void> run();

  std::string_view text(std::uint32_t file) const {
    return texts_.empty() ? std::string_view(files.files[file].bytes.text()) : texts_[file];
  }
  /// Goes on with files that were moved out of `files`.
  void keep_texts(const std::vector<SourceFile>& moved) {
    for (const SourceFile& file : moved) texts_.push_back(file.bytes.text());
  }
  Parameters parameters(const Block& block) const { return {text(block.file), block.begin, block.end}; }

  FileSet files;
  Warnings warnings;
  std::vector<Scope> scopes;
  std::vector<Instance> instances;
  std::map<std::string, std::uint32_t, std::less<>> instance_by_name;
  std::vector<Piece> pieces;  ///< of each instance on its own
  std::vector<NamedType> types;
  std::vector<Group> groups;
  std::vector<Frame> frames{Frame()};  ///< that *SYSTEM and *NODE, SYSTEM= give: within their scope
  std::vector<Segment> segments;
  std::map<std::string, double, std::less<>> values;  ///< *PARAMETER: those that are plain numbers

  /// Everything but the mesh itself, by keyword, in the order it is read.
  struct Kept {
    std::uint16_t word = 0;  ///< index into words
    Block block;
  };
  std::vector<std::string> words;
  std::vector<Kept> kept;

 private:
  void walk_file(std::uint32_t file, int depth);
  void include(std::uint32_t from, std::size_t offset, std::string_view name, int depth);
  void begin_block(std::uint32_t file, const Keyword& keyword, int depth);
  void close_segment(std::uint32_t file, std::size_t begin, std::size_t end);
  void finish_block();
  void begin_part(const Block& block);
  void begin_instance(const Block& block);
  void begin_nodes(const Block& block);
  void begin_elements(const Block& block);
  void add_mesh(const MeshSegment& segment, const Segment& where);
  void read_system();
  void read_instance_place();
  void read_values();
  std::vector<double> numbers_of_block(std::size_t most) const;
  Result<void> place_instances();
  std::uint32_t group_of(const std::string& elset);
  std::uint32_t word_of(const std::string& name);

  enum class Doing { nothing, kept, nodes, elements, system, instance, values };
  Doing doing_ = Doing::nothing;
  Block block_;
  std::string name_;
  MeshSegment mesh_;
  bool held_ = false;
  bool bad_system_ = false;
  Frame system_;  ///< of the last *SYSTEM
  std::uint32_t scope_ = 0;
  std::uint32_t instance_ = kNone;
  bool in_assembly_ = false;
  std::vector<std::string_view> texts_;
  std::vector<bool> open_;  ///< files that are being walked
  std::vector<std::uint32_t> uses_;
  std::map<std::string, std::uint32_t, std::less<>> scope_by_name_;
  std::map<std::string, std::uint32_t, std::less<>> type_by_name_;
  std::map<std::string, std::uint32_t, std::less<>> word_by_name_;
  std::map<Group, std::uint32_t> group_by_name_;
};

}  // namespace prismesh::mesh::deck::abaqus
