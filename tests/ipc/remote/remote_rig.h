// A station of our own with its paired client, and decks to send.
#pragma once

#include <fstream>
#include <map>
#include <random>

#include <gmock/gmock.h>

#include "ipc/remote/pull.h"
#include "ipc/remote/push.h"
#include "tests/daemon/intake/intake_rig.h"
#include "tests/ipc/remote/cutting_line.h"

namespace prismesh::ipc::remote {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using FileTexts = std::map<std::string, std::string>;

class Remote : public ::testing::Test {
 protected:
  static constexpr std::size_t kChunk = 65'536;

  fs::path folder() const { return rig_.root(); }
  StationBook book() const {
    Result<StationBook> opened = StationBook::open(folder() / "book");
    EXPECT_TRUE(opened) << opened.error().text();
    return std::move(*opened);
  }
  PairedStation station(std::uint16_t port = 0) const {
    PairedStation paired;
    paired.address = {"127.0.0.1", port == 0 ? rig_.intake->port() : port};
    paired.name = paired.address.text();
    paired.fingerprint = rig_.intake->fingerprint();
    paired.token = token_;
    paired.token_name = "ann";
    return paired;
  }

  /// Writes the files beneath a folder of their own.
  std::vector<LocalFile> write(const FileTexts& texts) const {
    std::vector<LocalFile> files;
    for (const auto& [path, text] : texts) {
      const fs::path disk = folder() / "sent" / path;
      fs::create_directories(disk.parent_path());
      std::ofstream(disk, std::ios::binary) << text;
      files.push_back({disk, path});
    }
    return files;
  }
  static FileTexts texts_in(const fs::path& folder) {
    FileTexts texts;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      if (!entry.is_regular_file()) continue;
      std::ifstream in(entry.path(), std::ios::binary);
      texts[fs::relative(entry.path(), folder).string()] = {std::istreambuf_iterator<char>(in), {}};
    }
    return texts;
  }
  static std::string noise(std::size_t bytes, unsigned seed) {
    std::mt19937_64 random(seed);
    std::string text(bytes, '\0');
    for (char& c : text) c = static_cast<char>(random());
    return text;
  }

  PushOptions push_options() const {
    PushOptions options;
    options.chunk_bytes = kChunk;
    options.remote.first_pause = std::chrono::milliseconds(1);
    return options;
  }
  PullOptions pull_options(const std::string& to) const {
    PullOptions options;
    options.folder = folder() / to;
    options.remote.first_pause = std::chrono::milliseconds(1);
    return options;
  }

  intake::IntakeRig rig_;
  std::string token_ = rig_.token("ann", intake::Scopes::all());
};

}  // namespace prismesh::ipc::remote
