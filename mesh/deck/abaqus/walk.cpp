#include "mesh/deck/abaqus/walk.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "mesh/deck/assembly/read_pieces.h"
#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::abaqus {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxWords = 60000;
constexpr std::string_view kOtherWord = "(another keyword)";

Frame::Kind kind_of(std::string_view system) {
  const std::string name = label(system);
  if (name == "C") return Frame::Kind::cylindrical;
  return name == "S" ? Frame::Kind::spherical : Frame::Kind::rectangular;
}

bool same_frame(const Frame& a, const Frame& b) { return a.kind == b.kind && a.to_basic.matrix() == b.to_basic.matrix(); }

/// The system of *SYSTEM: its origin, a point on its x axis, a point in its xy plane. nullopt: they don't span one.
std::optional<Eigen::Affine3d> system_of(const std::vector<double>& p) {
  Eigen::Affine3d out = Eigen::Affine3d::Identity();
  if (p.size() >= 3) out.translation() = Eigen::Vector3d(p[0], p[1], p[2]);
  if (p.size() < 6) return out;
  const Eigen::Vector3d x = Eigen::Vector3d(p[3], p[4], p[5]) - out.translation();
  // Without a third point the system is turned about the global z axis.
  const Eigen::Vector3d in_plane = p.size() >= 9 ? Eigen::Vector3d(Eigen::Vector3d(p[6], p[7], p[8]) - out.translation())
                                                 : Eigen::Vector3d(Eigen::Vector3d::UnitZ().cross(x));
  const Eigen::Vector3d z = x.cross(in_plane);
  if (!(x.norm() > 0) || !(z.norm() > 1e-12 * x.norm() * in_plane.norm())) return std::nullopt;
  out.linear().col(0) = x.normalized();
  out.linear().col(2) = z.normalized();
  out.linear().col(1) = z.normalized().cross(x.normalized());
  if (!out.matrix().allFinite()) return std::nullopt;
  return out;
}

}  // namespace

Walk::Walk(FileSet found) : files(std::move(found)), scopes(1) {}

Result<void> Walk::run() {
  walk_file(0, 0);
  finish_block();
  return place_instances();
}

void Walk::walk_file(std::uint32_t file, int depth) {
  open_.resize(files.files.size());
  open_[file] = true;
  Keywords keywords(text(file));
  Keyword keyword;
  std::size_t data = 0;
  while (keywords.next(keyword)) {
    close_segment(file, data, keyword.begin);
    data = keyword.end;
    if (keyword.name != "INCLUDE") {
      begin_block(file, keyword, depth);
      continue;
    }
    const Parameters parameters(text(file), keyword.begin, keyword.end);
    if (const auto input = parameters.value("INPUT"))
      include(file, keyword.begin, *input, depth);
    else
      warnings.note("missing-include", file, keyword.begin, "*INCLUDE lacks its INPUT=, which names the file");
  }
  close_segment(file, data, text(file).size());
  open_[file] = false;
}

void Walk::include(std::uint32_t from, std::size_t offset, std::string_view name, int depth) {
  std::string reason;
  const std::string shown(name);
  // Abaqus looks in the folder it was started in, which is the main file's.
  const fs::path folders[] = {files.folder_of(0), files.folder_of(from)};
  const std::uint32_t file = files.include(from, shown, folders, reason);
  open_.resize(files.files.size());
  uses_.resize(files.files.size());
  if (file == FileSet::kNoFile)
    warnings.note_each("missing-include", from, offset, "the include file " + shown + " " + reason);
  else if (open_[file])
    warnings.note("circular-include", from, offset, "the include file " + shown + " includes itself; it is read once");
  else if (depth >= kMaxIncludeDepth)
    warnings.note("deep-include", from, offset,
                  "the include file " + shown + " is nested more than " + std::to_string(kMaxIncludeDepth) + " deep; it isn't read");
  else if (uses_[file]++ > 0)
    warnings.note("repeated-include", from, offset, "the include file " + shown + " is included again; it is read once");
  else
    walk_file(file, depth + 1);
}

std::uint32_t Walk::word_of(const std::string& name) {
  const auto at = word_by_name_.find(name);
  if (at != word_by_name_.end()) return at->second;
  if (words.size() >= kMaxWords) return word_of(std::string(kOtherWord));
  words.push_back(name);
  return word_by_name_[name] = static_cast<std::uint32_t>(words.size() - 1);
}

