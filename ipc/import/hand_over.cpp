#include "ipc/import/hand_over.h"

#include <algorithm>
#include <cstring>
#include <memory>
#include <string>
#include <utility>

#include "base/hash.h"
#include "ipc/import/check_hand_over.h"
#include "ipc/import/hand_over_bytes.h"
#include "mesh/deck/data/deck.h"
#include "mesh/deck/data/derived.h"
#include "mesh/deck/data/on_disk.h"
#include "mesh/model/adjacency.h"

namespace prismesh::ipc {

namespace {

using mesh::ElementBlock;
using mesh::ElementClass;
using mesh::Model;
using mesh::Part;
using mesh::Referred;
using mesh::deck::Deck;

constexpr std::uint64_t kHandOverMagic = 0x3144'4e48'4d53'5250;  // "PRSMHND1"
constexpr auto kLastReferred = static_cast<std::uint8_t>(mesh::kReferredCount - 1);
constexpr auto kLastElementClass = static_cast<std::uint8_t>(mesh::kElementClassCount - 1);
constexpr std::size_t kTextBytes = sizeof(std::uint64_t);  ///< of an empty text

// Each function describes the fields of one struct, for the writer (which gets it const) and for the reader.

template <class To>
void describe_text_and_file(HandOverWriter& to, const To& file) {
  const std::string relative = file.relative.string();
  to.text(relative);
  to.number(file.bytes.identity());
  to.flag(file.bytes.is_packed());
  to.bytes(file.bytes.text());
  const std::span<const std::byte> stored = file.bytes.bytes();
  if (file.bytes.is_packed()) to.bytes({reinterpret_cast<const char*>(stored.data()), stored.size()});
}

void describe_text_and_file(HandOverReader& from, mesh::deck::SourceFile& file) {
  std::string relative;
  from.text(relative);
  file.relative = relative;
  FileIdentity identity;
  from.number(identity);
  bool is_packed = false;
  from.flag(is_packed);
  const std::string_view text = from.bytes();
  file.bytes = FileBytes::copy_of(is_packed ? from.bytes() : text, identity);
  if (!is_packed) return;
  std::unique_ptr<char[]> unpacked(new char[text.size() + 1]);
  if (!text.empty()) std::memcpy(unpacked.get(), text.data(), text.size());
  unpacked[text.size()] = '\0';
  file.bytes = FileBytes::unpacked(std::move(file.bytes), std::move(unpacked), text.size());
}

void describe_path(HandOverWriter& to, const std::filesystem::path& path) { to.text(path.string()); }
void describe_path(HandOverReader& from, std::filesystem::path& path) {
  std::string text;
  from.text(text);
  path = text;
}

void describe_map(HandOverWriter& to, const std::map<std::string, std::size_t, std::less<>>& kinds) {
  to.number(std::uint64_t{kinds.size()});
  for (const auto& [kind, count] : kinds) {
    to.text(kind);
    to.number(std::uint64_t{count});
  }
}
void describe_map(HandOverReader& from, std::map<std::string, std::size_t, std::less<>>& kinds) {
  std::vector<std::pair<std::string, std::uint64_t>> all;
  from.list(all, kTextBytes + 8, [&](auto& entry) {
    from.text(entry.first);
    from.number(entry.second);
  });
  for (auto& [kind, count] : all) kinds[std::move(kind)] = count;
}

template <class Archive>
void describe_frame(Archive& io, auto& frame) {
  io.choice(frame.kind, 2);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) io.number(frame.to_basic.matrix()(row, column));
}

template <class Archive>
void describe_hidden(Archive& io, auto& hidden) {
  io.list(hidden.cards, 21, [&](auto& card) {
    io.choice(card.element_class, kLastElementClass);
    io.number(card.id);
    io.number(card.file);
    io.number(card.offset);
  });
  io.array(hidden.first_node);
  io.array(hidden.nodes);
}

template <class Archive>
void describe_counts(Archive& io, auto& counts) {
  for (auto* count : {&counts.quad, &counts.tri, &counts.quad8, &counts.tri6, &counts.beam, &counts.solid, &counts.tshell, &counts.other})
    io.number(*count);
}

template <class Archive>
void describe_side(Archive& io, auto& side) {
  io.flag(side.everything);
  io.flag(side.all_but);
  io.maybe(side.referred, [&](auto& referred) { io.choice(referred, kLastReferred); });
  io.number(side.id);
  io.number(side.thickness);
  io.number(side.scale);
}

void describe_part_contacts(HandOverWriter& to, const std::map<std::int64_t, mesh::PartContact>& of_part) {
  to.number(std::uint64_t{of_part.size()});
  for (const auto& [part, contact] : of_part) {
    to.number(part);
    to.number(contact);
  }
}
void describe_part_contacts(HandOverReader& from, std::map<std::int64_t, mesh::PartContact>& of_part) {
  std::vector<std::pair<std::int64_t, mesh::PartContact>> all;
  from.list(all, 8 + sizeof(mesh::PartContact), [&](auto& entry) {
    from.number(entry.first);
    from.number(entry.second);
  });
  of_part.insert(all.begin(), all.end());
}

template <class Archive>
void describe_contacts(Archive& io, auto& contacts) {
  io.list(contacts.cards, 2 * kTextBytes + 40, [&](auto& card) {
    io.text(card.keyword);
    io.number(card.id);
    io.text(card.title);
    describe_side(io, card.a);
    io.maybe(card.b, [&](auto& side) { describe_side(io, side); });
    io.flag(card.ties);
    io.flag(card.thick);
    io.flag(card.limited_by_sides);
  });
  describe_part_contacts(io, contacts.of_part);
  io.number(contacts.thickness);
}

template <class Archive>
void describe_referrer(Archive& io, auto& referrer) {
  io.text(referrer.keyword);
  io.number(referrer.id);
  io.text(referrer.title);
  io.number(referrer.file);
  io.number(referrer.offset);
  io.number(referrer.end);
  io.number(referrer.style);
  io.maybe(referrer.defines, [&](auto& referred) { io.choice(referred, kLastReferred); });
  io.text(referrer.group);
  io.choice(referrer.shells, 2);
}

template <class Archive>
void describe_reference(Archive& io, auto& reference) {
  io.choice(reference.referred, kLastReferred);
  io.choice(reference.role, 3);
  io.number(reference.first);
  io.number(reference.last);
  io.number(reference.step);
  io.number(reference.referrer);
  io.number(reference.card);
  io.flag(reference.takes_away);
}

template <class Archive>
void describe_unread_text(Archive& io, auto& unread) {
  io.text(unread.keyword);
  io.number(unread.file);
  io.number(unread.begin);
  io.number(unread.end);
  io.flag(unread.encrypted);
  io.array(unread.parameter_values);
}

/// The smallest bytes of each, for the lists of them.
constexpr std::size_t kReferrerBytes = 3 * kTextBytes + 8 + 4 + 8 + 8 + 2 + 1 + 1;
constexpr std::size_t kReferenceBytes = 2 + 3 * 8 + 4 + 8 + 1;
constexpr std::size_t kUnreadBytes = 2 * kTextBytes + 4 + 8 + 8 + 1;
constexpr std::size_t kFileBytes = 2 * kTextBytes + sizeof(FileIdentity) + 1;

void describe_references(HandOverWriter& to, const mesh::References& references) {
  const auto list = [&](const auto& all, const auto& each) {
    to.number(std::uint64_t{all.size()});
    for (const auto& entry : all) each(entry);
  };
  list(references.referrers(), [&](const auto& referrer) { describe_referrer(to, referrer); });
  list(references.all(), [&](const auto& reference) { describe_reference(to, reference); });
  list(references.unread(), [&](const auto& unread) { describe_unread_text(to, unread); });
}
void describe_references(HandOverReader& from, HandedReferences& references) {
  from.list(references.referrers, kReferrerBytes, [&](auto& referrer) { describe_referrer(from, referrer); });
  from.list(references.references, kReferenceBytes, [&](auto& reference) { describe_reference(from, reference); });
  from.list(references.unread, kUnreadBytes, [&](auto& unread) { describe_unread_text(from, unread); });
}

template <class Archive>
void describe_deck(Archive& io, auto& deck) {
  io.choice(deck.format, 3);
  io.list(deck.files, kFileBytes, [&](auto& file) { describe_text_and_file(io, file); });
  io.list(deck.frames, 1 + 12 * sizeof(double), [&](auto& frame) { describe_frame(io, frame); });
  io.array(deck.id_offsets);
  io.array(deck.node_runs);
  io.array(deck.node_line);
  io.array(deck.shell_runs);
  io.array(deck.shell_line);
  io.array(deck.left_out_elements);
  describe_hidden(io, deck.hidden);
  io.array(deck.held_files);
  describe_counts(io, deck.element_cards);
  describe_counts(io, deck.left_out_cards);
  describe_map(io, deck.element_kinds);
  io.number(deck.time_step);
  describe_contacts(io, deck.contacts);
  io.maybe(deck.length_unit, [&](auto& unit) { io.choice(unit, 2); });
  io.array(deck.taken.nodes);
  io.array(deck.taken.elements);
  io.list(deck.companions, kTextBytes, [&](auto& file) { describe_path(io, file.relative); });
  io.list(deck.unread_files, 4 + kTextBytes, [&](auto& unread) {
    io.number(unread.file);
    io.text(unread.keyword);
  });
  io.list(deck.warnings, 3 * kTextBytes + 16, [&](auto& warning) {
    io.text(warning.file);
    io.number(warning.line);
    io.text(warning.kind);
    io.text(warning.message);
    io.number(warning.count);
  });
  io.list(deck.missing_files, kTextBytes, [&](auto& name) { io.text(name); });
}

template <class Archive>
void describe_part(Archive& io, auto& part) {
  io.number(part.id);
  io.text(part.name);
  io.flag(part.defined);
  for (auto* number : {&part.section, &part.material}) io.maybe(*number, [&](auto& value) { io.number(value); });
  for (auto* number : {&part.thickness, &part.density, &part.youngs_modulus, &part.poissons_ratio})
    io.maybe(*number, [&](auto& value) { io.number(value); });
  io.flag(part.limits_time_step);
}

template <class Archive>
void describe_elements(Archive& io, auto& block) {
  io.array(block.id);
  io.array(block.part);
  io.array(block.first_node);
  io.array(block.nodes);
}

template <class Archive>
void describe_arrays(Archive& io, auto& model) {
  io.array(model.node_ids);
  io.array(model.positions);
  io.array(model.node_holds);
  io.array(model.shell_ids);
  io.array(model.shell_nodes);
  io.array(model.shell_parts);
  io.array(model.shell_thickness);
}

void describe_model(HandOverWriter& to, const Model& model) {
  describe_arrays(to, model);
  to.array(*model.midside);
  to.list(*model.parts, 0, [&](const Part& part) { describe_part(to, part); });
  for (const std::shared_ptr<const ElementBlock>& block : model.elements)
    if (block) describe_elements(to, *block);
}

void describe_model(HandOverReader& from, Model& model) {
  describe_arrays(from, model);
  auto midside = std::make_shared<std::vector<mesh::MidsideNodes>>();
  from.array(*midside);
  model.midside = std::move(midside);
  auto parts = std::make_shared<std::vector<Part>>();
  from.list(*parts, 8 + kTextBytes + 8, [&](Part& part) { describe_part(from, part); });
  model.parts = std::move(parts);
  for (std::size_t c = 0; c < mesh::kElementClassCount; ++c) {
    if (static_cast<ElementClass>(c) == ElementClass::shell) continue;
    auto block = std::make_shared<ElementBlock>();
    describe_elements(from, *block);
    model.elements[c] = std::move(block);
  }
}

void write_all(HandOverWriter& to, const mesh::deck::OpenedDeck& opened) {
  to.number(kHandOverMagic);
  describe_deck(to, *opened.deck);
  describe_references(to, *opened.deck->references);
  describe_model(to, opened.model);
}

template <class T>
std::vector<T> whole(const mesh::ChunkedArray<T>& array) {
  std::vector<T> all;
  all.reserve(array.size());
  for (std::size_t c = 0; c < array.chunk_count(); ++c) all.insert(all.end(), array.chunk(c).begin(), array.chunk(c).end());
  return all;
}

tl::unexpected<Error> damaged(const std::string& what) {
  return fail("the deck as it was handed over", "it is damaged: " + what + "; it isn't used");
}

/// What follows from the arrays. Errors: ids that must differ are equal.
Result<void> make_indices(Model& model, Deck& deck) {
  model.node_index = std::make_shared<const mesh::IdIndex>(whole(model.node_ids));
  if (!model.node_index->duplicates().empty()) return damaged("two nodes have one id");
  model.shell_index = std::make_shared<const mesh::IdIndex>(whole(model.shell_ids));
  deck.shared_shell_ids = model.shell_index->duplicates();
  if (deck.shared_shell_ids.empty()) return {};
  auto second = std::make_shared<std::vector<mesh::ShellIndex>>();
  for (std::size_t i = 0; i < model.shell_count(); ++i)
    if (model.shell_index->find(model.shell_ids[i]) != i) second->push_back(mesh::ShellIndex(i));
  std::stable_sort(second->begin(), second->end(),
                   [&](mesh::ShellIndex a, mesh::ShellIndex b) { return model.shell_ids[a.value] < model.shell_ids[b.value]; });
  const auto same_id = [&](mesh::ShellIndex a, mesh::ShellIndex b) { return model.shell_ids[a.value] == model.shell_ids[b.value]; };
  if (std::adjacent_find(second->begin(), second->end(), same_id) != second->end()) return damaged("three shells have one id");
  model.second_shells = std::move(second);
  return {};
}

void put_files(Deck& deck, const std::filesystem::path& folder) {
  std::vector<Hash128> hashes;
  deck.on_disk = std::make_shared<mesh::deck::OnDisk>();
  for (mesh::deck::SourceFile& file : deck.files) {
    file.path = folder / file.relative;
    hashes.push_back(hash128(file.bytes.bytes()));
    deck.on_disk->files.push_back({file.bytes.identity(), hashes.back(), true});
  }
  for (mesh::deck::CompanionFile& file : deck.companions) file.path = folder / file.relative;
  deck.content = mesh::deck::content_hash(deck.files, hashes);
}

}  // namespace

