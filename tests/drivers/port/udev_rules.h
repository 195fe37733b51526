// Parses and applies udev's rules language as far as this project's rules use it. Strict. After udev(7).
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace prismesh::drivers::port {

/// KEY{attribute} operator "value"
struct UdevToken {
  std::string key, attribute, operation, value;
};
struct UdevRule {
  int line = 0;
  std::vector<UdevToken> tokens;
};
struct UdevRules {
  std::vector<UdevRule> rules;
  std::vector<std::string> problems;  ///< "line: problem"; empty if there is none
};

/// Problems: text that isn't a token, an unknown key, an operator or attribute that the key doesn't accept, an unknown substitution, a GOTO
/// without a later label, a duplicate label, an invalid mode, a rule without effect.
UdevRules read_udev_rules(std::string_view text);

/// A device and its parents, nearest first; the first is the one that the event is about.
struct UdevDevice {
  std::string subsystem, driver;
  std::map<std::string, std::string> attributes, properties;
};

struct UdevResult {
  std::string group, mode;
  std::set<std::string> tags, links;
  std::map<std::string, std::string> properties, written;
};

UdevResult apply_udev_rules(const std::vector<UdevRule>& rules, const std::string& action, const std::vector<UdevDevice>& chain);

}  // namespace prismesh::drivers::port
