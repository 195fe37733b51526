#include "daemon/deviced/pen/record_store.h"

#include <array>
#include <system_error>

#include "base/file.h"
#include "drivers/haptics/safety_words.h"

namespace prismesh::deviced::pen {

using drivers::haptics::SafetyFault;
using drivers::haptics::SafetyPhase;
using drivers::haptics::SafetyRecord;

std::string record_text(const SafetyRecord& record) {
  return std::string(phase_name(record.phase)) + " " + std::string(fault_name(record.fault)) + "\n";
}

SafetyRecord parse_record(std::string_view text) {
  for (const SafetyPhase phase : {SafetyPhase::disarmed, SafetyPhase::armed, SafetyPhase::latched})
    for (std::uint32_t fault = 0; fault <= static_cast<std::uint32_t>(SafetyFault::died_armed); ++fault) {
      const SafetyRecord record{phase, static_cast<SafetyFault>(fault), 0};
      if (text == record_text(record)) return record;
    }
  return {SafetyPhase::latched, SafetyFault::died_armed, 0};
}

RecordStore::RecordStore(const std::filesystem::path& folder) : file_(folder / "pen-safety") {
  std::error_code problem;
  if (const auto status = std::filesystem::status(file_, problem); status.type() == std::filesystem::file_type::not_found) return;
  const Result<FileBytes> bytes = read_file(file_);
  stored_ = parse_record(bytes ? bytes->text() : std::string_view());
}

Result<void> RecordStore::store(const SafetyRecord& record) {
  if (record.phase == stored_.phase && record.fault == stored_.fault) return {};
  const std::string text = record_text(record);
  const std::array<PendingFile, 1> file{PendingFile{file_, {text}}};
  if (Result<void> written = replace_files(file); !written) return written;
  stored_ = record;
  return {};
}

}  // namespace prismesh::deviced::pen