void Walk::begin_block(std::uint32_t file, const Keyword& keyword, int depth) {
  finish_block();
  if (words.empty()) word_of(std::string(kOtherWord));
  name_ = keyword.name;
  block_ = {file, scope_, instance_, keyword.begin, keyword.end, static_cast<std::uint32_t>(segments.size()), 0};
  doing_ = Doing::kept;
  if (name_ == "NODE") {
    begin_nodes(block_);
  } else if (name_ == "ELEMENT") {
    begin_elements(block_);
  } else if (name_ == "SYSTEM") {
    doing_ = Doing::system;
  } else if (name_ == "PARAMETER") {
    doing_ = Doing::values;
  } else if (name_ == "PART") {
    begin_part(block_);
  } else if (name_ == "END PART") {
    scope_ = 0;
    system_ = {};
  } else if (name_ == "INSTANCE") {
    begin_instance(block_);
  } else if (name_ == "END INSTANCE") {
    instance_ = kNone;
    scope_ = 0;
  }
  // Data lines may come from another file.
  if (doing_ == Doing::nodes || doing_ == Doing::elements || name_ == "NSET" || name_ == "ELSET")
    if (const auto input = parameters(block_).value("INPUT")) include(file, keyword.begin, *input, depth);
}

void Walk::close_segment(std::uint32_t file, std::size_t begin, std::size_t end) {
  if (begin >= end || doing_ == Doing::nothing) return;
  const Segment where{file, begin, end};
  if (doing_ == Doing::nodes || doing_ == Doing::elements) {
    add_mesh(mesh_, where);
    return;
  }
  segments.push_back(where);
  ++block_.segments;
}

void Walk::finish_block() {
  const Doing did = std::exchange(doing_, Doing::nothing);
  if (did == Doing::system) read_system();
  if (did == Doing::instance) read_instance_place();
  if (did == Doing::values) read_values();
  if (did == Doing::system || did == Doing::instance || did == Doing::values) segments.resize(block_.first_segment);
  if (did == Doing::kept) kept.push_back({static_cast<std::uint16_t>(word_of(name_)), block_});
}

void Walk::begin_part(const Block& block) {
  doing_ = Doing::nothing;
  scope_ = static_cast<std::uint32_t>(scopes.size());
  system_ = {};
  bad_system_ = false;
  const std::string name = label(parameters(block).value("NAME").value_or(""));
  if (!scope_by_name_.try_emplace(name, scope_).second)
    warnings.note("duplicate-part", block.file, block.begin, "the part " + name + " is defined again; its first definition counts");
  scopes.push_back({name, block.begin, block.file, {}});
}

void Walk::begin_instance(const Block& block) {
  doing_ = Doing::instance;
  const Parameters given = parameters(block);
  const std::string name = label(given.value("NAME").value_or(""));
  const auto part = given.value("PART");
  const auto at = part ? scope_by_name_.find(label(*part)) : scope_by_name_.end();
  if (at == scope_by_name_.end()) {
    warnings.note_each("unread-instance", block.file, block.begin,
                       "the instance " + name + " is of no part of this deck, so it isn't shown; it is kept as it is");
    // What it holds itself has ids of its own.
    scope_ = static_cast<std::uint32_t>(scopes.size());
    scopes.push_back({name, block.begin, block.file, {}});
  } else {
    scope_ = at->second;
  }
  instance_ = static_cast<std::uint32_t>(instances.size());
  instances.push_back({name, scope_, Eigen::Affine3d::Identity(), 0});
  instance_by_name.try_emplace(name, instance_);
  scopes[scope_].instances.push_back(instance_);
  block_.instance = instance_;
}

std::uint32_t Walk::group_of(const std::string& elset) {
  const auto [at, added] = group_by_name_.try_emplace(Group{scope_, elset}, static_cast<std::uint32_t>(groups.size()));
  if (added) groups.push_back(at->first);
  return at->second;
}

