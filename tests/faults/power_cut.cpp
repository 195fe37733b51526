#include "tests/faults/power_cut.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace prismesh::test {

namespace {

namespace fs = std::filesystem;
using Kind = FileCall::Kind;

constexpr std::size_t kSector = 512;

/// A file as it grew: what is surely on disk, and the writes since.
struct File {
  std::string flushed;
  std::string now;
  std::vector<const FileCall*> since;
};

/// What the names of one folder were changed by since it was flushed.
struct Change {
  const FileCall* call = nullptr;
  std::shared_ptr<File> file;  ///< of make
};

using Names = std::map<std::string, std::shared_ptr<File>>;  ///< null: a folder

void carry_out(const FileCall& call, std::string& content) {
  const auto offset = static_cast<std::size_t>(call.offset);
  if (call.kind == Kind::truncate) return content.resize(offset);
  if (content.size() < offset + call.data.size()) content.resize(offset + call.data.size());
  content.replace(offset, call.data.size(), call.data);
}

/// A change of names; where it makes no sense any more (what it concerns isn't there) nothing happens.
void carry_out(const Change& change, Names& names) {
  const FileCall& call = *change.call;
  const auto source = names.find(call.path);
  switch (call.kind) {
    case Kind::make: names[call.path] = change.file; break;
    case Kind::make_folder: names[call.path] = nullptr; break;
    case Kind::remove:
      if (source != names.end()) names.erase(source);
      break;
    case Kind::rename:
      if (source == names.end()) break;
      names[call.other] = source->second;
      names.erase(call.path);
      break;
    case Kind::link:
      if (source != names.end()) names[call.other] = source->second;
      break;
    default: break;
  }
}

std::string folder_of_change(const FileCall& call) {
  return fs::path(call.kind == Kind::rename || call.kind == Kind::link ? call.other : call.path).parent_path().string();
}

/// Sectors of the writes that weren't flushed, each there or not; the length is that before, that now or one that a write made.
std::string torn(const File& file, std::mt19937_64& random) {
  std::string content = file.flushed;
  for (const FileCall* call : file.since) {
    if (call->kind == Kind::truncate) {
      if (random() % 2 == 0) carry_out(*call, content);
      continue;
    }
    const auto begin = static_cast<std::size_t>(call->offset), end = begin + call->data.size();
    if (random() % 4 != 0 && content.size() < end) content.resize(end);  // the length came to disk first
    for (std::size_t at = begin; at < end;) {
      const std::size_t next = std::min(end, (at / kSector + 1) * kSector);
      if (random() % 2 == 0) {
        if (content.size() < next) content.resize(next);
        content.replace(at, next - at, call->data, at - begin, next - at);
      }
      at = next;
    }
  }
  return content;
}

}  // namespace

DiskState disk_state_of(const fs::path& folder) {
  DiskState state{folder.string(), {}, {}};
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_directory()) {
      state.folders.push_back(entry.path().string());
      continue;
    }
    std::ifstream in(entry.path(), std::ios::binary);
    std::stringstream text;
    text << in.rdbuf();
    state.files[entry.path().string()] = std::move(text).str();
  }
  std::sort(state.folders.begin(), state.folders.end());
  return state;
}

void restore(const DiskState& state) {
  for (const fs::directory_entry& entry : fs::directory_iterator(state.root)) fs::remove_all(entry.path());
  for (const std::string& path : state.folders) {
    fs::create_directories(path);
    fs::permissions(path, fs::perms::owner_all);
  }
  for (const auto& [path, content] : state.files) {
    std::ofstream(path, std::ios::binary) << content;
    fs::permissions(path, fs::perms::owner_read | fs::perms::owner_write);
  }
}

DiskState after_power_cut(const DiskState& before, std::span<const FileCall> calls, std::size_t count, Survives survives,
                          std::mt19937_64& random) {
  Names flushed, now;
  std::map<std::uint64_t, std::shared_ptr<File>> by_inode;
  std::map<std::string, std::vector<Change>> since;  // by folder
  for (const std::string& folder : before.folders) flushed[folder] = nullptr;
  for (const auto& [path, content] : before.files) flushed[path] = std::make_shared<File>(File{content, content, {}});
  now = flushed;
  const auto file_of = [&](const FileCall& call) -> File& {
    std::shared_ptr<File>& file = by_inode[call.inode];
    if (!file) file = now.at(call.path);  // it was there before the recording
    return *file;
  };
  const auto flush = [&](const std::string& folder) {
    for (const Change& change : since[folder]) carry_out(change, flushed);
    since.erase(folder);
  };
  for (const FileCall& call : calls.first(count)) {
    switch (call.kind) {
      case Kind::write:
      case Kind::truncate:
        carry_out(call, file_of(call).now);
        file_of(call).since.push_back(&call);
        break;
      case Kind::sync:
        file_of(call).flushed = file_of(call).now;
        file_of(call).since.clear();
        break;
      case Kind::sync_folder: flush(call.path); break;
      case Kind::sync_all:
        for (auto& [inode, file] : by_inode) file->flushed = file->now, file->since.clear();
        while (!since.empty()) flush(std::string(since.begin()->first));
        break;
      case Kind::mark: break;
      default: {
        Change change{&call, nullptr};
        if (call.kind == Kind::make) change.file = by_inode[call.inode] = std::make_shared<File>();
        carry_out(change, now);
        since[folder_of_change(call)].push_back(change);
      }
    }
  }

  Names names = survives == Survives::all ? now : flushed;
  if (survives == Survives::in_order || survives == Survives::any)
    for (const auto& [folder, changes] : since) {
      const std::size_t first = random() % (changes.size() + 1);
      for (std::size_t i = 0; i < changes.size(); ++i)
        if (survives == Survives::in_order ? i < first : random() % 2 == 0) carry_out(changes[i], names);
    }
  DiskState state{before.root, {}, {}};
  for (const auto& [path, file] : names) {
    const std::string folder = fs::path(path).parent_path().string();
    if (folder != before.root && !names.contains(folder)) continue;  // the folder's own name is lost
    if (!file)
      state.folders.push_back(path);
    else
      state.files[path] = survives == Survives::all ? file->now : survives == Survives::flushed ? file->flushed : torn(*file, random);
  }
  return state;
}

}  // namespace prismesh::test
