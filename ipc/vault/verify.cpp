#include <map>
#include <utility>

#include "ipc/vault/fetch.h"
#include "ipc/vault/objects.h"

namespace prismesh::ipc::vault {

namespace {

constexpr int kReadTries = 3;

class Verification {
 public:
  Verification(Vault& vault, const Progress& progress) : vault_(vault), progress_(progress) {}

  Result<Verified> run(const std::vector<store::ModelRecord>& all) {
    for (const store::ModelRecord& model : all) {
      if (const Result<void> verified = verify_model(model.model); !verified) return fail(verified.error());
      ++found_.models;
      fraction_ = static_cast<double>(found_.models) / static_cast<double>(all.size());
    }
    return std::move(found_);
  }

 private:
  /// What an object holds. Nothing: `fault` says why.
  struct Read {
    std::optional<std::string> content;
    std::string fault;
  };

  void note(const store::ContentHash& model, const std::string& file, std::string object, std::string fault) {
    found_.faults.push_back({model, file, std::move(object), std::move(fault)});
  }

  Result<Read> read(const std::string& object, std::size_t max_bytes, const std::optional<store::ContentHash>& hash) {
    if (vault_.is_stopped() || (progress_ && !progress_(fraction_))) return fail(cancelled());
    Result<std::optional<std::string>> content = vault_.get_unchecked(object, max_bytes);
    // A line may change what comes: only what is wrong each time is damage.
    const auto is_wrong = [&] { return content && *content && hash && store::sha256(**content) != *hash; };
    for (int tries = 1; tries < kReadTries && is_wrong(); ++tries) {
      Result<std::optional<std::string>> again = vault_.get_unchecked(object, max_bytes);
      if (!again && again.error().kind != ErrorKind::over_limit) return fail(again.error());
      if (!again || !*again) break;  // a store may put away what it found damaged itself: the first answer tells more
      content = std::move(again);
    }
    if (!content) {
      if (content.error().kind == ErrorKind::over_limit) return Read{std::nullopt, "is longer than it was"};
      return fail(content.error());
    }
    if (!*content) return Read{std::nullopt, "isn't there"};
    ++found_.objects;
    found_.bytes += (*content)->size();
    if (hash && store::sha256(**content) != *hash) return Read{std::nullopt, "has other bytes than its name says"};
    return Read{std::move(*content), ""};
  }

  Result<void> verify_model(const store::ContentHash& model) {
    const Result<Read> text = read(model_object(model), store::kMaxManifestBytes, model);
    if (!text) return fail(text.error());
    if (!text->content) {
      note(model, "", model_object(model), text->fault);
      return {};
    }
    const Result<store::Manifest> manifest = store::decode_manifest(*text->content);
    if (!manifest) {
      note(model, "", model_object(model), "is no manifest: " + manifest.error().message);
      return {};
    }
    for (const store::SetFile& file : manifest->files) {
      const std::pair is(file.hash, file.bytes);  // a manifest may name a hash with wrong sizes
      auto known = files_.find(is);
      if (known == files_.end()) {
        Result<std::vector<VaultFault>> faults = faults_of(file);
        if (!faults) return fail(faults.error());
        known = files_.emplace(is, std::move(*faults)).first;
      }
      for (const VaultFault& fault : known->second) note(model, file.path, fault.object, fault.fault);
    }
    return {};
  }

  Result<std::vector<VaultFault>> faults_of(const store::SetFile& file) {
    std::vector<VaultFault> faults;
    std::vector<store::ContentHash> pieces;
    if (piece_count(file.bytes) == 1) pieces.push_back(file.hash);
    if (piece_count(file.bytes) > 1) {
      const Result<Read> list = read(list_object(file.hash), kMaxListBytes, std::nullopt);
      if (!list) return fail(list.error());
      const Result<std::vector<store::ContentHash>> read_list =
          list->content ? decode_pieces(*list->content, file.bytes) : Result<std::vector<store::ContentHash>>(fail("", list->fault));
      if (!read_list) return std::vector<VaultFault>{{{}, {}, list_object(file.hash), read_list.error().message}};
      pieces = *read_list;
    }
    store::Sha256 whole;
    std::uint64_t bytes = 0;
    for (const store::ContentHash& piece : pieces) {
      const Result<Read> content = read(piece_object(piece), kPieceBytes, piece);
      if (!content) return fail(content.error());
      if (!content->content) {
        faults.push_back({{}, {}, piece_object(piece), content->fault});
      } else {
        whole.add(*content->content);
        bytes += content->content->size();
      }
    }
    if (faults.empty() && (bytes != file.bytes || whole.hash() != file.hash))
      faults.push_back({{}, {}, pieces.size() > 1 ? list_object(file.hash) : "", "doesn't name the pieces of this file"});
    return faults;
  }

  Vault& vault_;
  const Progress& progress_;
  Verified found_;
  std::map<std::pair<store::ContentHash, std::uint64_t>, std::vector<VaultFault>> files_;  ///< those that were read
  double fraction_ = 0;
};

}  // namespace

Result<Verified> verify(Vault& vault, const std::optional<std::string>& wanted, const Progress& progress) {
  std::vector<store::ModelRecord> all;
  if (wanted) {
    const Result<store::ModelRecord> one = find_model(vault, *wanted);
    if (!one) return fail(one.error());
    all.push_back(*one);
  } else {
    Result<std::vector<store::ModelRecord>> listed = models(vault);
    if (!listed) return fail(listed.error());
    all = std::move(*listed);
  }
  return Verification(vault, progress).run(all);
}

}  // namespace prismesh::ipc::vault
