#include "ipc/import/text_hand_over.h"

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include "ipc/import/hand_over_bytes.h"

namespace prismesh::ipc {

namespace {

using mesh::deck::Deck;
using mesh::deck::Replacement;
using mesh::deck::TextChanges;

constexpr std::uint64_t kTextMagic = 0x3154'5854'4d53'5250;  // "PRSMTXT1"
constexpr std::size_t kEntryBytes = 8;                       ///< of the least that an entry of a list takes

template <class Archive>
void describe_text_changes(Archive& io, auto& text) {
  io.list(text.by_file, kEntryBytes, [&](auto& replacements) {
    io.list(replacements, 3 * kEntryBytes, [&](auto& replacement) {
      io.number(replacement.offset);
      io.number(replacement.length);
      io.text(replacement.text);
    });
  });
  io.number(text.rounding.count);
  io.number(text.rounding.largest_error);
  io.text(text.rounding.first);
  io.list(text.rounding.nodes, 4 + sizeof(mesh::Vec3), [&](auto& rounded) {
    io.number(rounded.first);
    io.number(rounded.second);
  });
  io.number(text.counts);
  io.number(text.set_cards);
  io.number(text.lines);
}

/// Whether they ascend, none overlaps another, and all lie in the text.
bool fit(const std::vector<Replacement>& replacements, std::size_t text_size) {
  std::size_t end = 0;
  for (const Replacement& each : replacements) {
    if (each.offset < end || each.offset > text_size || each.length > text_size - each.offset) return false;
    end = each.offset + each.length;
  }
  return true;
}

std::string fault_of(const TextChanges& text, const Deck& deck, std::size_t nodes) {
  if (text.by_file.size() != deck.files.size()) return "it is text for other files";
  for (std::size_t f = 0; f < deck.files.size(); ++f)
    if (!fit(text.by_file[f], deck.files[f].bytes.text().size())) return "a place of new text isn't in its file, or overlaps another";
  if (!std::isfinite(text.rounding.largest_error)) return "a number isn't finite";
  for (const auto& [node, at] : text.rounding.nodes)
    if (node.value >= nodes || !at.allFinite()) return "a rounded node doesn't exist, or is nowhere";
  return "";
}

}  // namespace

std::vector<std::byte> write_text_hand_over(const TextChanges& text) {
  HandOverWriter counter;
  counter.number(kTextMagic);
  describe_text_changes(counter, text);
  std::vector<std::byte> bytes(counter.size());
  HandOverWriter writer(bytes);
  writer.number(kTextMagic);
  describe_text_changes(writer, text);
  return bytes;
}

Result<TextChanges> read_text_hand_over(std::span<const std::byte> bytes, const Deck& deck, std::size_t nodes) {
  const auto damaged = [](const std::string& fault) { return fail("the new text as it was handed over", fault + "; nothing is written"); };
  HandOverReader from(bytes);
  std::uint64_t magic = 0;
  from.number(magic);
  if (magic != kTextMagic) return damaged("it doesn't begin as such, or is of another version");
  TextChanges text;
  describe_text_changes(from, text);
  if (!from.ok()) return damaged(from.fault());
  if (!from.at_end()) return damaged("something follows its end");
  if (const std::string fault = fault_of(text, deck, nodes); !fault.empty()) return damaged(fault);
  return text;
}

}  // namespace prismesh::ipc
