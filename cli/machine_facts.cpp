#include "cli/machine_facts.h"

#include <algorithm>
#include <fstream>
#include <string>
#include <thread>

namespace prismesh::cli {

namespace {

/// The first "model name" of /proc/cpuinfo; not every architecture has one.
std::string processor_name() {
  std::ifstream lines("/proc/cpuinfo");
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("model name")) continue;
    const std::size_t begin = line.find_first_not_of(" \t", line.find(':') + 1);
    return begin == std::string::npos ? "" : line.substr(begin);
  }
  return "";
}

}  // namespace

MachineFacts machine_facts() { return {std::max<std::size_t>(std::thread::hardware_concurrency(), 1), processor_name()}; }

}  // namespace prismesh::cli
