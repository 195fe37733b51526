// Has the command line write a page about what the open document changes, in a process of its own.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <sys/types.h>

#include "base/error.h"

namespace prismesh::kiosk::tools::files {

/// Where the page about a deck goes: beside the deck, or into `home` where nothing can be written beside it; under a name that isn't taken.
/// `home` empty: always beside the deck.
std::filesystem::path report_page(const std::filesystem::path& deck, const std::filesystem::path& home);

class ReportWriter {
 public:
  /// What came of a page.
  struct Outcome {
    bool is_written = false;
    std::string words;  ///< where it is, or why there is none
  };

  ReportWriter() = default;
  ReportWriter(const ReportWriter&) = delete;
  ReportWriter& operator=(const ReportWriter&) = delete;
  /// A page that is being written is finished without it.
  ~ReportWriter();

  /// Begins to write. `program`: the command line; `runtime_folder`: of modeld's socket. Errors: it can't be started; one is being written.
  Result<void> begin(const std::filesystem::path& program, const std::filesystem::path& runtime_folder, std::filesystem::path page);
  bool writes() const { return child_ != 0; }
  /// What came of it, once after it has ended.
  std::optional<Outcome> look();

 private:
  pid_t child_ = 0;  ///< 0: none
  std::filesystem::path page_;
  std::filesystem::path said_;  ///< what the program writes to its standard error
};

}  // namespace prismesh::kiosk::tools::files
