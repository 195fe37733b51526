// A deck that a hostile process hands over: refused, or sound enough to be looked through. The bytes of a sound one are changed by the
// fuzzer's input: places and values.
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <unistd.h>

#include "ipc/import/hand_over.h"
#include "mesh/deck/open.h"
#include "mesh/model/adjacency.h"
#include "mesh/model/element_lines.h"
#include "tests/fuzz/require.h"

namespace {

using namespace prismesh;

constexpr const char* kDeck =
    "*KEYWORD\n*NODE\n"
    "       1             0.0             0.0             0.0\n       2             1.0             0.0             0.0\n"
    "       3             1.0             1.0             0.0\n       4             0.0             1.0             0.0\n"
    "*ELEMENT_SHELL\n       1       7       1       2       3       4\n       2       7       1       2       3       9\n"
    "*ELEMENT_BEAM\n       5       8       1       2\n*SET_NODE_LIST\n         5\n         1         2\n"
    "*PART\nplate\n         7         3         2\n*SECTION_SHELL\n         3         2\n       1.2       1.2       1.2       1.2\n*END\n";

const std::vector<std::byte>& sound() {
  static const std::vector<std::byte> bytes = [] {
    const auto folder = std::filesystem::temp_directory_path() / ("prismesh-fuzz-" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "main.k") << kDeck;
    const auto opened = mesh::deck::open(folder / "main.k");
    std::filesystem::remove_all(folder);
    std::vector<std::byte> all(ipc::hand_over_size(opened.value()));
    ipc::write_hand_over(*opened, all);
    return all;
  }();
  return bytes;
}

/// Follows every index, offset and order that the rest of the program follows.
void look_through(const mesh::deck::OpenedDeck& opened) {
  const mesh::Model& model = opened.model;
  const mesh::deck::Deck& deck = *opened.deck;
  for (std::size_t n = 0; n < model.node_count(); ++n) {
    require(model.find_node(model.node_ids[n]).value == n && model.position(mesh::NodeIndex(n)).allFinite());
    require(deck.node_line[n] <= deck.file_of(mesh::NodeIndex(n)).bytes.text().size());
    require(deck.run_of(mesh::NodeIndex(n)).frame < deck.frames.size());
  }
  for (std::size_t s = 0; s < model.shell_count(); ++s) {
    for (const mesh::NodeIndex node : model.shell(mesh::ShellIndex(s)).node) require(model.position(node).allFinite());
    require(deck.shell_line[s] <= deck.files[deck.run_of(mesh::ShellIndex(s)).file].bytes.text().size());
  }
  for (std::size_t e = 0; e < deck.hidden.size(); ++e)
    for (const mesh::NodeIndex node : deck.hidden.nodes_of(e)) require(model.position(node).allFinite());
  mesh::element_lines(model);
  for (const mesh::Reference& reference : deck.references->all()) {
    require(reference.names(reference.first));
    const mesh::Referrer& referrer = deck.references->referrers()[reference.referrer];
    require(deck.files[referrer.file].bytes.text().substr(referrer.offset, referrer.end - referrer.offset).size() ==
            referrer.end - referrer.offset);
    require(deck.references->named(reference.referred, reference.first));
  }
  for (const mesh::deck::SourceFile& file : deck.files) require(file.path.string().starts_with("/upload/"));
}

void try_bytes(std::span<const std::byte> bytes) {
  const auto taken = ipc::read_hand_over(bytes, "/upload");
  if (!taken) return;
  look_through(*taken);
  // A sound one survives a round trip.
  std::vector<std::byte> again(ipc::hand_over_size(*taken));
  ipc::write_hand_over(*taken, again);
  require(ipc::read_hand_over(again, "/upload").has_value());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try_bytes(std::as_bytes(std::span(data, size)));
  // Each change: two bytes for the place, one for how many bytes, the bytes.
  std::vector<std::byte> changed = sound();
  while (size >= 4) {
    const std::size_t at = (std::size_t{data[0]} | std::size_t{data[1]} << 8) % changed.size();
    const std::size_t count = std::min({std::size_t{data[2]} % 9, size - 3, changed.size() - at});
    std::memcpy(changed.data() + at, data + 3, count);
    data += 3 + count;
    size -= 3 + count;
  }
  try_bytes(changed);
  return 0;
}
