#include "daemon/modeld/state_folder.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

#include "base/file.h"
#include "ipc/model/messages_json.h"
#include "ipc/wire/descriptor.h"

namespace prismesh::modeld {

namespace {

namespace fs = std::filesystem;

constexpr const char* kJournal = ".journal";
constexpr const char* kIntent = ".saving";
constexpr const char* kSession = "session.json";
constexpr const char* kNumbers = "numbers";
constexpr std::uint64_t kNumbersOfALife = std::uint64_t{1} << 34;  ///< chunk numbers: a thousand a second for half a year
constexpr std::size_t kRetiredKept = 50;

/// Resolves links, so that a deck has one name here.
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

/// Checksum behind a line, so that a changed byte is found.
std::string check_line(std::string_view line) { return "check " + hash128(std::as_bytes(std::span(line))).hex() + "\n"; }

/// Whether a file is one of those of which only the newest are kept. What couldn't be read isn't: nobody knows what it holds.
bool is_pruned(const fs::path& file) {
  const std::string name = file.filename().string();
  return name.find(std::string(kJournal) + ".") != std::string::npos && name.find(std::string(kDamaged) + ".") == std::string::npos &&
         file.extension() != kIntent;
}

void prune_retired(const fs::path& folder) {
  std::vector<std::pair<fs::file_time_type, fs::path>> retired;
  std::error_code problem;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, problem))
    if (is_pruned(entry.path())) retired.emplace_back(entry.last_write_time(problem), entry.path());
  std::sort(retired.begin(), retired.end());
  for (std::size_t i = 0; i + kRetiredKept < retired.size(); ++i) fs::remove(retired[i].second, problem);
}

}  // namespace

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

std::uint64_t StateFolder::first_number() const {
  const auto clock = static_cast<std::uint64_t>(
      std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::system_clock::now().time_since_epoch()).count());
  std::uint64_t noted = 0;
  if (const Result<FileBytes> bytes = read_file(folder_ / kNumbers)) {
    const std::string_view text = bytes->text(), line = text.substr(0, text.find('\n'));
    if (line.size() < text.size() && text.substr(line.size() + 1) == check_line(line))
      std::from_chars(line.data(), line.data() + line.size(), noted);
  }
  const std::uint64_t first = std::max(clock, noted);
  const std::string line = std::to_string(first + kNumbersOfALife), check = check_line(line);
  const PendingFile file{folder_ / kNumbers, {line, "\n", check}};
  (void)replace_files(std::span(&file, 1));  // if that fails, the clock has to suffice
  return first;
}

Result<fs::path> StateFolder::retire(const fs::path& journal, const char* ending) const {
  std::error_code problem;
  for (int i = 1;; ++i) {
    const fs::path target = journal.string() + ending + "." + std::to_string(i);
    if (fs::exists(target, problem)) continue;
    fs::rename(journal, target, problem);
    if (problem) return fail(journal.string(), "can't be renamed: " + problem.message());
    fs::last_write_time(target, fs::file_time_type::clock::now(), problem);
    if (Result<void> flushed = flush_folder(folder_); !flushed) return fail(std::move(flushed.error()));
    prune_retired(folder_);
    return target;
  }
}

/// Moves a session aside that can't be read, so that what it says can be looked up by hand.
void StateFolder::keep_unread_session() const {
  std::error_code problem;
  const fs::path session = folder_ / kSession;
  if (fs::is_regular_file(session, problem) && !read_session()) (void)retire(session, kDamaged);
}

Result<void> StateFolder::write_session(const Session& session) const {
  keep_unread_session();
  const Result<std::string> line = ipc::encode_request(session.attempts, session.open);
  if (!line) return fail(line.error());
  const std::string check = check_line(*line);
  const PendingFile file{folder_ / kSession, {*line, "\n", check}};
  return replace_files(std::span(&file, 1));
}

Result<std::optional<StateFolder::Session>> StateFolder::read_session() const {
  std::error_code problem;
  const fs::path path = folder_ / kSession;
  if (!fs::exists(path, problem)) return std::optional<Session>();
  const Result<FileBytes> bytes = read_file(path);
  if (!bytes) return fail(bytes.error());
  const std::string_view text = bytes->text();
  const std::string_view line = text.substr(0, text.find('\n'));
  if (line.size() == text.size() || text.substr(line.size() + 1) != check_line(line))
    return fail(path.string(), 1,
                "what was open when the daemon ended can't be told: this file isn't as it was written. Open the deck by hand");
  const auto request = ipc::decode_request(line);
  if (!request) return fail(path.string(), 1, request.error().message);
  const auto* open = std::get_if<ipc::Open>(&request->request);
  if (open == nullptr) return fail(path.string(), 1, "it doesn't say what was open");
  return std::optional(Session{*open, request->number});
}

void StateFolder::forget_session() const {
  keep_unread_session();
  remove(folder_ / kSession);
}

void StateFolder::remove(const fs::path& file) const {
  std::error_code problem;
  if (fs::remove(file, problem)) (void)flush_folder(folder_);  // a file that a power cut brings back is found to be obsolete
}

}  // namespace prismesh::modeld
