#include "tests/drivers/port/udev_rules.h"

#include <fnmatch.h>

#include <algorithm>
#include <regex>
#include <sstream>

namespace prismesh::drivers::port {

namespace {

/// Operators and attributes that a key accepts.
struct Grammar {
  bool has_attribute = false;
  std::set<std::string> operations;
  bool is_parent_match = false;  ///< all such keys of a rule must match the same device of the chain
};

const std::map<std::string, Grammar>& grammar() {
  const std::set<std::string> match{"==", "!="}, list{"=", "+=", "-=", ":="}, set{"=", ":="}, both{"==", "!=", "="};
  static const std::map<std::string, Grammar> kKeys{
      {"ACTION", {false, match}},
      {"SUBSYSTEM", {false, match}},
      {"DRIVER", {false, match}},
      {"ATTR", {true, both}},
      {"ENV", {true, both}},
      {"SUBSYSTEMS", {false, match, true}},
      {"DRIVERS", {false, match, true}},
      {"ATTRS", {true, match, true}},
      {"GROUP", {false, set}},
      {"MODE", {false, set}},
      {"TAG", {false, {"+=", "-=", "=", "==", "!="}}},
      {"SYMLINK", {false, list}},
      {"GOTO", {false, {"="}}},
      {"LABEL", {false, {"="}}},
  };
  return kKeys;
}

bool is_match(const UdevToken& token) { return token.operation == "==" || token.operation == "!="; }

/// Removes the next token from the line and returns it. Returns nothing if there is none; then the rest is the problem.
std::optional<UdevToken> next_token(std::string& line) {
  static const std::regex kToken(R"rx(^\s*([A-Z]+)(?:\{([^{}"]+)\})?(==|!=|\+=|-=|:=|=)"([^"\\]*)"\s*(,|$))rx");
  std::smatch found;
  if (!std::regex_search(line, found, kToken)) return std::nullopt;
  UdevToken token{found[1], found[2], found[3], found[4]};
  const bool more = found[5].length() > 0;
  line = found.suffix();
  // a trailing comma
  if (more && line.find_first_not_of(" \t") == std::string::npos) return std::nullopt;
  return token;
}

std::string problem_of(const UdevToken& token) {
  const auto key = grammar().find(token.key);
  if (key == grammar().end()) return "unknown key " + token.key;
  if (key->second.has_attribute != !token.attribute.empty()) return token.key + (token.attribute.empty() ? " needs" : " has no") + " {..}";
  if (!key->second.operations.contains(token.operation)) return token.key + " has no operator " + token.operation;
  if (token.value.empty()) return token.key + " has no value";
  if (token.key == "MODE" && !std::regex_match(token.value, std::regex("0[0-7]{3}"))) return token.value + " is no mode";
  if (!is_match(token) && token.value.find_first_of("$%") != std::string::npos &&
      !std::regex_match(token.value, std::regex(R"((?:[^$%]|\$(?:attr\{[^{}]+\}|kernel|number)|%[kn%])*)")))
    return "unknown substitution in " + token.value;
  return {};
}

void check_jumps(UdevRules& read) {
  std::map<std::string, int> label_line;
  const auto problem = [&](int line, const std::string& what) { read.problems.push_back(std::to_string(line) + ": " + what); };
  for (const UdevRule& rule : read.rules)
    for (const UdevToken& token : rule.tokens)
      if (token.key == "LABEL" && !label_line.emplace(token.value, rule.line).second) problem(rule.line, "a second label " + token.value);
  for (const UdevRule& rule : read.rules)
    for (const UdevToken& token : rule.tokens)
      if (token.key == "GOTO" && (!label_line.contains(token.value) || label_line[token.value] <= rule.line))
        problem(rule.line, "no label " + token.value + " below");
}

bool holds(const UdevToken& token, const std::string& actual) {
  bool any = false;
  std::istringstream patterns(token.value);
  for (std::string pattern; std::getline(patterns, pattern, '|');) any = any || ::fnmatch(pattern.c_str(), actual.c_str(), 0) == 0;
  return any == (token.operation == "==");
}

/// A match on a missing attribute fails with either operator.
bool holds(const UdevToken& token, const std::map<std::string, std::string>& values) {
  const auto found = values.find(token.attribute);
  return found != values.end() && holds(token, found->second);
}

class Machine {
 public:
  Machine(std::string action, const std::vector<UdevDevice>& chain) : action_(std::move(action)), chain_(chain) {
    result.properties = chain.front().properties;
  }

