#include "mesh/deck/radioss/context.h"

#include <algorithm>

#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::radioss {
namespace {

struct Prefix {
  std::string_view text;
  double factor;
};
constexpr std::array<Prefix, 22> kPrefixes = {{{"", 1},     {"y", 1e-24}, {"z", 1e-21}, {"a", 1e-18}, {"f", 1e-15}, {"p", 1e-12},
                                               {"n", 1e-9}, {"mu", 1e-6}, {"m", 1e-3},  {"c", 1e-2},  {"d", 1e-1},  {"da", 1e1},
                                               {"h", 1e2},  {"k", 1e3},   {"M", 1e6},   {"G", 1e9},   {"T", 1e12},  {"P", 1e15},
                                               {"E", 1e18}, {"Z", 1e21},  {"Y", 1e24},  {"u", 1e-6}}};

}  // namespace

std::optional<double> unit_factor(std::string_view code, char base) {
  code = trim(code);
  double number = 0;
  if (!code.empty() && parse_real(code, number)) return number > 0 ? std::optional(number) : std::nullopt;
  if (code.empty() || code.back() != base) return std::nullopt;
  code.remove_suffix(1);
  for (const Prefix& prefix : kPrefixes)
    if (prefix.text == code) return prefix.factor * (base == 'g' ? 1e-3 : 1);
  return std::nullopt;
}

std::optional<Units> UnitSystems::find(std::span<const Context> contexts, std::uint32_t context, std::int64_t id) const {
  for (;;) {
    if (const auto at = systems_.find({context, id}); at != systems_.end()) return at->second;
    if (contexts[context].parent == context) return std::nullopt;
    context = contexts[context].parent;
  }
}

}  // namespace prismesh::mesh::deck::radioss
