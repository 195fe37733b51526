// Tells the progress of writing cards one by one.
#pragma once

#include <cstddef>

#include "base/progress.h"

namespace prismesh::mesh::deck {

class CardProgress {
 public:
  /// `progress` must outlive this and may be empty. `cards`: how many will be written in all.
  CardProgress(const Progress& progress, std::size_t cards) : progress_(progress), cards_(cards) {}

  /// Called before each card. False: the work is to stop.
  bool next_card() {
    if (!progress_ || written_++ % kCardsBetweenCalls != 0) return true;
    return progress_(static_cast<double>(written_ - 1) / static_cast<double>(cards_));
  }

 private:
  static constexpr std::size_t kCardsBetweenCalls = 4096;

  const Progress& progress_;
  std::size_t cards_ = 0;
  std::size_t written_ = 0;
};

}  // namespace prismesh::mesh::deck
