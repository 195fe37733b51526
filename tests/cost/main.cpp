// Runs each operation once at one size: `cost SHELLS [REGEX]`. Prints its name and peak memory in bytes, tab-separated. Under Callgrind
// (valgrind --tool=callgrind --instr-atstart=no) each operation is a dump of its own with its name; preparing isn't counted.
// `cost --made-with` prints on what the counts depend besides the sources.
#include <gnu/libc-version.h>
#include <sched.h>
#include <stdlib.h>
#include <sys/sysinfo.h>

#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <regex>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "tests/cost/memory.h"
#include "tests/cost/operations.h"
#if __has_include(<valgrind/callgrind.h>)
#include <valgrind/callgrind.h>
#else
#define CALLGRIND_START_INSTRUMENTATION
#define CALLGRIND_STOP_INSTRUMENTATION
#define CALLGRIND_ZERO_STATS
#define CALLGRIND_DUMP_STATS_AT(name) (void)(name)
#endif

// std::thread::hardware_concurrency asks the C library for the machine's processors, whatever this process may run on. Replaced, it makes
// run_tasks do without threads too.
extern "C" int get_nprocs() noexcept { return 1; }

namespace {

/// On one processor TBB makes no threads: what runs where, and so the counts, would change from run to run.
bool stay_on_one_processor() {
  const int processor = ::sched_getcpu();
  cpu_set_t one;
  CPU_ZERO(&one);
  CPU_SET(static_cast<std::size_t>(processor < 0 ? 0 : processor), &one);
  return ::sched_setaffinity(0, sizeof one, &one) == 0;
}

std::size_t threads() {
  std::size_t count = 0;
  for (const auto& thread : std::filesystem::directory_iterator("/proc/self/task")) count += thread.exists() ? 1 : 0;
  return count;
}

void run(const std::filesystem::path& folder, std::size_t shells, const std::regex& wanted) {
  using namespace prismesh::cost;
  const Inputs inputs = make_inputs(folder, shells);
  std::vector<std::pair<const Operation*, Work>> all;
  for (const Operation& operation : operations())
    if (std::regex_search(operation.name, wanted)) all.emplace_back(&operation, operation.prepare(inputs));
  // Switched on once: each switch discards what Valgrind has translated.
  CALLGRIND_START_INSTRUMENTATION;
  for (auto& [operation, work] : all) {
    begin_memory_peak();
    CALLGRIND_ZERO_STATS;
    work();
    CALLGRIND_DUMP_STATS_AT(operation->name.c_str());
    std::cout << operation->name << '\t' << memory_peak_bytes() << '\n';
    work = {};
  }
  CALLGRIND_STOP_INSTRUMENTATION;
}

}  // namespace

int main(int count, char** arguments) {
  if (count == 2 && std::string_view(arguments[1]) == "--made-with") {
    std::cout << "GCC " << __GNUC__ << ", glibc " << ::gnu_get_libc_version() << '\n';
    return 0;
  }
  const long shells = count == 2 || count == 3 ? std::strtol(arguments[1], nullptr, 10) : 0;
  if (shells < 2'000) {
    std::cerr << "cost SHELLS [REGEX]\n";
    return 2;
  }
  if (!stay_on_one_processor() || std::thread::hardware_concurrency() != 1) {
    std::cerr << "cost: it can't be kept on one processor\n";
    return 1;
  }
  std::string folder = (std::filesystem::temp_directory_path() / "prismesh-cost-XXXXXX").string();
  if (::mkdtemp(folder.data()) == nullptr) {
    std::cerr << "cost: there can be no folder in " << std::filesystem::temp_directory_path() << '\n';
    return 1;
  }
  run(folder, static_cast<std::size_t>(shells), std::regex(count == 3 ? arguments[2] : ""));
  std::filesystem::remove_all(folder);
  if (threads() == 1) return 0;
  std::cerr << "cost: " << threads() << " threads; counts repeat with one only\n";
  return 1;
}