void Walk::begin_nodes(const Block& block) {
  doing_ = Doing::nodes;
  mesh_ = {};
  mesh_.nodes = true;
  held_ = bad_system_;
  Frame frame = system_;
  const Parameters given = parameters(block);
  if (const auto system = given.value("SYSTEM")) frame.kind = kind_of(*system);
  if (!same_frame(frames.back(), frame)) frames.push_back(frame.is_basic() ? Frame() : frame);
  mesh_.frame = frame.is_basic() ? 0 : static_cast<std::uint32_t>(frames.size() - 1);
}

void Walk::begin_elements(const Block& block) {
  const Parameters given = parameters(block);
  const auto named = given.value("TYPE");
  if (!named || named->empty()) {
    doing_ = Doing::nothing;
    warnings.note("unread-elements", block.file, block.begin, "*ELEMENT lacks its TYPE=, so what follows isn't shown; it is kept as it is");
    return;
  }
  doing_ = Doing::elements;
  mesh_ = {};
  held_ = false;
  const std::string type = label(named->substr(0, 80));
  const auto [at, added] = type_by_name_.try_emplace(type, static_cast<std::uint32_t>(types.size()));
  if (added) types.push_back({type, element_type(type)});
  mesh_.type = at->second;
  mesh_.group = group_of(label(given.value("ELSET").value_or("")));
  const ElementType& known = types[mesh_.type].type;
  if (known.element_class == ElementClass::shell && !known.is_shell_section)
    warnings.note("shown-as-shells", block.file, block.begin,
                  "elements of type " + type + " (membranes, surfaces or rigid facets) are shown as shells");
}

