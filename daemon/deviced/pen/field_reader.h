// Copies the newest haptic field out of another process's shared memory, in a thread of its own, so that the tick reads memory that nobody
// else writes and that never changes while it is read.
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "base/haptic_field.h"
#include "ipc/pen/haptic_field_page.h"

namespace prismesh::deviced::pen {

struct FieldCopy {
  HapticField field;
  HapticGuides guides;
  HapticResistance resistance;
  bool has_field = false, has_guides = false, has_resistance = false;
};

class FieldReader {
 public:
  FieldReader();
  ~FieldReader() = default;
  FieldReader(const FieldReader&) = delete;
  FieldReader& operator=(const FieldReader&) = delete;

  /// Reads this page from now on. What was read last stays valid, with its age, until the new page has a field.
  void attach(ipc::HapticFieldPageReader page);

  /// The newest copy; null: none yet. Valid until the next call. For one thread; neither locks nor allocates.
  const FieldCopy* acquire();

 private:
  void run(const std::stop_token& stop);
  bool copy_newest();

  std::mutex mutex_;  ///< of the page; the tick takes no part in it
  std::optional<ipc::HapticFieldPageReader> page_;
  std::uint64_t copied_ = 0;
  // Three copies: one that the tick reads, one that is written, one between them.
  static constexpr unsigned kFresh = 4;
  std::array<std::unique_ptr<FieldCopy>, 3> copies_;
  unsigned front_ = 0, back_ = 1;
  bool any_ = false;
  std::atomic<unsigned> middle_ = 2;
  std::jthread thread_;  ///< last member: the others must exist as long as it runs
};

}  // namespace prismesh::deviced::pen
