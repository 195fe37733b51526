#include "mesh/deck/save_record.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include "base/file.h"
#include "mesh/deck/assembly/file_set.h"

namespace prismesh::mesh::deck {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr std::string_view kMagic = "prismesh save 1";
constexpr int kTries = 150;  ///< to lock a record; putting files in place takes far less time
constexpr auto kBetweenTries = 20ms;

enum class FileState : std::uint8_t {
  replaced,
  unaffected,  ///< it is to hold what it held before
  waiting,     ///< not replaced; the temporary file is there
  lost,        ///< its content has changed, or the temporary file is missing
};

FileState state_of(const ReplacedFile& file) {
  const std::optional<Hash128> now = content_now(file.target);
  if (now == file.after) return file.before == file.after ? FileState::unaffected : FileState::replaced;
  return now == file.before && content_now(file.temporary) == file.after ? FileState::waiting : FileState::lost;
}

std::vector<FileState> states_of(std::span<const ReplacedFile> files) {
  std::vector<FileState> states;
  for (const ReplacedFile& file : files) states.push_back(state_of(file));
  return states;
}

Result<void> put_rest_in_place(std::span<const ReplacedFile> files, const std::vector<FileState>& states) {
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (states[i] != FileState::waiting) continue;
    if (::rename(files[i].temporary.c_str(), files[i].target.c_str()) != 0)
      return fail(files[i].target.string(), "a save that was cut off can't be finished: " + std::generic_category().message(errno));
  }
  for (const ReplacedFile& file : files)
    if (Result<void> flushed = flush_folder(folder_of(file.target), file.target); !flushed) return flushed;
  return {};
}

SaveOutcome outcome_of(const std::vector<FileState>& states) {
  const auto count = [&](FileState state) { return std::count(states.begin(), states.end(), state); };
  if (count(FileState::replaced) == 0) return SaveOutcome::not_begun;
  if (count(FileState::lost) > 0) return SaveOutcome::mixed;
  return count(FileState::waiting) > 0 ? SaveOutcome::finished : SaveOutcome::complete;
}

std::string check_of(std::string_view text) { return hash128(std::as_bytes(std::span(text.data(), text.size()))).hex(); }

std::optional<Hash128> hash_from(std::string_view hex) {
  if (hex.size() != 32 || hex.find_first_not_of("0123456789abcdef") != std::string_view::npos) return std::nullopt;
  const auto word = [&](std::size_t at) { return std::stoull(std::string(hex.substr(at, 16)), nullptr, 16); };
  return Hash128{word(16), word(0)};
}

/// Fields end with NUL, which no path holds: magic, then for each file its target and temporary file, relative to the record's folder where
/// they are below it, and the contents before and after; last the hash of all that.
std::string text_of(const fs::path& folder, std::span<const ReplacedFile> files) {
  std::string text;
  const auto put = [&](std::string_view field) { (text += field) += '\0'; };
  const auto put_path = [&](const fs::path& path) {
    const fs::path relative = path.lexically_relative(folder);
    put((relative.empty() || *relative.begin() == ".." ? path : relative).native());
  };
  put(kMagic);
  for (const ReplacedFile& file : files) {
    std::error_code problem;
    const fs::path in = fs::canonical(folder_of(file.target), problem);
    put_path(in / file.target.filename());
    put_path(in / file.temporary.filename());
    put(file.before.hex());
    put(file.after.hex());
  }
  put(check_of(text));
  return text;
}

std::optional<std::vector<ReplacedFile>> files_in(std::string_view text, const fs::path& folder) {
  std::vector<std::string_view> fields;
  for (std::size_t at = 0, end = 0; at < text.size(); at = end + 1) {
    end = text.find('\0', at);
    if (end == std::string_view::npos) return std::nullopt;
    fields.push_back(text.substr(at, end - at));
  }
  if (fields.size() < 2 || fields.size() % 4 != 2 || fields.front() != kMagic) return std::nullopt;
  if (fields.back() != check_of(text.substr(0, static_cast<std::size_t>(fields.back().data() - text.data())))) return std::nullopt;
  std::vector<ReplacedFile> files;
  for (std::size_t i = 1; i + 4 < fields.size(); i += 4) {
    const std::optional<Hash128> before = hash_from(fields[i + 2]), after = hash_from(fields[i + 3]);
    if (!before || !after) return std::nullopt;
    files.push_back({folder / fields[i], folder / fields[i + 1], *before, *after});
  }
  return files;
}

/// Whether a record may have a file replaced. A record may come from anywhere, packed with a deck: it must not reach out of the deck's
/// folder, nor name other files than a save makes.
bool is_own(const ReplacedFile& file, const fs::path& folder) {
  std::error_code problem;
  const fs::path in = fs::canonical(folder_of(file.target), problem);
  if (problem || folder_of(file.temporary) != folder_of(file.target)) return false;
  const fs::path relative = in.lexically_relative(folder);
  return !relative.empty() && *relative.begin() != ".." &&
         file.temporary.filename().string().starts_with("." + file.target.filename().string() + ".");
}

