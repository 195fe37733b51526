#include "kiosk/tools/find/find_commands.h"

#include <algorithm>
#include <array>
#include <utility>

#include "base/letter_case.h"

namespace prismesh::kiosk::tools::find {
namespace {

/// What engineers call a command that names itself otherwise: words of other programs, and a word of the command that is meant.
struct OtherName {
  std::string_view word, meaning;
};
constexpr std::array<OtherName, 16> kOtherNames{{{"rotate", "turn about"},
                                                 {"translate", "how far to lift"},
                                                 {"move", "how far to lift"},
                                                 {"morph", "pulls fade out"},
                                                 {"radius", "pulls fade out"},
                                                 {"symmetry", "mirror the pull"},
                                                 {"penetration", "parts cross"},
                                                 {"intersection", "parts cross"},
                                                 {"smooth", "relax"},
                                                 {"fix", "repair"},
                                                 {"isolate", "show only"},
                                                 {"blank", "hide the part"},
                                                 {"unblank", "show all parts"},
                                                 {"zoom", "fit the"},
                                                 {"stereo", "display profile"},
                                                 {"diff", "compare"}}};

/// The other names of a command, as text.
std::string other_names(std::string_view meaning) {
  std::string names;
  for (const OtherName& other : kOtherNames)
    if (meaning.find(other.meaning) != std::string_view::npos) names.append("  ").append(other.word);
  return names;
}

bool is_letter_or_digit(char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || (c & 0x80) != 0; }

}  // namespace

double fit_of(std::string_view words, std::string_view text) {
  const std::string all = lower(text), wanted = lower(words);
  double fit = 1;
  std::size_t at = 0;
  while (at < wanted.size()) {
    const std::size_t begin = wanted.find_first_not_of(' ', at);
    if (begin == std::string::npos) break;
    const std::size_t end = std::min(wanted.find(' ', begin), wanted.size());
    const std::string_view word = std::string_view(wanted).substr(begin, end - begin);
    at = end;
    double best = 0;
    for (std::size_t found = all.find(word); found != std::string::npos; found = all.find(word, found + 1)) {
      const bool begins_word = found == 0 || !is_letter_or_digit(all[found - 1]);
      const bool ends_word = found + word.size() == all.size() || !is_letter_or_digit(all[found + word.size()]);
      best = std::max(best, found == 0 ? 4.0 : begins_word ? 2.0 + (ends_word ? 1.0 : 0.0) : 0.5);
    }
    if (best == 0) return 0;
    fit += best;
  }
  // The words as they stand, one after the other.
  const std::size_t phrase = at > 0 ? all.find(wanted) : std::string::npos;
  if (phrase != std::string::npos) fit += 1 + static_cast<double>(wanted.size()) / static_cast<double>(all.size()) + (phrase == 0 ? 1 : 0);
  return fit;
}

std::vector<std::size_t> find_commands(std::string_view words, std::span<const input::KeyBinding> commands,
                                       std::span<const std::string> earlier, std::size_t limit) {
  std::vector<std::pair<double, std::size_t>> ranked;
  const bool all = words.find_first_not_of(' ') == std::string_view::npos;
  for (std::size_t i = 0; i < commands.size(); ++i) {
    const input::KeyBinding& command = commands[i];
    const auto used = std::ranges::find(earlier, command.meaning);
    // What was used before comes a little earlier than its like.
    const double recent =
        used == earlier.end() ? 0 : 0.9 * static_cast<double>(used - earlier.begin() + 1) / static_cast<double>(earlier.size());
    const std::string_view menu = input::kMenuNames[static_cast<std::size_t>(command.menu)];
    std::string text(command.meaning);
    text.append("  ").append(menu).append("  ").append(command.label).append(other_names(command.meaning));
    const double fit = all ? 1 : fit_of(words, text);
    if (fit > 0) ranked.emplace_back(fit + recent, i);
  }
  std::ranges::stable_sort(ranked, [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<std::size_t> found;
  for (const auto& [fit, i] : ranked)
    if (found.size() < limit) found.push_back(i);
  return found;
}

}  // namespace prismesh::kiosk::tools::find
