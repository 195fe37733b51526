// Checks the PIN that opens an exhibition, and makes those who guess wait.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace prismesh::kiosk::tools::exhibition {

/// Wrong PINs, and until when no other is tried. Plain data.
struct PinTries {
  int wrong = 0;             ///< since the last right one
  std::int64_t until_s = 0;  ///< seconds since 1970; 0: at once
  bool operator==(const PinTries&) const = default;
};
/// After so many wrong ones each further one makes wait: 30 s, and twice as long each time up to an hour.
inline constexpr int kFreeTries = 3;
PinTries after_wrong(const PinTries& before, std::int64_t now_s);
/// Seconds until the next try; never more than an hour, whatever the clock did meanwhile.
std::int64_t wait_s(const PinTries& tries, std::int64_t now_s);

/// Whether a PIN is that of a hash as crypt(3) writes it: "$6$..", "$y$..". False for an empty or unknown hash. Costs some 10 to 100 ms.
bool pin_matches(const std::string& pin, const std::string& hash);

/// Tries survive the program in a file; without one (empty path) they last as long as the program.
class PinGate {
 public:
  PinGate(std::string hash, std::filesystem::path file);

  /// Whether there is a way in at all.
  bool has_pin() const { return !hash_.empty(); }
  std::int64_t wait_s(std::int64_t now_s) const { return exhibition::wait_s(tries_, now_s); }
  /// False while one has to wait, whatever the PIN.
  bool try_pin(const std::string& pin, std::int64_t now_s);

 private:
  void keep();

  std::string hash_;
  std::filesystem::path file_;
  PinTries tries_;
};

}  // namespace prismesh::kiosk::tools::exhibition
