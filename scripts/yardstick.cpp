// Compiled to measure how fast this machine compiles (measure_yardstick in scripts/test.sh). A change here makes all noted figures invalid.
#include <algorithm>
#include <map>
#include <regex>
#include <string>
#include <vector>

int count_words(const std::string& text, std::map<std::string, int>& counts) {
  const std::regex word("[[:alpha:]]+");
  int all = 0;
  for (std::sregex_iterator i(text.begin(), text.end(), word), end; i != end; ++i, ++all) ++counts[i->str()];
  return all;
}

std::vector<std::string> most_frequent(const std::map<std::string, int>& counts) {
  std::vector<std::pair<int, std::string>> order;
  for (const auto& [name, count] : counts) order.emplace_back(count, name);
  std::sort(order.rbegin(), order.rend());
  std::vector<std::string> names;
  for (auto& [count, name] : order) names.push_back(std::move(name));
  return names;
}
