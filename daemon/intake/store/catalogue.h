// The catalogue: an index of the models in the store, in SQLite. It holds nothing that the records in the store don't say, so it can be
// made anew from them at any time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "ipc/store/record.h"

struct sqlite3;

namespace prismesh::intake {

struct CatalogueEntry {
  ipc::store::ModelRecord record;
  bool damaged = false;  ///< some of its bytes in the store are
};

struct CatalogueQuery {
  std::string words;  ///< a piece of the name; empty: all
  std::optional<ipc::store::ContentHash> derived_from;
  std::uint64_t skip = 0;
  std::uint64_t count = 100;
};

class Catalogue {
 public:
  /// Opens or makes it. A file that is no sound database is put aside as FILE.damaged, and told of in `notes`. Errors: the disk.
  static Result<Catalogue> open(const std::filesystem::path& file, std::vector<std::string>& notes);

  /// Makes it say exactly this.
  Result<void> fill(const std::vector<CatalogueEntry>& entries);
  Result<void> put(const CatalogueEntry& entry);
  Result<void> remove(const ipc::store::ContentHash& model);

  /// The newest first.
  Result<std::vector<CatalogueEntry>> find(const CatalogueQuery& query) const;
  /// Of all models that the name has published.
  Result<std::uint64_t> bytes_of(const std::string& who) const;
  Result<std::uint64_t> count() const;

 private:
  struct Close {
    void operator()(sqlite3* database) const;
  };
  explicit Catalogue(std::filesystem::path file) : file_(std::move(file)) {}
  Result<void> open_file();
  Result<void> run(const char* statement) const;
  Result<void> insert(const CatalogueEntry& entry) const;
  tl::unexpected<Error> failure() const;
  Result<std::uint64_t> number(const char* statement, const std::string* argument) const;

  std::filesystem::path file_;
  std::unique_ptr<sqlite3, Close> database_;
};

}  // namespace prismesh::intake
