#include "mesh/deck/assembly/warnings.h"

#include <algorithm>
#include <map>

#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck {

namespace {

constexpr std::size_t kMaxOfAKind = 100;
constexpr std::size_t kMaxOtherPlaces = 2;

/// Counts the line numbers of places in one pass over each file.
class LineNumbers {
 public:
  explicit LineNumbers(std::span<const SourceFile> files) : files_(files) {}
  void want(std::uint32_t file, std::size_t offset) { lines_[{file, offset}] = 0; }
  void count() {
    std::pair<std::uint32_t, std::size_t> before{0, 0};
    long line = 1;
    for (auto& [place, number] : lines_) {
      if (place.first != before.first) {
        before = {place.first, 0};
        line = 1;
      }
      const std::string_view text = files_[place.first].bytes.text();
      const std::size_t offset = std::min(place.second, text.size());
      line += line_number(text.substr(before.second, offset - before.second), std::string_view::npos) - 1;
      before.second = offset;
      number = line;
    }
  }
  long at(std::uint32_t file, std::size_t offset) const { return lines_.at({file, offset}); }

 private:
  std::span<const SourceFile> files_;
  std::map<std::pair<std::uint32_t, std::size_t>, long> lines_;
};

}  // namespace

void Warnings::note(std::string_view kind, std::uint32_t file, std::size_t offset, std::string message, std::size_t count) {
  const auto at = std::find_if(entries_.begin(), entries_.end(), [&](const WarningEntry& entry) { return entry.kind == kind; });
  if (at == entries_.end()) {
    entries_.push_back({std::string(kind), file, offset, std::move(message), count});
    return;
  }
  at->count += count;
  const bool known = at->file == file && at->offset == offset;
  if (!known && at->others.size() < kMaxOtherPlaces &&
      std::find(at->others.begin(), at->others.end(), std::pair(file, offset)) == at->others.end())
    at->others.emplace_back(file, offset);
}

void Warnings::note_each(std::string_view kind, std::uint32_t file, std::size_t offset, std::string message) {
  std::size_t of_kind = 0;
  WarningEntry* last = nullptr;
  for (WarningEntry& entry : entries_) {
    if (entry.kind != kind) continue;
    if (entry.file == file && entry.message == message) {
      ++entry.count;
      return;
    }
    ++of_kind;
    last = &entry;
  }
  if (of_kind > kMaxOfAKind)
    ++last->count;
  else if (of_kind == kMaxOfAKind)
    entries_.push_back({std::string(kind), file, offset, "there are more like these from here on", 1, {}, true});
  else
    entries_.push_back({std::string(kind), file, offset, std::move(message), 1, {}, true});
}

std::vector<Warning> Warnings::finish(std::span<const SourceFile> files) const {
  LineNumbers lines(files);
  for (const WarningEntry& entry : entries_) {
    lines.want(entry.file, entry.offset);
    for (const auto& [file, offset] : entry.others) lines.want(file, offset);
  }
  lines.count();
  std::vector<Warning> out;
  for (const WarningEntry& entry : entries_) {
    std::string message = entry.message;
    for (std::size_t i = 0; i < entry.others.size(); ++i) {
      const auto& [file, offset] = entry.others[i];
      message += i == 0 ? "; also at " : ", ";
      message += (file == entry.file ? "line " : files[file].relative.generic_string() + ":") + std::to_string(lines.at(file, offset));
    }
    if (!entry.each && entry.count > entry.others.size() + 1)
      message += (entry.others.empty() ? "; " : " and ") + std::to_string(entry.count - entry.others.size() - 1) + " more";
    out.push_back({files[entry.file].path.string(), lines.at(entry.file, entry.offset), entry.kind, std::move(message), entry.count});
  }
  return out;
}

}  // namespace prismesh::mesh::deck
