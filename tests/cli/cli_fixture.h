// A folder for a test, small decks in it, and the command line called in it.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cli/run.h"

namespace prismesh::cli {

using ::testing::HasSubstr;
using ::testing::StartsWith;

struct Outcome {
  int status = 0;
  std::string out;
  std::string err;

  nlohmann::json json() const { return nlohmann::json::parse(out); }
};

inline Outcome prismesh(const std::vector<std::string>& args) {
  std::ostringstream out, err;
  const int status = run(args, out, err);
  return {status, out.str(), err.str()};
}

inline std::string read(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Card of a node in the standard columns.
inline std::string node_card(int id, double x, double y, double z) {
  char text[96];
  std::snprintf(text, sizeof text, "%8d%16.6f%16.6f%16.6f\n", id, x, y, z);
  return text;
}
inline std::string shell_card(int id, int part, int a, int b, int c, int d) {
  char text[96];
  std::snprintf(text, sizeof text, "%8d%8d%8d%8d%8d%8d\n", id, part, a, b, c, d);
  return text;
}

class Cli : public ::testing::Test {
 protected:
  void SetUp() override {
    folder = std::filesystem::temp_directory_path() / ("prismesh-cli-" + std::to_string(std::random_device{}()));
    std::filesystem::create_directories(folder);
  }
  void TearDown() override { std::filesystem::remove_all(folder); }

  std::string path(const std::string& name) const { return (folder / name).string(); }
  std::string write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((folder / name).parent_path());
    std::ofstream(folder / name, std::ios::binary) << text;
    return path(name);
  }
  bool exists(const std::string& name) const { return std::filesystem::exists(folder / name); }

  /// Everything in the folder, to see that nothing was left.
  std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
      all.push_back(std::filesystem::relative(entry.path(), folder).string());
    std::sort(all.begin(), all.end());
    return all;
  }

  /// A plate of 6 x 4 quads of 5 mm in part 7 (steel, 1.2 mm): nodes 101.., row by row, shells 1001.. .
  static std::string plate_text() {
    std::string text = "*KEYWORD\n$ a plate\n*NODE\n";
    for (int j = 0; j <= 4; ++j)
      for (int i = 0; i <= 6; ++i) text += node_card(101 + j * 7 + i, 5 * i, 5 * j, 0);
    text += "*ELEMENT_SHELL\n";
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 6; ++i) {
        const int a = 101 + j * 7 + i;
        text += shell_card(1001 + j * 6 + i, 7, a, a + 1, a + 8, a + 7);
      }
    text +=
        "*PART\nplate\n         7         3         2\n*SECTION_SHELL\n         3         2\n       1.2       1.2       1.2       1.2\n";
    text += "*MAT_ELASTIC\n         2  7.850E-9    210000       0.3\n*END\n";
    return text;
  }

  std::filesystem::path folder;
};

}  // namespace prismesh::cli
