// Pairs of shells, found by a shell and replaced about some. Private to mesh/contact.
#pragma once

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include "mesh/model/index.h"

namespace prismesh::mesh::contact {

/// `Pair` has the shells `a` and `b`.
template <class Pair>
class PairPool {
 public:
  void add(Pair pair) {
    std::uint32_t number = 0;
    if (free_.empty()) {
      number = static_cast<std::uint32_t>(pairs_.size());
      pairs_.push_back(std::move(pair));
    } else {
      number = free_.back();
      free_.pop_back();
      pairs_[number] = std::move(pair);
    }
    for (const ShellIndex shell : {pairs_[number].a, pairs_[number].b}) of_shell_[shell.value].push_back(number);
  }

  /// Takes all pairs of a shell away.
  void remove_of(ShellIndex shell) {
    const auto found = of_shell_.find(shell.value);
    if (found == of_shell_.end()) return;
    for (const std::uint32_t number : found->second) {
      const Pair& pair = pairs_[number];
      const auto other = of_shell_.find((pair.a == shell ? pair.b : pair.a).value);
      std::erase(other->second, number);
      if (other->second.empty()) of_shell_.erase(other);
      free_.push_back(number);
    }
    of_shell_.erase(shell.value);
  }

  /// Calls `visit(std::uint32_t number, const Pair&)` for each pair of a shell. A number stands for one pair until it is removed.
  template <class Visit>
  void each_of(ShellIndex shell, Visit&& visit) const {
    const auto found = of_shell_.find(shell.value);
    if (found == of_shell_.end()) return;
    for (const std::uint32_t number : found->second) visit(number, pairs_[number]);
  }

  std::size_t numbers() const { return pairs_.size(); }  ///< all numbers are below

 private:
  std::vector<Pair> pairs_;
  std::vector<std::uint32_t> free_;
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> of_shell_;
};

}  // namespace prismesh::mesh::contact
