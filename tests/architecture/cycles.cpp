#include "tests/architecture/cycles.h"

#include <algorithm>

namespace prismesh::architecture {
namespace {

class ComponentSearch {
 public:
  explicit ComponentSearch(const Graph& graph) : graph_(graph) {}

  std::vector<std::string> run() {
    for (const auto& [name, next] : graph_)
      if (!number_.contains(name)) visit(name);
    std::sort(found_.begin(), found_.end());
    return found_;
  }

 private:
  /// Returns the least number that `name` leads back to.
  std::size_t visit(const std::string& name) {
    const std::size_t own = number_.size();
    number_[name] = own;
    std::size_t low = own;
    open_.push_back(name);
    if (const auto next = graph_.find(name); next != graph_.end())
      for (const std::string& to : next->second) {
        if (!number_.contains(to))
          low = std::min(low, visit(to));
        else if (std::find(open_.begin(), open_.end(), to) != open_.end())
          low = std::min(low, number_[to]);
      }
    if (low == own) close(name);
    return low;
  }

  /// Takes the component that begins with `name` off the open names.
  void close(const std::string& name) {
    const auto first = std::find(open_.begin(), open_.end(), name);
    if (open_.end() - first > 1) {
      std::sort(first, open_.end());
      std::string joined;
      for (auto member = first; member != open_.end(); ++member) joined += (joined.empty() ? "" : ", ") + *member;
      found_.push_back(joined);
    }
    open_.erase(first, open_.end());
  }

  const Graph& graph_;
  std::map<std::string, std::size_t> number_;  ///< in the order of the visits
  std::vector<std::string> open_;              ///< visited, and in no component yet
  std::vector<std::string> found_;
};

}  // namespace

std::vector<std::string> cycles(const Graph& graph) { return ComponentSearch(graph).run(); }

}  // namespace prismesh::architecture