enum class Locked : std::uint8_t { yes, gone, by_another };

/// Opens a record and locks it, at once or, where it has to wait, after a while.
Locked lock(const fs::path& record, int tries, int& fd) {
  for (int i = 0; i < tries; ++i) {
    if (i > 0) std::this_thread::sleep_for(kBetweenTries);
    fd = ::open(record.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOFOLLOW);
    if (fd < 0) return Locked::gone;
    const bool held = ::flock(fd, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    struct stat status {};
    struct stat named {};
    if (!held && ::fstat(fd, &status) == 0 && ::stat(record.c_str(), &named) == 0 && named.st_ino == status.st_ino) return Locked::yes;
    ::close(std::exchange(fd, -1));
  }
  return Locked::by_another;
}

/// Writes, flushes and locks a record. 0 or an errno.
int write_locked(int fd, std::string_view text) {
  const mode_t mask = ::umask(0);
  ::umask(mask);
  // As readable as the deck: whoever opens that has to see the record.
  if (::fchmod(fd, 0666 & ~mask) != 0) return errno;
  const ssize_t written = ::write(fd, text.data(), text.size());
  if (written < 0) return errno;
  if (static_cast<std::size_t>(written) != text.size()) return ENOSPC;
  if (::fsync(fd) != 0) return errno;
  (void)::flock(fd, LOCK_EX | LOCK_NB);  // fails only where the file system has no locks
  return 0;
}

tl::unexpected<Error> being_saved(const fs::path& deck) {
  return fail(deck.string(), "another program is saving this deck just now; try again when it has ended");
}

fs::path main_file(const fs::path& deck) {
  std::error_code problem;
  fs::path real = fs::weakly_canonical(deck, problem);
  return problem ? fs::absolute(deck, problem).lexically_normal() : real;
}

std::string names_of(std::span<const ReplacedFile> files) {
  std::string names;
  for (const ReplacedFile& file : files) names += (names.empty() ? "" : ", ") + file.target.string();
  return names;
}

/// Moves a damaged record aside. Returns its new place; empty, if it can't be moved.
fs::path moved_aside(const fs::path& record) {
  std::error_code problem;
  for (int i = 1;; ++i) {
    const fs::path aside = record.string() + ".damaged." + std::to_string(i);
    if (fs::exists(fs::symlink_status(aside, problem))) continue;
    return ::rename(record.c_str(), aside.c_str()) == 0 ? aside : fs::path();
  }
}

/// Reads the files that wait in place of those that they are to replace.
void read_waiting(std::span<const ReplacedFile> files, StandIns& stand_ins) {
  for (const ReplacedFile& file : files)
    if (state_of(file) == FileState::waiting) stand_ins[canonical_name(file.target)] = file.temporary;
}

void remove_own_temporaries(std::span<const ReplacedFile> files, const fs::path& folder) {
  for (const ReplacedFile& file : files)
    if (is_own(file, folder)) ::unlink(file.temporary.c_str());
}

/// Settles what a locked record names. Returns whether it is settled, so that the record isn't needed any more.
bool settle(const fs::path& deck, std::span<const ReplacedFile> files, CutOffSave& found) {
  const auto warn = [&](const char* kind, const std::string& message) {
    found.warnings.push_back({deck.string(), 0, kind, "a save was cut off between the deck's files" + message, 1});
  };
  const fs::path folder = folder_of(main_file(deck));
  const bool own = std::all_of(files.begin(), files.end(), [&](const ReplacedFile& file) { return is_own(file, folder); });
  found.outcome = outcome_of(states_of(files));
  if (*found.outcome == SaveOutcome::finished) {
    const Result<SaveOutcome> finished =
        own ? finish_replacing(files) : fail("", "some of them lie outside the folder of the deck, which a record beside it may not reach");
    if (!finished) {
      read_waiting(files, found.stand_ins);
      warn("save-unfinished", ", and can't be finished: " + finished.error().text() +
                                  ". The deck is read as it was saved, from hidden files beside " + names_of(files));
      return false;
    }
    found.outcome = *finished;
  }
  if (*found.outcome == SaveOutcome::finished) warn("save-finished", "; the rest has been put in place now");
  if (*found.outcome == SaveOutcome::mixed)
    warn("save-mixed", ", and can't be finished since something else has changed or removed some of them: " + names_of(files) +
                           ". Saving the deck ends this warning");
  return *found.outcome != SaveOutcome::mixed;
}

}  // namespace

std::optional<Hash128> content_now(const fs::path& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) return errno == ENOENT ? std::optional(Hash128{}) : std::nullopt;
  const Result<FileBytes> bytes = read_file(file);
  return bytes ? std::optional(hash128(bytes->bytes())) : std::nullopt;
}

