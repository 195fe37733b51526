// New text, and changes of a model, as hostile or damaged bytes: refused, or sound enough to be used.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include <unistd.h>

#include "ipc/import/model_change.h"
#include "ipc/import/text_hand_over.h"
#include "mesh/deck/open.h"
#include "mesh/model/topology_change.h"
#include "tests/fuzz/require.h"

namespace {

using namespace prismesh;

constexpr const char* kDeck =
    "*KEYWORD\n*NODE\n"
    "       1             0.0             0.0             0.0\n       2             1.0             0.0             0.0\n"
    "       3             1.0             1.0             0.0\n       4             0.0             1.0             0.0\n"
    "*ELEMENT_SHELL\n       1       7       1       2       3       4\n*ELEMENT_BEAM\n       1       7       1       3\n*END\n";

const mesh::deck::OpenedDeck& deck() {
  static const mesh::deck::OpenedDeck opened = [] {
    const auto folder = std::filesystem::temp_directory_path() / ("prismesh-fuzz-" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "main.k") << kDeck;
    auto read = mesh::deck::open(folder / "main.k");
    std::filesystem::remove_all(folder);
    return std::move(read.value());
  }();
  return opened;
}

/// A model with a node moved, and a shell divided.
mesh::Model edited() {
  mesh::Model model = deck().model;
  model.positions.set(2, {1, 1.5, 0});
  const mesh::NodeIndex middle = mesh::add_node(model, 9, {0.5, 0, 0}, mesh::edge_origin(mesh::NodeIndex(0), mesh::NodeIndex(1)));
  mesh::add_shell(model, 2, {{middle, mesh::NodeIndex(1), mesh::NodeIndex(2), mesh::NodeIndex(2)}}, mesh::ShellIndex(0));
  mesh::set_shell_nodes(model, mesh::ShellIndex(0), {{mesh::NodeIndex(0), middle, mesh::NodeIndex(2), mesh::NodeIndex(3)}});
  const mesh::NodeIndex low =
      mesh::add_placed_node(model, 10, {0.2, 0.2, 0}, mesh::edge_origin(mesh::NodeIndex(0), middle), mesh::kJoinsNone);
  const mesh::NodeIndex high =
      mesh::add_placed_node(model, 11, {0.2, 0.2, 1}, mesh::edge_origin(mesh::NodeIndex(0), middle), mesh::kJoinsTies);
  mesh::Part part;
  part.id = 90;
  mesh::add_element(model, mesh::ElementClass::beam, 5, mesh::add_part(model, part, {"*PART\nwelds\n"}), std::array{low, high},
                    mesh::kNoExample);
  mesh::add_element(model, mesh::ElementClass::beam, 6, mesh::PartIndex(0), std::array{low, high}, 0);
  return model;
}

void try_text(std::span<const std::byte> bytes) {
  const auto text = ipc::read_text_hand_over(bytes, *deck().deck, deck().model.node_count());
  if (!text) return;
  const std::string_view old = deck().deck->files[0].bytes.text();
  std::size_t at = 0;
  for (const mesh::deck::Replacement& each : text->by_file.at(0)) {
    require(each.offset >= at && each.offset + each.length <= old.size());
    at = each.offset + each.length;
  }
  for (const auto& [node, place] : text->rounding.nodes) require(deck().model.position(node).allFinite() && place.allFinite());
}

void try_change(std::span<const std::byte> bytes) {
  const auto model = ipc::read_model_change(bytes, deck().model);
  if (!model) return;
  for (std::size_t s = 0; s < model->shell_count(); ++s) {
    if (model->is_removed(mesh::ShellIndex(s))) continue;
    for (const mesh::NodeIndex node : model->shell(mesh::ShellIndex(s)).node) require(node.value < model->node_count());
    require(mesh::deck_ancestor(*model, mesh::ShellIndex(s)).value < deck().model.shell_count());
  }
  for (const auto& block : model->elements) {
    if (!block) continue;
    for (const mesh::NodeIndex node : block->nodes) require(node.value < model->node_count());
    for (const mesh::PartIndex part : block->part) require(!part.valid() || part.value < model->parts->size());
  }
  (void)mesh::deck::text_changes(*deck().deck, deck().model, *model);
}

/// Each change: two bytes for the place, one for how many bytes, the bytes.
std::vector<std::byte> changed(std::vector<std::byte> sound, const std::uint8_t* data, std::size_t size) {
  while (size >= 4) {
    const std::size_t at = (std::size_t{data[0]} | std::size_t{data[1]} << 8) % sound.size();
    const std::size_t count = std::min({std::size_t{data[2]} % 9, size - 3, sound.size() - at});
    std::memcpy(sound.data() + at, data + 3, count);
    data += 3 + count;
    size -= 3 + count;
  }
  return sound;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::vector<std::byte> text =
      ipc::write_text_hand_over(mesh::deck::text_changes(*deck().deck, deck().model, edited()).value());
  static const std::vector<std::byte> change = ipc::write_model_change(deck().model, edited());
  try_text(std::as_bytes(std::span(data, size)));
  try_change(std::as_bytes(std::span(data, size)));
  try_text(changed(text, data, size));
  try_change(changed(change, data, size));
  return 0;
}