std::size_t hand_over_size(const mesh::deck::OpenedDeck& opened) {
  HandOverWriter counter;
  write_all(counter, opened);
  return counter.size();
}

void write_hand_over(const mesh::deck::OpenedDeck& opened, std::span<std::byte> out) {
  HandOverWriter writer(out);
  write_all(writer, opened);
}

Result<mesh::deck::OpenedDeck> read_hand_over(std::span<const std::byte> bytes, const std::filesystem::path& folder) {
  HandOverReader from(bytes);
  std::uint64_t magic = 0;
  from.number(magic);
  if (magic != kHandOverMagic) return damaged("it doesn't begin as one, or is of another version");
  auto deck = std::make_shared<Deck>();
  HandedReferences handed;
  mesh::deck::OpenedDeck opened;
  describe_deck(from, *deck);
  describe_references(from, handed);
  describe_model(from, opened.model);
  if (!from.ok()) return damaged(from.fault());
  if (!from.at_end()) return damaged("something follows its end");
  if (const std::string fault = fault_of(*deck, handed, opened.model); !fault.empty()) return damaged(fault);
  if (Result<void> made = make_indices(opened.model, *deck); !made) return fail(std::move(made.error()));
  put_files(*deck, folder);
  deck->last_ids = mesh::deck::last_ids_of(*deck, opened.model);
  unite(deck->taken.nodes);
  unite(deck->taken.elements);
  deck->references = std::make_shared<const mesh::References>(
      mesh::References::of(std::move(handed.referrers), std::move(handed.references), std::move(handed.unread)));
  opened.model.adjacency = std::make_shared<const mesh::Adjacency>(build_adjacency(opened.model));
  opened.deck = std::move(deck);
  return opened;
}

}  // namespace prismesh::ipc