  /// Returns the label to continue at, if the rule has a GOTO.
  std::optional<std::string> apply(const UdevRule& rule) {
    const std::optional<std::size_t> parent = matched_device(rule);
    if (!parent) return std::nullopt;
    std::optional<std::string> jump;
    for (const UdevToken& token : rule.tokens) {
      if (is_match(token)) continue;
      if (token.key == "GOTO")
        jump = token.value;
      else
        assign(token, substituted(token.value, *parent));
    }
    return jump;
  }

  UdevResult result;

 private:
  std::optional<std::size_t> matched_device(const UdevRule& rule) const {
    for (const UdevToken& token : rule.tokens)
      if (is_match(token) && !grammar().at(token.key).is_parent_match && !own_match(token)) return std::nullopt;
    for (std::size_t i = 0; i < chain_.size(); ++i)
      if (std::all_of(rule.tokens.begin(), rule.tokens.end(), [&](const UdevToken& token) {
            return !is_match(token) || !grammar().at(token.key).is_parent_match || chain_match(token, chain_[i]);
          }))
        return i;
    return std::nullopt;
  }
  bool own_match(const UdevToken& token) const {
    if (token.key == "ACTION") return holds(token, action_);
    if (token.key == "SUBSYSTEM") return holds(token, chain_.front().subsystem);
    if (token.key == "DRIVER") return holds(token, chain_.front().driver);
    if (token.key == "ENV") return holds(token, result.properties.contains(token.attribute) ? result.properties.at(token.attribute) : "");
    if (token.key == "TAG") return result.tags.contains(token.value) == (token.operation == "==");
    return holds(token, chain_.front().attributes);
  }
  static bool chain_match(const UdevToken& token, const UdevDevice& device) {
    if (token.key == "SUBSYSTEMS") return holds(token, device.subsystem);
    if (token.key == "DRIVERS") return holds(token, device.driver);
    return holds(token, device.attributes);
  }
  /// $attr{x}: the device's own attribute, or else that of the matching parent.
  std::string substituted(std::string value, std::size_t parent) const {
    const std::regex attribute(R"(\$attr\{([^{}]+)\})");
    for (std::smatch found; std::regex_search(value, found, attribute);) {
      const auto& own = chain_.front().attributes;
      const auto& its = chain_[parent].attributes;
      const std::string name = found[1];
      value = found.prefix().str() + (own.contains(name) ? own.at(name) : its.contains(name) ? its.at(name) : "") + found.suffix().str();
    }
    return value;
  }
  void assign(const UdevToken& token, const std::string& value) {
    if (token.key == "GROUP") result.group = value;
    if (token.key == "MODE") result.mode = value;
    if (token.key == "TAG") result.tags.insert(value);
    if (token.key == "SYMLINK") result.links.insert(value);
    if (token.key == "ENV") result.properties[token.attribute] = value;
    if (token.key == "ATTR") result.written[token.attribute] = value;
  }

  std::string action_;
  const std::vector<UdevDevice>& chain_;
};

}  // namespace

UdevRules read_udev_rules(std::string_view text) {
  UdevRules read;
  std::istringstream lines{std::string(text)};
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const std::size_t first = line.find_first_not_of(" \t");
    if (first == std::string::npos || line[first] == '#') continue;
    const auto problem = [&](const std::string& what) { read.problems.push_back(std::to_string(number) + ": " + what); };
    UdevRule rule{number, {}};
    bool whole = true;
    while (whole && !line.empty()) {
      const std::optional<UdevToken> token = next_token(line);
      whole = token.has_value();
      if (!whole) problem("can't be read from here: " + line);
      if (const std::string what = token ? problem_of(*token) : ""; !what.empty()) problem(what);
      if (token) rule.tokens.push_back(*token);
    }
    if (std::all_of(rule.tokens.begin(), rule.tokens.end(), is_match)) problem("does nothing");
    read.rules.push_back(std::move(rule));
  }
  check_jumps(read);
  return read;
}

UdevResult apply_udev_rules(const std::vector<UdevRule>& rules, const std::string& action, const std::vector<UdevDevice>& chain) {
  Machine machine(action, chain);
  std::optional<std::string> jump;
  for (const UdevRule& rule : rules) {
    const auto is_target = [&](const UdevToken& token) { return token.key == "LABEL" && token.value == jump; };
    if (jump && std::none_of(rule.tokens.begin(), rule.tokens.end(), is_target)) continue;
    jump = machine.apply(rule);
  }
  return machine.result;
}

}  // namespace prismesh::drivers::port
