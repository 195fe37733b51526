#include "kiosk/kept_arrangement.h"

#include <algorithm>
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
    read.tab = root["dock"]["tab"].value_or(read.tab);
    const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
    if (!std::ranges::all_of(read.tab, is_letter)) read.tab.clear();
    now_ = kept_ = panels::within_limits(read);
  } catch (const toml::parse_error&) {
    // A file that was cut off costs the arrangement only.
  }
}

void KeptArrangement::keep() {
  if (now_ == kept_ || file_.empty()) return;
  const std::string text = fmt::format(
      "# How the kiosk's panels are arranged: font sizes, and a share of the height.\n[dock]\nwidth = {:.2f}\nupper_share = {:.4f}\n"
      "tab = \"{}\"\n",
      now_.dock_ems, now_.upper_share, now_.tab);
  kept_ = now_;  // also where it fails: this is called for each picture
  const std::array<PendingFile, 1> pending{PendingFile{file_, {text}}};
  (void)replace_files(pending);
}

}  // namespace prismesh::kiosk