Result<SaveOutcome> finish_replacing(std::span<const ReplacedFile> files) {
  const std::vector<FileState> states = states_of(files);
  const SaveOutcome outcome = outcome_of(states);
  if (outcome == SaveOutcome::finished)
    if (Result<void> placed = put_rest_in_place(files, states); !placed) return fail(std::move(placed.error()));
  return outcome;
}

SaveRecord::SaveRecord(SaveRecord&& other) noexcept : path_(std::move(other.path_)), fd_(std::exchange(other.fd_, -1)) {}

SaveRecord& SaveRecord::operator=(SaveRecord&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(fd_, other.fd_);
  return *this;
}

SaveRecord::~SaveRecord() {
  if (fd_ >= 0) ::close(fd_);
}

fs::path SaveRecord::place_of(const fs::path& deck) {
  const fs::path main = main_file(deck);
  return folder_of(main) / ("." + main.filename().string() + ".saving");
}

Result<void> SaveRecord::remove_earlier(const fs::path& deck) {
  const fs::path path = place_of(deck);
  int fd = -1;
  const Locked locked = lock(path, 1, fd);
  if (locked == Locked::by_another) return being_saved(deck);
  if (locked == Locked::gone) return {};
  SaveRecord earlier(path, fd);
  const Result<FileBytes> bytes = read_file(path);
  if (!bytes) return fail(bytes.error());
  const std::optional<std::vector<ReplacedFile>> files = files_in(bytes->text(), folder_of(path));
  if (!files) {
    moved_aside(path);
    return {};
  }
  remove_own_temporaries(*files, folder_of(path));
  earlier.end();
  return {};
}

Result<SaveRecord> SaveRecord::begin(const fs::path& deck, std::span<const ReplacedFile> files) {
  if (Result<void> removed = remove_earlier(deck); !removed) return fail(std::move(removed.error()));
  const fs::path path = place_of(deck);
  std::string made = path.string() + ".XXXXXX";
  SaveRecord record(path, ::mkostemp(made.data(), O_CLOEXEC));
  int error = record.fd_ < 0 ? errno : write_locked(record.fd_, text_of(folder_of(path), files));
  // Linked instead of renamed: a link never replaces the record of another program.
  if (error == 0 && ::link(made.c_str(), path.c_str()) != 0) error = errno;
  if (error == EPERM || error == EOPNOTSUPP) error = ::rename(made.c_str(), path.c_str()) == 0 ? 0 : errno;
  if (record.fd_ >= 0) ::unlink(made.c_str());
  if (error == EEXIST) return being_saved(deck);
  if (error != 0)
    return fail(path.string(),
                "the record of the save can't be written: " + std::generic_category().message(error) + "; nothing was changed");
  if (Result<void> flushed = flush_folder(folder_of(path), path); !flushed) {
    record.end();
    return fail(std::move(flushed.error()));
  }
  return record;
}

Result<SaveRecord> SaveRecord::of_cut_off_save(const fs::path& deck) {
  const fs::path path = place_of(deck);
  int fd = -1;
  if (lock(path, kTries, fd) == Locked::by_another) return being_saved(deck);
  return SaveRecord(path, fd);
}

void SaveRecord::end() {
  if (::unlink(path_.c_str()) == 0) (void)flush_folder(folder_of(path_));
  ::close(std::exchange(fd_, -1));
}

Result<CutOffSave> settle_cut_off_save(const fs::path& deck) {
  CutOffSave found;
  const fs::path path = SaveRecord::place_of(deck);
  std::error_code problem;
  if (!fs::exists(fs::symlink_status(path, problem))) return found;
  const auto unknown = [&](const std::string& message) {
    found.warnings.push_back(
        {deck.string(), 0, "save-unknown",
         "a save was cut off, " + message + ": if the deck has several files, some may be from before the save and some from after it", 1});
  };
  Result<SaveRecord> record = SaveRecord::of_cut_off_save(deck);
  if (!record) return fail(std::move(record.error()));
  if (!record->is_there()) {
    // It has just ended, or may not be read.
    if (fs::exists(fs::symlink_status(path, problem))) unknown("and its record can't be read (" + path.string() + ")");
    return found;
  }
  const Result<FileBytes> bytes = read_file(path);
  const auto files = bytes ? files_in(bytes->text(), folder_of(path)) : std::nullopt;
  if (!files) {
    const fs::path aside = moved_aside(path);
    unknown("and its record is damaged (" + (aside.empty() ? path : aside).string() + ")");
    return found;
  }
  if (!settle(deck, *files, found)) return found;
  remove_own_temporaries(*files, folder_of(path));
  record->end();
  return found;
}

}  // namespace prismesh::mesh::deck
