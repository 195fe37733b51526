#include "tests/architecture/include_rules.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>

namespace prismesh::architecture {
namespace {

using Modules = std::set<std::string, std::less<>>;

/// What each module of mesh/ stands on directly; what those stand on follows.
const std::map<std::string, Modules, std::less<>>& mesh_modules() {
  static const std::map<std::string, Modules, std::less<>> kModules{
      {"mesh/model", {}},
      {"mesh/deck", {"mesh/model"}},
      {"mesh/spatial", {"mesh/model"}},
      {"mesh/quality", {"mesh/spatial"}},
      {"mesh/select", {"mesh/spatial"}},
      {"mesh/shape", {"mesh/spatial"}},
      {"mesh/relax", {"mesh/quality"}},
      {"mesh/repair", {"mesh/relax"}},
      {"mesh/contact", {"mesh/repair"}},
      {"mesh/document", {"mesh/deck", "mesh/quality", "mesh/select", "mesh/shape", "mesh/contact"}},
  };
  return kModules;
}

bool mesh_stands_on(std::string_view from, std::string_view to) {
  const auto found = mesh_modules().find(from);
  if (found == mesh_modules().end()) return false;
  return std::any_of(found->second.begin(), found->second.end(),
                     [&](const std::string& below) { return below == to || mesh_stands_on(below, to); });
}

/// The layer a module is on: "mesh/deck" -> "mesh".
std::string_view layer_of(std::string_view module) { return module.substr(0, module.find('/')); }

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

}  // namespace

std::string module_of(std::string_view path) {
  constexpr std::array kLayers{"base", "mesh", "drivers", "ipc", "daemon", "kiosk", "cli", "tests"};
  const std::string_view layer = layer_of(path);
  if (path.starts_with("tests/viewer/")) return "tests/viewer";
  if (layer == path || std::find(kLayers.begin(), kLayers.end(), layer) == kLayers.end()) return {};
  if (layer != "mesh" && layer != "daemon") return std::string(layer);
  const std::size_t second = path.find('/', layer.size() + 1);
  return std::string(path.substr(0, second));
}

bool may_include(std::string_view from, std::string_view to) {
  if (from == to || from == "tests") return true;
  const std::string_view layer = layer_of(from), other = layer_of(to);
  if (other == "base") return true;
  if (from == "tests/viewer") return false;  // it judges what the others draw
  if (layer == "mesh") return mesh_stands_on(from, to);
  if (layer == "ipc") return other == "mesh" || other == "drivers";
  if (layer == "kiosk" || layer == "cli" || layer == "daemon") return other == "ipc" || other == "mesh" || other == "drivers";
  return false;
}

std::vector<std::string> include_violations(std::string_view path, std::string_view text) {
  std::vector<std::string> violations;
  const std::string from = module_of(path);
  long number = 0;
  while (!text.empty()) {
    ++number;
    const std::size_t end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
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

}  // namespace prismesh::architecture
