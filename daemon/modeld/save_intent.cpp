#include "daemon/modeld/save_intent.h"

#include <string>

#include <unistd.h>

#include "base/file.h"
#include "ipc/wire/byte_stream.h"

namespace prismesh::modeld {

namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMagic = 0x3345'5641'5352'5250;  // "PRRSAVE3"

}  // namespace

SaveIntent intent_of(const mesh::deck::StagedSave& save) {
  SaveIntent intent;
  for (std::size_t i = 0; i < save.files().size(); ++i) {
    const StagedFiles::File& place = save.places()[i];
    intent.files.push_back({place.target, place.temporary, save.files()[i].before, save.files()[i].after});
  }
  return intent;
}

Result<void> write_save_intent(const fs::path& path, const SaveIntent& intent) {
  ipc::ByteWriter out;
  out.put(kMagic);
  out.put(intent.deck_before);
  out.put(intent.deck_after);
  out.put(intent.records);
  out.put(intent.records_of_next);
  out.put(std::uint64_t{intent.files.size()});
  for (const SaveIntent::File& file : intent.files) {
    out.put(file.target.string());
    out.put(file.temporary.string());
    out.put(file.before);
    out.put(file.after);
  }
  out.put(hash128(out.bytes()));
  const std::string_view content(reinterpret_cast<const char*>(out.bytes().data()), out.bytes().size());
  const PendingFile file{path, {content}};
  return replace_files(std::span(&file, 1));
}

Result<SaveIntent> read_save_intent(const fs::path& path) {
  const Result<FileBytes> bytes = read_file(path);
  if (!bytes) return fail(bytes.error());
  const auto damaged = [&] { return fail(path.string(), "the record of a save that was under way is damaged"); };
  const std::span<const std::byte> all = bytes->bytes();
  if (all.size() < sizeof(Hash128)) return damaged();
  const std::span<const std::byte> said = all.first(all.size() - sizeof(Hash128));
  if (ipc::ByteReader(all.last(sizeof(Hash128))).get<Hash128>() != hash128(said)) return damaged();
  ipc::ByteReader in(said);
  if (in.get<std::uint64_t>() != kMagic) return damaged();
  SaveIntent intent;
  intent.deck_before = in.get<Hash128>();
  intent.deck_after = in.get<Hash128>();
  intent.records = in.get<std::uint64_t>();
  intent.records_of_next = in.get<std::uint64_t>();
  const auto files = in.get<std::uint64_t>();
  for (std::uint64_t i = 0; i < files && in.ok(); ++i) {
    SaveIntent::File& file = intent.files.emplace_back();
    file.target = in.text();
    file.temporary = in.text();
    file.before = in.get<Hash128>();
    file.after = in.get<Hash128>();
  }
  if (!in.ok() || !in.at_end()) return damaged();
  return intent;
}

Result<SaveOutcome> settle_save(const SaveIntent& intent) {
  const Result<SaveOutcome> outcome = mesh::deck::finish_replacing(intent.files);
  if (!outcome) return outcome;
  for (const SaveIntent::File& file : intent.files) ::unlink(file.temporary.c_str());
  return outcome;
}

}  // namespace prismesh::modeld
