// The tree of files and parts as the user has filtered, sorted, folded and chosen it. No ImGui.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace prismesh::kiosk::tools::parts {

/// Shells that warn and fail.
struct Errors {
  std::uint32_t warn = 0, fail = 0;
  bool operator==(const Errors&) const = default;
};

struct PartRow {
  std::int64_t id = 0;
  std::string name;
  std::uint64_t shells = 0;
  Errors errors;
  unsigned colour = 0;  ///< 0xAABBGGRR, as the picture shows it
  bool hidden = false, locked = false, transparent = false;
};

/// A file of the deck that holds shells. The flags say that all of its parts are so.
struct FileRow {
  std::string name;
  std::uint64_t shells = 0;
  std::vector<std::int64_t> parts;  ///< ids, ascending
  Errors errors;                    ///< of its parts, with their shells in other files
  bool hidden = false, locked = false;
};

struct PartFacts {
  std::vector<PartRow> parts;  ///< by PartIndex
  std::vector<FileRow> files;  ///< none if there is only one
};

enum class SortBy : std::uint8_t { id, name, shells, errors };

/// A row of the tree. Files stand above their parts; parts that no file has stand last.
struct TreeRow {
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  std::size_t file = kNone;  ///< into PartFacts::files
  std::size_t part = kNone;  ///< into PartFacts::parts; none: the row is the file's own

  bool is_file() const { return part == kNone; }
  bool operator==(const TreeRow&) const = default;
};

/// How a click chooses: this row only, this one in or out, or all up to here.
enum class Choice : std::uint8_t { only, other, up_to };

class PartTree {
 public:
  /// Takes newer facts of the same deck: what is filtered, sorted, folded and chosen stays.
  void set_facts(PartFacts facts);
  /// Another deck is open.
  void forget();
  const PartFacts& facts() const { return facts_; }

  /// Shows the parts whose id or name contains the text, or whose file's name does. Case counts only outside of ASCII.
  void set_filter(const std::string& text);
  const std::string& filter() const { return filter_; }
  /// By another column: names and ids ascend, counts descend. By the same one: the other way round. Parts that are equal by it keep the
  /// order of their ids.
  void sort(SortBy by);
  SortBy sorted_by() const { return by_; }
  bool descending() const { return descending_; }
  /// Folds a file or unfolds it. A filter shows what is folded, too.
  void fold(std::size_t file);
  bool folded(std::size_t file) const { return filter_.empty() && folded_.contains(facts_.files[file].name); }
  /// `row` into rows(). A file's row stands for all of its parts that are shown.
  void choose(std::size_t row, Choice choice);
  void choose_none();

  const std::vector<TreeRow>& rows() const { return rows_; }
  bool chosen(std::size_t part) const { return chosen_.contains(facts_.parts[part].id); }
  /// What an action is for, ascending: the chosen parts that match the filter, else all that match.
  const std::vector<std::size_t>& acted_on() const { return acted_on_; }
  bool acts_on_chosen() const { return acts_on_chosen_; }

 private:
  void build();
  void find_matches();
  void find_acted_on();
  std::vector<std::size_t> sorted_parts() const;
  std::vector<std::size_t> sorted_files() const;
  std::vector<std::int64_t> parts_of(std::size_t row) const;

  PartFacts facts_;
  std::string filter_;
  SortBy by_ = SortBy::id;
  bool descending_ = false;
  std::set<std::string> folded_;   ///< names of files
  std::set<std::int64_t> chosen_;  ///< ids
  std::optional<TreeRow> anchor_;  ///< where a choice up to a row begins
  // What follows from these:
  std::vector<std::uint8_t> part_matches_, file_matches_;
  std::vector<TreeRow> rows_;
  std::vector<std::size_t> acted_on_;
  bool acts_on_chosen_ = false;
};

}  // namespace prismesh::kiosk::tools::parts
