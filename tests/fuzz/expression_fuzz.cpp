// Any bytes as an id expression: no crash, errors point into the text, and what is selected can be written and read again.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/select/expression.h"
#include "tests/support/make_model.h"

using namespace prismesh;  // NOLINT: a fuzz target is a program of its own

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

const mesh::Model& sample() {
  static const mesh::Model model = [] {
    std::vector<test::NodeSpec> nodes;
    for (int i = 0; i < 9; ++i) nodes.push_back({10 * (i + 1), mesh::Vec3(i % 3, i / 3, 0)});
    nodes.push_back({9223372036854775807, mesh::Vec3(9, 9, 9)});
    return test::make_model(nodes, {{1, 3, {10, 20, 50, 40}}, {2, 3, {20, 30, 60, 50}}, {3, 7, {40, 50, 80}}},
                            {{mesh::ElementClass::beam, 9, 7, {80, 90}}});
  }();
  return model;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const auto kind = static_cast<mesh::select::Kind>(data[0] % 3);
  const std::string_view text(reinterpret_cast<const char*>(data + 1), size - 1);
  const auto chosen = mesh::select::evaluate(sample(), text, kind);
  if (!chosen) {
    require(chosen.error().file == "expression" && !chosen.error().message.empty());
    require(chosen.error().line >= 1 && chosen.error().line <= static_cast<long>(text.size()) + 1);
    return 0;
  }
  if (chosen->nodes.empty()) return 0;
  std::vector<std::int64_t> ids;
  for (const mesh::NodeIndex node : chosen->nodes) ids.push_back(sample().node_ids[node.value]);
  const auto again = mesh::select::evaluate(sample(), mesh::select::to_expression(ids), mesh::select::Kind::node);
  require(again.has_value() && again->nodes == chosen->nodes);
  return 0;
}
