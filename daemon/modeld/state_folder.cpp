#include "daemon/modeld/state_folder.h"

#include <algorithm>
#include <cstdlib>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

#include "base/file.h"
#include "ipc/descriptor.h"
#include "ipc/messages_json.h"

namespace prismesh::modeld {

namespace {

namespace fs = std::filesystem;

constexpr const char* kJournal = ".journal";
constexpr const char* kIntent = ".saving";
constexpr const char* kSession = "session.json";
constexpr std::size_t kRetiredKept = 50;

/// One deck has one name here, whatever links lead to it.
std::string deck_name(const fs::path& deck) {
  std::error_code problem;
  fs::path real = fs::canonical(deck, problem);
  if (problem) real = fs::absolute(deck, problem).lexically_normal();
  const std::string& text = real.native();
  return hash128(std::as_bytes(std::span(text.data(), text.size()))).hex().substr(0, 16);
}

std::vector<fs::path> files_with(const fs::path& folder, const std::string& begin, const std::string& end) {
  std::vector<fs::path> found;
  std::error_code problem;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, problem)) {
    const std::string name = entry.path().filename().string();
    if (name.size() >= begin.size() + end.size() && name.starts_with(begin) && name.ends_with(end)) found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

void flush_folder(const fs::path& folder) {
  const ipc::Descriptor descriptor(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (descriptor) ::fsync(descriptor.get());
}

void prune_retired(const fs::path& folder) {
  std::vector<std::pair<fs::file_time_type, fs::path>> retired;
  std::error_code problem;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, problem))
    if (entry.path().filename().string().find(std::string(kJournal) + ".") != std::string::npos && entry.path().extension() != kIntent)
      retired.emplace_back(entry.last_write_time(problem), entry.path());
  std::sort(retired.begin(), retired.end());
  for (std::size_t i = 0; i + kRetiredKept < retired.size(); ++i) fs::remove(retired[i].second, problem);
}

}  // namespace

fs::path state_directory(const std::optional<fs::path>& override) {
  if (override) return *override;
  if (const char* folder = std::getenv("STATE_DIRECTORY"); folder != nullptr && *folder != 0) {
    const std::string all = folder;
    return all.substr(0, all.find(':'));
  }
  if (const char* folder = std::getenv("XDG_STATE_HOME"); folder != nullptr && *folder != 0) return fs::path(folder) / "prismesh";
  const char* home = std::getenv("HOME");
  return fs::path(home != nullptr && *home != 0 ? home : "/") / ".local/state/prismesh";
}

fs::path StateFolder::journal(const fs::path& deck, const Hash128& content) const {
  return folder_ / (deck_name(deck) + "-" + content.hex() + kJournal);
}

std::vector<fs::path> StateFolder::other_journals(const fs::path& deck, const Hash128& content) const {
  std::vector<fs::path> found = files_with(folder_, deck_name(deck) + "-", kJournal);
  std::erase(found, journal(deck, content));
  return found;
}

fs::path StateFolder::save_intent(const fs::path& journal) { return journal.string() + kIntent; }

std::vector<fs::path> StateFolder::save_intents(const fs::path& deck) const {
  return files_with(folder_, deck_name(deck) + "-", std::string(kJournal) + kIntent);
}

Result<fs::path> StateFolder::retire(const fs::path& journal, const char* ending) const {
  std::error_code problem;
  for (int i = 1;; ++i) {
    const fs::path target = journal.string() + ending + "." + std::to_string(i);
    if (fs::exists(target, problem)) continue;
    fs::rename(journal, target, problem);
    if (problem) return fail(journal.string(), "can't be renamed: " + problem.message());
    fs::last_write_time(target, fs::file_time_type::clock::now(), problem);
    flush_folder(folder_);
    prune_retired(folder_);
    return target;
  }
}

Result<void> StateFolder::write_session(const Session& session) const {
  const Result<std::string> line = ipc::encode_request(session.attempts, session.open);
  if (!line) return fail(line.error());
  const PendingFile file{folder_ / kSession, {*line, "\n"}};
  return replace_files(std::span(&file, 1));
}

Result<std::optional<StateFolder::Session>> StateFolder::read_session() const {
  std::error_code problem;
  const fs::path path = folder_ / kSession;
  if (!fs::exists(path, problem)) return std::optional<Session>();
  const Result<FileBytes> bytes = read_file(path);
  if (!bytes) return fail(bytes.error());
  const auto request = ipc::decode_request(bytes->text());
  if (!request) return fail(path.string(), 1, request.error().message);
  const auto* open = std::get_if<ipc::Open>(&request->request);
  if (open == nullptr) return fail(path.string(), 1, "it doesn't say what was open");
  return std::optional(Session{*open, request->number});
}

void StateFolder::forget_session() const {
  std::error_code problem;
  fs::remove(folder_ / kSession, problem);
  flush_folder(folder_);
}

}  // namespace prismesh::modeld
