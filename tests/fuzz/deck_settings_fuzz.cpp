// Any bytes as a deck's settings file: no crash, errors say file and line, and whatever is read is written as what is read again.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "mesh/document/deck_settings.h"
#include "mesh/document/open.h"
#include "tests/fuzz/require.h"
#include "tests/support/make_model.h"

using namespace prismesh;  // NOLINT: a fuzz target is a program of its own

namespace {

mesh::Model three_parts() {
  std::vector<test::NodeSpec> nodes;
  std::vector<test::ShellSpec> shells;
  for (std::int64_t n = 0; n < 4; ++n)
    nodes.push_back({n + 1, mesh::Vec3(static_cast<double>(n / 2), static_cast<double>(n == 1 || n == 2), 0)});
  for (std::int64_t part = 1; part <= 3; ++part) shells.push_back({part, part, {1, 2, 3, 4}});
  return test::make_model(nodes, shells);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace mesh::document;
  static const mesh::Model model = three_parts();
  const auto rules = parse_deck_settings({reinterpret_cast<const char*>(data), size}, "deck.k.prismesh.toml");
  if (!rules) {
    require(rules.error().file == "deck.k.prismesh.toml" && rules.error().line >= 1 && !rules.error().message.empty());
    return 0;
  }
  OpenOptions options;
  options.rules = *rules;
  options.read_settings_file = false;
  for (const JudgingRule& rule : options.rules)
    if (rule.criteria && !mesh::quality::is_built_in_criteria(*rule.criteria)) return 0;  // a file
  const auto document = open("deck.k", {std::make_shared<mesh::deck::Deck>(), model}, options);
  if (!document) return 0;  // an expression that names nothing
  const std::string text = deck_settings_text(document->current(), "deck.k.prismesh.toml");
  const auto again = parse_deck_settings(text, "deck.k.prismesh.toml");
  require(again.has_value());
  options.rules = *again;
  const auto same = open("deck.k", {std::make_shared<mesh::deck::Deck>(), model}, options);
  require(same.has_value());
  require(deck_settings_text(same->current(), "deck.k.prismesh.toml") == text);
  return 0;
}
