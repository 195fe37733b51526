// Any bytes as a journal, and any bytes as a delta: no crash, no absurd memory, a typed error or a document that holds together.
// Checksums stop random bytes early, so records are also sealed here around the fuzzer's bytes.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "base/base64.h"
#include "mesh/document/delta.h"
#include "mesh/document/document.h"
#include "mesh/document/journal_records.h"
#include "mesh/model/adjacency.h"
#include "tests/support/make_model.h"

using namespace prismesh;                  // NOLINT: a fuzz target is a program of its own
using namespace prismesh::mesh::document;  // NOLINT

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

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
  static_cast<void>(mesh::build_adjacency(model));
}

void fuzz_delta(std::span<const std::byte> bytes) {
  Generation generation = sample().current();
  const Result<mesh::NodeSet> moved = apply_delta(bytes, generation);
  if (!moved) return;
  check(generation);
  // what it did, written again, does the same
  Generation again = sample().current();
  const Result<mesh::NodeSet> same = apply_delta(encode_delta(sample().current(), generation), again);
  require(same.has_value());
  require(mesh::moved_nodes(generation.model, again.model).empty());
  require(generation.model.node_count() == again.model.node_count() && generation.model.shell_count() == again.model.shell_count());
  for (std::size_t s = 0; s < again.model.shell_count(); ++s) require(generation.model.shell_nodes[s] == again.model.shell_nodes[s]);
}

void fuzz_text(std::string_view text) {
  const auto on_header = [](const JournalHeader&) { return Result<void>(); };
  const auto on_record = [](const JournalRecord& record) {
    if (const auto delta = base64_decode(record.delta)) fuzz_delta(*delta);
    return Result<void>();
  };
  const Result<JournalEnd> end = read_journal(text, "fuzz.journal", on_header, on_record);
  if (end)
    require(end->bytes <= text.size());
  else
    require(!end.error().message.empty() && end.error().line >= 1);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  fuzz_delta(std::as_bytes(std::span(text)));
  fuzz_text(text);
  const std::string header = header_text({"0", "fuzz.k", "0", 16, 9, 1, LengthUnit::mm, 1.0, "default"});
  const std::size_t half = size / 2;
  const std::string record = record_text(1, text.substr(0, half), Prepared::Step::push, 0, text.substr(half), check_in(header));
  fuzz_text(header + record);
  fuzz_text(header + std::string(text));
  return 0;
}
