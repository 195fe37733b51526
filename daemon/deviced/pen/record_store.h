// Keeps the safety's state on disk, so that a latch outlives a crash. For the main thread: it waits for the disk.
#pragma once

#include <filesystem>
#include <string>

#include "base/error.h"
#include "drivers/haptics/safety.h"

namespace prismesh::deviced::pen {

/// One line, "latched late_tick".
std::string record_text(const drivers::haptics::SafetyRecord& record);
/// A text that can't be read says that the program ended while armed: nobody knows better.
drivers::haptics::SafetyRecord parse_record(std::string_view text);

class RecordStore {
 public:
  /// Reads the folder's file `pen-safety`; without one the pen is disarmed.
  explicit RecordStore(const std::filesystem::path& folder);
  /// As last stored or read.
  const drivers::haptics::SafetyRecord& stored() const { return stored_; }
  /// Writes it and waits until it is on disk; does nothing if phase and fault are the stored ones. Errors: of the file.
  Result<void> store(const drivers::haptics::SafetyRecord& record);

 private:
  std::filesystem::path file_;
  drivers::haptics::SafetyRecord stored_;
};

}  // namespace prismesh::deviced::pen
