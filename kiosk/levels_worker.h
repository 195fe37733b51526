// Makes levels of detail of the shown model beside the kiosk's loop.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <thread>

#include "kiosk/render/make_levels.h"

namespace prismesh::kiosk {

/// Used by one thread; works on another one.
class LevelsWorker {
 public:
  /// A picture of so many at rest may be too slow while the hand moves something; smaller models are drawn as they are.
  static constexpr std::size_t kFewestShells = 20'000;
  /// A model must have been shown so long: edits in quick succession don't each begin the work anew.
  static constexpr std::int64_t kRestNs = 500'000'000;

  LevelsWorker() = default;
  LevelsWorker(const LevelsWorker&) = delete;
  LevelsWorker& operator=(const LevelsWorker&) = delete;
  ~LevelsWorker();

  /// Call it in each turn of the loop. `shown`: the model; null: none. `wanted`: it has no levels, or they are out of date. Returns levels
  /// that are made, once.
  std::optional<render::MadeLevels> turn(std::int64_t now_ns, const std::shared_ptr<const render::ModelSource>& shown, bool wanted);
  /// When `turn` must be called at the latest; nothing: there is nothing to do.
  std::optional<std::int64_t> next_ns(std::int64_t now_ns) const;

 private:
  void begin(const std::shared_ptr<const render::ModelSource>& source);
  void stop();

  std::thread thread_;
  std::shared_ptr<const render::ModelSource> source_;  ///< released here, not by the thread
  std::atomic<bool> cancelled_ = false;
  std::atomic<bool> done_ = false;
  std::optional<render::MadeLevels> made_;  ///< written before done_
  std::weak_ptr<const render::ModelSource> seen_;
  std::int64_t since_ns_ = 0;
  bool waiting_ = false;
};

}  // namespace prismesh::kiosk
