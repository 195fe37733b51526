#include "tests/architecture/include_rules.h"

#include <algorithm>
#include <array>
#include <set>

#include "tests/architecture/cycles.h"
#include "tests/architecture/modules.h"

namespace prismesh::architecture {
namespace {

/// Whether a module uses another, directly or through others.
bool uses(std::string_view from, std::string_view to) {
  const auto found = std::find_if(modules().begin(), modules().end(), [&](const Module& module) { return module.folder == from; });
  return found != modules().end() &&
         std::any_of(found->uses.begin(), found->uses.end(), [&](const std::string& used) { return used == to || uses(used, to); });
}

/// "mesh/deck" -> "mesh".
std::string_view layer_of(std::string_view path) { return path.substr(0, path.find('/')); }

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  return first == std::string_view::npos ? std::string_view() : text.substr(first);
}

/// The file that a line includes; empty for every other line.
std::string_view included_file(std::string_view line) {
  line = trimmed(line);
  if (!line.starts_with('#')) return {};
  line = trimmed(line.substr(1));
  if (!line.starts_with("include")) return {};
  line = trimmed(line.substr(7));
  if (line.empty() || (line[0] != '"' && line[0] != '<')) return {};
  const std::size_t end = line.find(line[0] == '"' ? '"' : '>', 1);
  return end == std::string_view::npos ? std::string_view() : line.substr(1, end - 1);
}

bool is_quoted(std::string_view line) { return line.find('"') != std::string_view::npos; }

/// Takes the first line off a text.
std::string_view take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return line;
}

/// "mesh/deck/save.cpp" -> "mesh/deck/save".
std::string pair_of(std::string_view path) { return std::string(path.substr(0, path.rfind('.'))); }

}  // namespace

std::string module_of(std::string_view path) {
  constexpr std::array kLayers{"base", "mesh", "drivers", "ipc", "daemon", "kiosk", "cli", "python", "tests"};
  const std::string_view layer = layer_of(path);
  if (layer == path || std::find(kLayers.begin(), kLayers.end(), layer) == kLayers.end()) return {};
  if (path.starts_with("tests/viewer/")) return "tests/viewer";
  if (layer == "tests") return "tests";
  return std::string(path.substr(0, path.rfind('/')));
}

bool may_include(std::string_view from, std::string_view to) {
  if (from == to || from == "tests") return true;
  if (from == "tests/viewer") return to == "base";  // it judges what the others draw
  return uses(from, to);
}

std::vector<std::string> include_violations(std::string_view path, std::string_view text) {
  std::vector<std::string> violations;
  const std::string from = module_of(path);
  long number = 0;
  while (!text.empty()) {
    ++number;
    const std::string_view line = take_line(text);
    const std::string_view file = included_file(line);
    if (file.empty()) continue;
    const std::string to = module_of(file);
    const std::string where = std::string(path) + ":" + std::to_string(number) + ": ";
    if (to.empty() && is_quoted(line))
      violations.push_back(where + "\"" + std::string(file) + "\" isn't written from the project's root");
    else if (!to.empty() && !may_include(from, to))
      violations.push_back(where + from + " must not include " + to + " (" + std::string(file) + ")");
  }
  return violations;
}

std::vector<std::string> pair_cycles(const std::vector<SourceText>& sources) {
  std::set<std::string> pairs;
  for (const SourceText& source : sources) pairs.insert(pair_of(source.path));
  Graph graph;
  for (const SourceText& source : sources) {
    const std::string pair = pair_of(source.path);
    std::string_view text = source.text;
    while (!text.empty()) {
      const std::string included = pair_of(included_file(take_line(text)));
      if (included != pair && pairs.contains(included)) graph[pair].insert(included);
    }
  }
  return cycles(graph);
}

}  // namespace prismesh::architecture
