#include "kiosk/tools/files/report_writer.h"

#include <cerrno>
#include <cstdlib>
#include <string_view>
#include <system_error>
#include <utility>

#include <sys/wait.h>
#include <unistd.h>

#include "base/child_process.h"

namespace prismesh::kiosk::tools::files {

namespace fs = std::filesystem;

fs::path report_page(const fs::path& deck, const fs::path& home) {
  const fs::path beside = deck.parent_path();
  const fs::path folder = home.empty() || ::access(beside.c_str(), W_OK) == 0 ? beside : home;
  const std::string name = deck.stem().string() + "-report";
  fs::path page = folder / (name + ".html");
  std::error_code ignored;
  for (int number = 2; fs::exists(page, ignored); ++number) page = folder / (name + "-" + std::to_string(number) + ".html");
  return page;
}

ReportWriter::~ReportWriter() {
  std::error_code ignored;
  if (!said_.empty()) fs::remove(said_, ignored);
}

Result<void> ReportWriter::begin(const fs::path& program, const fs::path& runtime_folder, fs::path page) {
  if (writes()) return fail(page_.string(), "is still being written");
  std::error_code missing;
  std::string said = (fs::temp_directory_path(missing) / "prismesh-report-XXXXXX").string();
  const int file = missing ? -1 : ::mkstemp(said.data());
  if (file < 0) return fail(page.string(), "can't be written: there is no folder for temporary files");
  ::close(file);
  said_ = said;
  page_ = std::move(page);
  const Result<pid_t> child = start_program(
      {program.string(), "session", "report", "--runtime-dir", runtime_folder.string(), "-o", page_.string()}, "/dev/null", said_);
  if (!child) return fail(child.error());
  child_ = *child;
  return {};
}

std::optional<ReportWriter::Outcome> ReportWriter::look() {
  if (!writes()) return std::nullopt;
  int status = 0;
  const pid_t ended = ::waitpid(child_, &status, WNOHANG);
  if (ended == 0 || (ended < 0 && errno == EINTR)) return std::nullopt;
  child_ = 0;
  const std::string said = last_line(said_);
  std::error_code ignored;
  fs::remove(std::exchange(said_, {}), ignored);
  if (const auto failed = ended < 0 ? std::optional<std::string>("was lost") : failure_words(status))
    return Outcome{false, "No report: " + (said.empty() ? "prismesh " + *failed : said)};
  const bool lacks = said.find("a picture is missing") != std::string::npos;
  return Outcome{true, "The report is in " + page_.string() + (lacks ? ", without pictures: " + said : "")};
}

}  // namespace prismesh::kiosk::tools::files
