#include "mesh/report/line_diff.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

namespace prismesh::mesh::report {

namespace {

using Lines = std::vector<std::string_view>;

Lines split(std::string_view text) {
  Lines lines;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::size_t length = end == std::string_view::npos ? text.size() : end + 1;
    lines.push_back(text.substr(0, length));
    text.remove_prefix(length);
  }
  return lines;
}

/// Positions in a and b.
using Match = std::pair<std::size_t, std::size_t>;

/// Lines that occur once on each side, ascending in a.
std::vector<Match> unique_matches(std::span<const std::string_view> a, std::span<const std::string_view> b) {
  struct Seen {
    std::size_t in_a = 0, in_b = 0, at_b = 0;
  };
  std::unordered_map<std::string_view, Seen> seen;
  seen.reserve(a.size() + b.size());
  for (const std::string_view line : a) ++seen[line].in_a;
  for (std::size_t i = 0; i < b.size(); ++i) {
    Seen& s = seen[b[i]];
    ++s.in_b;
    s.at_b = i;
  }
  std::vector<Match> matches;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (const Seen& s = seen[a[i]]; s.in_a == 1 && s.in_b == 1) matches.emplace_back(i, s.at_b);
  return matches;
}

/// The longest subsequence of the matches whose lines ascend in b too.
std::vector<Match> longest_increasing_subsequence(const std::vector<Match>& matches) {
  constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  std::vector<std::size_t> pile_top, before(matches.size(), kNone);
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const auto pile = std::lower_bound(pile_top.begin(), pile_top.end(), matches[i].second,
                                       [&](std::size_t top, std::size_t at) { return matches[top].second < at; });
    if (pile != pile_top.begin()) before[i] = *(pile - 1);
    if (pile == pile_top.end())
      pile_top.push_back(i);
    else
      *pile = i;
  }
  std::vector<Match> subsequence;
  for (std::size_t i = pile_top.empty() ? kNone : pile_top.back(); i != kNone; i = before[i]) subsequence.push_back(matches[i]);
  std::reverse(subsequence.begin(), subsequence.end());
  return subsequence;
}

std::size_t changes(std::span<const std::string_view> a, std::span<const std::string_view> b) {
  while (!a.empty() && !b.empty() && a.front() == b.front()) a = a.subspan(1), b = b.subspan(1);
  while (!a.empty() && !b.empty() && a.back() == b.back()) a = a.first(a.size() - 1), b = b.first(b.size() - 1);
  if (a.empty() || b.empty()) return a.size() + b.size();
  const std::vector<Match> anchors = longest_increasing_subsequence(unique_matches(a, b));
  if (anchors.empty()) {
    std::size_t count = std::max(a.size(), b.size()) - std::min(a.size(), b.size());
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) count += a[i] != b[i];
    return count;
  }
  std::size_t count = 0;
  Match from = {0, 0};
  for (const Match& anchor : anchors) {
    count += changes(a.subspan(from.first, anchor.first - from.first), b.subspan(from.second, anchor.second - from.second));
    from = {anchor.first + 1, anchor.second + 1};
  }
  return count + changes(a.subspan(from.first), b.subspan(from.second));
}

}  // namespace

std::size_t lines_changed(std::string_view a, std::string_view b) {
  if (a == b) return 0;
  return changes(split(a), split(b));
}

}  // namespace prismesh::mesh::report
