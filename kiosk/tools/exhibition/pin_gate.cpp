#include "kiosk/tools/exhibition/pin_gate.h"

#include <crypt.h>
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <memory>

namespace prismesh::kiosk::tools::exhibition {

namespace {

constexpr std::int64_t kFirstWait = 30, kLongestWait = 3600;

PinTries read_tries(const std::filesystem::path& file) {
  PinTries tries;
  std::ifstream in(file);
  // A file that says anything else counts as one that isn't there: it is in the kiosk's own folder.
  if (PinTries read; in >> read.wrong >> read.until_s && read.wrong >= 0) tries = read;
  return tries;
}

/// What this program knows of the tries in a file.
PinTries& remembered(const std::filesystem::path& file) {
  static std::map<std::filesystem::path, PinTries> all;
  return all[file];
}

}  // namespace

PinTries after_wrong(const PinTries& before, std::int64_t now_s) {
  PinTries tries{std::min(before.wrong, 1000) + 1, 0};
  if (tries.wrong < kFreeTries) return tries;
  const int doublings = std::min(tries.wrong - kFreeTries, 20);
  tries.until_s = now_s + std::min(kFirstWait << doublings, kLongestWait);
  return tries;
}

std::int64_t wait_s(const PinTries& tries, std::int64_t now_s) {
  return tries.until_s == 0 ? 0 : std::clamp<std::int64_t>(tries.until_s - now_s, 0, kLongestWait);
}

bool pin_matches(const std::string& pin, const std::string& hash) {
  if (pin.empty() || hash.size() < 4 || hash[0] != '$') return false;
  const auto work = std::make_unique<crypt_data>();
  const char* made = ::crypt_r(pin.c_str(), hash.c_str(), work.get());
  return made != nullptr && made[0] == '$' && hash == made;
}

PinGate::PinGate(std::string hash, std::filesystem::path file) : hash_(std::move(hash)), file_(std::move(file)), tries_(remembered(file_)) {
  const PinTries read = file_.empty() ? PinTries() : read_tries(file_);
  if (read.until_s > tries_.until_s || read.wrong > tries_.wrong) tries_ = read;
}

bool PinGate::try_pin(const std::string& pin, std::int64_t now_s) {
  if (!has_pin() || wait_s(now_s) > 0) return false;
  const bool right = pin_matches(pin, hash_);
  // Written before the answer is known to anybody: who pulls the plug after each guess waits all the same.
  tries_ = right ? PinTries() : after_wrong(tries_, now_s);
  keep();
  return right;
}

/// A new file takes the old one's place once it is on the disk: it is never half one. Where it can't be written, the program remembers.
void PinGate::keep() {
  remembered(file_) = tries_;
  if (file_.empty()) return;
  std::error_code ignored;
  std::filesystem::create_directories(file_.parent_path(), ignored);
  const std::filesystem::path next = file_.string() + ".new";
  const std::string text = std::to_string(tries_.wrong) + ' ' + std::to_string(tries_.until_s) + '\n';
  const int file = ::open(next.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  if (file < 0) return;
  const bool written = ::write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size()) && ::fsync(file) == 0;
  ::close(file);
  if (!written) return;
  std::filesystem::rename(next, file_, ignored);
  if (const int folder = ::open(file_.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); folder >= 0) {
    ::fsync(folder);
    ::close(folder);
  }
}

}  // namespace prismesh::kiosk::tools::exhibition
