#include "kiosk/kept_arrangement.h"

#include <array>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "base/file.h"

namespace prismesh::kiosk {

KeptArrangement::KeptArrangement(std::filesystem::path file) : file_(std::move(file)) {
  if (file_.empty()) return;
  const Result<FileBytes> bytes = read_file(file_);
  if (!bytes) return;
  try {
    const toml::table root = toml::parse(bytes->text());
    panels::Arrangement read;
    read.dock_ems = root["dock"]["width"].value_or(read.dock_ems);
    read.upper_share = root["dock"]["upper_share"].value_or(read.upper_share);
    now_ = kept_ = panels::within_limits(read);
  } catch (const toml::parse_error&) {
    // A file that was cut off costs the arrangement only.
  }
}

void KeptArrangement::keep() {
  if (now_ == kept_ || file_.empty()) return;
  const std::string text = fmt::format(
      "# How the kiosk's panels are arranged: font sizes, and a share of the height.\n[dock]\nwidth = {:.2f}\nupper_share = {:.4f}\n",
      now_.dock_ems, now_.upper_share);
  kept_ = now_;  // also where it fails: this is called for each picture
  const std::array<PendingFile, 1> pending{PendingFile{file_, {text}}};
  (void)replace_files(pending);
}

}  // namespace prismesh::kiosk