namespace {

/// A place to cut after about `wanted`: where a line's end is a card's end for certain. `end` if there is none soon.
std::size_t card_boundary(std::string_view text, std::size_t wanted, std::size_t end, bool elements) {
  constexpr int kMaxLines = 1000;
  constexpr std::ptrdiff_t kCommasOfFullLine = 15;  // commas of a line that is full, so that it may go on without a comma at its end
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

}  // namespace

void Walk::add_mesh(const MeshSegment& segment, const Segment& where) {
  const std::string_view all = text(where.file);
  MeshSegment rest = segment;
  rest.begin = where.begin;
  rest.end = where.end;
  while (rest.begin < rest.end) {
    const auto fits = [&](const Piece& piece) {
      return piece.file == where.file && piece.scope == scope_ && piece.instance == instance_ && piece.held == held_ &&
             piece.segments.back().end - piece.segments.front().begin < kPieceBytes && piece.segments.back().end <= rest.begin;
    };
    if (pieces.empty() || !fits(pieces.back())) pieces.push_back({where.file, scope_, instance_, held_, {}});
    Piece& piece = pieces.back();
    const std::size_t begin = piece.segments.empty() ? rest.begin : piece.segments.front().begin;
    MeshSegment part = rest;
    if (rest.end - begin > kPieceBytes + kPieceBytes / 2)
      part.end = card_boundary(all, std::max(begin + kPieceBytes, rest.begin), rest.end, !rest.nodes);
    piece.segments.push_back(part);
    rest.begin = part.end;
  }
}

/// Numbers of the first data lines, three to a point.
std::vector<double> Walk::numbers_of_block(std::size_t most) const {
  std::vector<double> out;
  for (std::uint32_t s = 0; s < block_.segments; ++s) {
    const Segment& where = segments[block_.first_segment + s];
    DataLines lines(text(where.file), where.begin, where.end);
    DataLine line;
    while (out.size() < most && lines.next(line)) {
      Fields fields(line.text);
      std::string_view field;
      for (double value = 0; out.size() < most && fields.next(field);) {
        if (!parse_real(field, value)) value = std::numeric_limits<double>::quiet_NaN();
        out.push_back(value);
      }
      while (out.size() % 3 != 0) out.push_back(0);
    }
  }
  return out;
}

void Walk::read_system() {
  const std::optional<Eigen::Affine3d> system = system_of(numbers_of_block(9));
  bad_system_ = !system || !system->matrix().allFinite();
  system_ = {};
  if (!bad_system_)
    system_.to_basic = *system;
  else
    warnings.note("unread-system", block_.file, block_.begin,
                  "the points of this *SYSTEM span no coordinate system; nodes in it are shown as if it weren't there, and can't be moved");
}

void Walk::read_instance_place() {
  Instance& instance = instances[block_.instance];
  const std::vector<double> p = numbers_of_block(10);
  Eigen::Affine3d place = Eigen::Affine3d::Identity();
  if (p.size() >= 3) place.translation() = Eigen::Vector3d(p[0], p[1], p[2]);
  bool turns_about_nothing = false;
  if (p.size() >= 10) {
    const Eigen::Vector3d a(p[3], p[4], p[5]);
    const Eigen::Vector3d axis = Eigen::Vector3d(p[6], p[7], p[8]) - a;
    turns_about_nothing = p[9] != 0 && !(axis.squaredNorm() > 0);
    place = Eigen::Translation3d(a) * Eigen::AngleAxisd(p[9] * M_PI / 180, axis.normalized()) * Eigen::Translation3d(-a) * place;
  }
  if (!turns_about_nothing && place.matrix().allFinite())
    instance.to_basic = place;
  else
    warnings.note("unread-instance", block_.file, block_.begin,
                  "where the instance " + instance.name + " stands can't be made out; it is shown where its part stands");
}

void Walk::read_values() {
  for (std::uint32_t s = 0; s < block_.segments; ++s) {
    const Segment& where = segments[block_.first_segment + s];
    DataLines lines(text(where.file), where.begin, where.end);
    for (DataLine line; lines.next(line);) {
      const std::size_t equals = line.text.find('=');
      double value = 0;
      if (equals == std::string_view::npos || trim(line.text.substr(equals + 1)).empty()) continue;
      const std::string name(trim(line.text.substr(0, std::min<std::size_t>(equals, 100))));
      if (parse_real(trim(line.text.substr(equals + 1)), value))
        values[name] = value;
      else
        values.erase(name);
    }
  }
}

/// A piece for each instance of its part.
Result<void> Walk::place_instances() {
  constexpr std::size_t kMaxCopied = std::size_t{256} << 20;
  std::vector<std::size_t> bytes(scopes.size());
  for (const Piece& piece : pieces)
    if (piece.instance == kNone)
      bytes[piece.scope] += piece.segments.back().end - piece.segments.front().begin + 64 * piece.segments.size();
  for (const Kept& keep : kept) {
    bytes[keep.block.scope] += keep.block.end - keep.block.begin + 64;
    for (std::uint32_t s = 0; s < keep.block.segments; ++s) {
      const Segment& segment = segments[keep.block.first_segment + s];
      bytes[keep.block.scope] += segment.end - segment.begin;
    }
  }
  std::size_t copied = 0;
  for (std::size_t s = 1; s < scopes.size(); ++s) {
    Scope& scope = scopes[s];
    // A file of parts without an assembly shows them where they are.
    if (instances.empty()) continue;
    if (scope.instances.empty()) {
      if (bytes[s] > 0)
        warnings.note_each("unused-part", scope.file, scope.begin,
                           "the part " + scope.name + " has no instance, so it isn't shown; it is kept as it is");
      continue;
    }
    if (scope.instances.size() > 1) {
      warnings.note_each("repeated-part", scope.file, scope.begin,
                         "the part " + scope.name + " has " + std::to_string(scope.instances.size()) +
                             " instances: each is shown, and their nodes can't be moved");
      if (bytes[s] > 0 && scope.instances.size() - 1 > (kMaxCopied - copied) / bytes[s])
        return fail(files.files[scope.file].path.string(), line_number(text(scope.file), scope.begin),
                    "the part " + scope.name + " has " + std::to_string(scope.instances.size()) +
                        " instances; all of them together are more than this version shows");
      copied += (scope.instances.size() - 1) * bytes[s];
    }
  }
  std::vector<Piece> placed;
  for (Piece& piece : pieces) {
    if (piece.instance != kNone || piece.scope == 0 || instances.empty()) {
      placed.push_back(std::move(piece));
      continue;
    }
    const Scope& scope = scopes[piece.scope];
    for (const std::uint32_t instance : scope.instances) {
      Piece copy = piece;
      copy.instance = instance;
      copy.held |= scope.instances.size() > 1;
      placed.push_back(std::move(copy));
    }
  }
  pieces = std::move(placed);
  return {};
}

}  // namespace prismesh::mesh::deck::abaqus
