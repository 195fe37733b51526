// Any bytes as a journal, and any bytes as a delta: no crash, no absurd memory, a typed error or a document that holds together.
// Checksums stop random bytes early, so records are also sealed here around the fuzzer's bytes.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "base/base64.h"
#include "mesh/deck/open.h"
#include "mesh/document/branches.h"
#include "mesh/document/delta.h"
#include "mesh/document/document.h"
#include "mesh/document/generation.h"
#include "mesh/document/journal_rebuild.h"
#include "mesh/document/journal_records.h"
#include "mesh/document/open.h"
#include "mesh/document/prepare.h"
#include "mesh/model/adjacency.h"
#include "mesh/model/topology_change.h"
#include "tests/fuzz/require.h"
#include "tests/support/make_model.h"

using namespace prismesh;                  // NOLINT: a fuzz target is a program of its own
using namespace prismesh::mesh::document;  // NOLINT

namespace {

const Document& sample() {
  static const Document document = [] {
    mesh::deck::OpenedDeck opened{std::make_shared<mesh::deck::Deck>(),
                                  test::make_grid(3, 3, [](int i, int j) { return mesh::Vec3(5.0 * i, 5.0 * j, 0); })};
    return open("fuzz.k", std::move(opened), {}).value();
  }();
  return document;
}

/// Whatever the delta said, counts and marks agree and every number is a coordinate.
void check(const Generation& generation) {
  std::size_t nodes = 0, shells = 0;
  for (std::size_t n = 0; n < generation.node_marks.size(); ++n) nodes += (generation.node_marks[n] & kSelected) != 0;
  for (std::size_t s = 0; s < generation.shell_marks.size(); ++s) shells += (generation.shell_marks[s] & kSelected) != 0;
  require(nodes == generation.selected_nodes && shells == generation.selected_shells);
  const mesh::Model& model = generation.model;
  require(generation.node_marks.size() == model.node_count() && generation.shell_marks.size() == model.shell_count());
  for (std::size_t n = 0; n < model.node_count(); ++n) require(model.positions[n].allFinite());
  for (std::size_t s = 0; s < model.shell_count(); ++s)
    if (!model.is_removed(mesh::ShellIndex(s)))
      for (const mesh::NodeIndex node : model.shell(mesh::ShellIndex(s)).node) require(node.value < model.node_count());
  for (const auto& block : model.elements) {
    if (!block) continue;
    require(block->first_node.size() == block->size() + 1 && block->first_node.back() == block->nodes.size());
    for (const mesh::NodeIndex node : block->nodes) require(node.value < model.node_count());
    for (const mesh::PartIndex part : block->part) require(!part.valid() || part.value < model.parts->size());
  }
  require(generation.parts->size() == model.parts->size() && generation.judging->parts.size() == model.parts->size());
  static_cast<void>(mesh::build_adjacency(model));
}

/// Whether two models have the same entries, those that came and went included.
void require_same(const mesh::Model& a, const mesh::Model& b) {
  require(a.node_count() == b.node_count() && a.shell_count() == b.shell_count());
  require(mesh::moved_nodes(a, b).empty() && a.parts->size() == b.parts->size());
  require(!a.topology_change || !b.topology_change ||
          (a.topology_change->placed_nodes == b.topology_change->placed_nodes &&
           a.topology_change->added_parts == b.topology_change->added_parts &&
           a.topology_change->element_examples == b.topology_change->element_examples));
  for (std::size_t c = 0; c < a.elements.size(); ++c)
    if (a.elements[c]) require(a.elements[c]->id == b.elements[c]->id && a.elements[c]->nodes == b.elements[c]->nodes);
  for (std::size_t n = 0; n < a.node_count(); ++n) {
    const mesh::NodeIndex node(n);
    require(a.node_ids[n] == b.node_ids[n] && a.is_removed(node) == b.is_removed(node));
    if (mesh::is_added(a, node)) require(mesh::origin_of(a, node) == mesh::origin_of(b, node));
  }
  for (std::size_t s = 0; s < a.shell_count(); ++s) {
    const mesh::ShellIndex shell(s);
    require(a.shell_ids[s] == b.shell_ids[s] && a.is_removed(shell) == b.is_removed(shell));
    require(a.shell_nodes[s] == b.shell_nodes[s] && a.shell_parts[s] == b.shell_parts[s]);
    require(mesh::deck_ancestor(a, shell) == mesh::deck_ancestor(b, shell));
  }
}

/// Does what a delta says to a generation; false: it was refused.
bool fuzz_delta(std::span<const std::byte> bytes, Generation& generation) {
  const Generation before = generation;
  if (!apply_delta(bytes, generation)) {
    generation = before;
    return false;
  }
  check(generation);
  // what it did, written again, does the same
  Generation again = before;
  require(apply_delta(encode_delta(before, generation), again).has_value());
  require_same(generation.model, again.model);
  return true;
}

void fuzz_text(std::string_view text) {
  const auto on_header = [](const JournalHeader&) { return Result<void>(); };
  Generation generation = sample().current();  // each record goes on from what the one before left
  const auto on_record = [&](const JournalRecord& record) {
    if (const auto delta = base64_decode(record.delta)) fuzz_delta(*delta, generation);
    return Result<void>();
  };
  const Result<JournalEnd> end = read_journal(text, "fuzz.journal", on_header, on_record);
  if (end)
    require(end->bytes <= text.size());
  else
    require(!end.error().message.empty() && end.error().line >= 1);
}

/// Steps in any order, branches and what is dropped included: the history holds together, whatever they name.
void fuzz_steps(std::string_view text, const std::string& header) {
  std::string journal = header;
  std::string check = check_in(header);
  std::uint64_t number = 0;
  constexpr std::size_t kSteps = 40;
  for (const char each : text.substr(0, kSteps)) {
    const auto bits = static_cast<unsigned char>(each);
    const std::string record =
        record_text({++number, R"({"edit":"lock"})", static_cast<Prepared::Step>(bits & 3), (bits >> 2) & 1U,
                     (bits & 3) == 0 ? "AgAAAAAAAAAAAAA=" : "", 0, (bits >> 3) & 1U, static_cast<std::uint64_t>(bits >> 4)},
                    check);
    check = check_in(record);
    journal += record;
  }
  Document document = sample();
  std::size_t states = 0;
  const auto on_header = [](const JournalHeader&) { return Result<void>(); };
  const auto on_record = [&](const JournalRecord& record) -> Result<void> {
    if (Result<void> taken = take_record(record, document, "fuzz.journal"); !taken)
      return {};  // such a step is refused, and changes nothing
    require(document.cursor < document.generations.size());
    states = document.generations.size();
    for (const Branch& branch : document.branches) {
      require(!branch.states.empty() && branch.number < document.next_branch);
      states += branch.states.size();
      require(way_to(document, branch.states.back()->number).has_value());
    }
    require(states <= number + 1);
    return {};
  };
  require(read_journal(journal, "fuzz.journal", on_header, on_record).has_value());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  Generation generation = sample().current();
  const std::size_t half = size / 2;
  if (fuzz_delta(std::as_bytes(std::span(text)), generation)) fuzz_delta(std::as_bytes(std::span(text)), generation);
  // one half, and the other on what it left
  generation = sample().current();
  fuzz_delta(std::as_bytes(std::span(text.substr(0, half))), generation);
  fuzz_delta(std::as_bytes(std::span(text.substr(half))), generation);
  fuzz_text(text);
  const std::string header = header_text({"0", {"fuzz.k", "0", 16, 9, 1}, {LengthUnit::mm, 1.0, "default"}});
  const std::string record = record_text({1, text.substr(0, half), Prepared::Step::push, 0, text.substr(half)}, check_in(header));
  fuzz_text(header + record);
  fuzz_steps(text, header);
  fuzz_text(header + std::string(text));
  return 0;
}
