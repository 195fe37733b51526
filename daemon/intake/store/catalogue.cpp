#include "daemon/intake/store/catalogue.h"

#include <sqlite3.h>

#include <cstdio>
#include <string_view>

#include "ipc/store/record_text.h"

namespace prismesh::intake {

namespace {

namespace fs = std::filesystem;

constexpr const char* kTables =
    "CREATE TABLE IF NOT EXISTS models (model TEXT PRIMARY KEY, name TEXT NOT NULL, who TEXT NOT NULL, when_s INTEGER NOT NULL,"
    " bytes INTEGER NOT NULL, derived_from TEXT, damaged INTEGER NOT NULL, record TEXT NOT NULL) WITHOUT ROWID;"
    "CREATE INDEX IF NOT EXISTS newest ON models (when_s DESC, model);"
    "CREATE INDEX IF NOT EXISTS owners ON models (who);";

/// A prepared statement with its values.
class Statement {
 public:
  Statement(sqlite3* database, const char* text) { sqlite3_prepare_v2(database, text, -1, &statement_, nullptr); }
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;
  ~Statement() { sqlite3_finalize(statement_); }

  Statement& bind(std::string_view text) {
    sqlite3_bind_text(statement_, ++bound_, text.data(), static_cast<int>(text.size()), SQLITE_TRANSIENT);
    return *this;
  }
  Statement& bind(std::int64_t number) {
    sqlite3_bind_int64(statement_, ++bound_, number);
    return *this;
  }
  Statement& bind_nothing() {
    ++bound_;
    return *this;
  }
  /// SQLITE_ROW, SQLITE_DONE or an error.
  int step() { return statement_ == nullptr ? SQLITE_ERROR : sqlite3_step(statement_); }
  std::string text(int column) {
    const auto* begin = reinterpret_cast<const char*>(sqlite3_column_text(statement_, column));
    return begin == nullptr ? std::string() : std::string(begin, static_cast<std::size_t>(sqlite3_column_bytes(statement_, column)));
  }
  std::int64_t number(int column) { return sqlite3_column_int64(statement_, column); }

 private:
  sqlite3_stmt* statement_ = nullptr;
  int bound_ = 0;
};

/// For LIKE, where % and _ stand for other text.
std::string escaped(std::string_view words) {
  std::string text;
  for (const char c : words) {
    if (c == '%' || c == '_' || c == '!') text += '!';
    text += c;
  }
  return text;
}

}  // namespace

void Catalogue::Close::operator()(sqlite3* database) const { sqlite3_close_v2(database); }

tl::unexpected<Error> Catalogue::failure() const {
  const char* reason = database_ ? sqlite3_errmsg(database_.get()) : "it isn't open";
  return fail(file_.string(), "the catalogue can't be used: " + std::string(reason));
}

Result<void> Catalogue::run(const char* statement) const {
  if (sqlite3_exec(database_.get(), statement, nullptr, nullptr, nullptr) != SQLITE_OK) return failure();
  return {};
}

Result<void> Catalogue::open_file() {
  sqlite3* opened = nullptr;
  const int code = sqlite3_open_v2(file_.c_str(), &opened, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_NOFOLLOW, nullptr);
  database_.reset(opened);
  if (code != SQLITE_OK) return failure();
  // One process uses it. Everything that it says is in the records, which are flushed by themselves.
  if (Result<void> set =
          run("PRAGMA locking_mode=EXCLUSIVE; PRAGMA journal_mode=DELETE; PRAGMA synchronous=NORMAL; PRAGMA trusted_schema=OFF;");
      !set)
    return set;
  Statement check(database_.get(), "PRAGMA quick_check(1)");
  if (check.step() != SQLITE_ROW) return failure();
  if (check.text(0) != "ok") return fail(file_.string(), "the catalogue is damaged: " + check.text(0));
  return run(kTables);
}

Result<Catalogue> Catalogue::open(const fs::path& file, std::vector<std::string>& notes) {
  Catalogue catalogue(file);
  const Result<void> opened = catalogue.open_file();
  if (opened) return catalogue;
  notes.push_back(opened.error().text() + "; it is made anew from the records");
  catalogue.database_.reset();
  std::error_code ignored;
  fs::rename(file, file.string() + ".damaged", ignored);
  fs::remove(file.string() + "-journal", ignored);
  if (const Result<void> made = catalogue.open_file(); !made) return fail(made.error());
  return catalogue;
}

Result<void> Catalogue::insert(const CatalogueEntry& entry) const {
  const ipc::store::ModelRecord& record = entry.record;
  Statement statement(database_.get(), "INSERT OR REPLACE INTO models VALUES (?, ?, ?, ?, ?, ?, ?, ?)");
  statement.bind(record.model.hex()).bind(record.name).bind(record.who).bind(record.when_s).bind(static_cast<std::int64_t>(record.bytes));
  if (record.derived_from)
    statement.bind(record.derived_from->hex());
  else
    statement.bind_nothing();
  statement.bind(std::int64_t{entry.damaged}).bind(ipc::store::encode_record(record));
  if (statement.step() != SQLITE_DONE) return failure();
  return {};
}

Result<void> Catalogue::fill(const std::vector<CatalogueEntry>& entries) {
  Result<void> done = run("BEGIN; DELETE FROM models;");
  for (const CatalogueEntry& entry : entries)
    if (done) done = insert(entry);
  if (done) done = run("COMMIT;");
  if (!done) (void)run("ROLLBACK;");
  return done;
}

Result<void> Catalogue::put(const CatalogueEntry& entry) { return insert(entry); }

Result<void> Catalogue::remove(const ipc::store::ContentHash& model) {
  Statement statement(database_.get(), "DELETE FROM models WHERE model = ?");
  if (statement.bind(model.hex()).step() != SQLITE_DONE) return failure();
  return {};
}

Result<std::vector<CatalogueEntry>> Catalogue::find(const CatalogueQuery& query) const {
  Statement statement(database_.get(),
                      "SELECT record, damaged FROM models WHERE name LIKE '%' || ? || '%' ESCAPE '!' AND (?2 = '' OR derived_from = ?2)"
                      " ORDER BY when_s DESC, model LIMIT ?3 OFFSET ?4");
  statement.bind(escaped(query.words)).bind(query.derived_from ? query.derived_from->hex() : std::string());
  statement.bind(static_cast<std::int64_t>(query.count)).bind(static_cast<std::int64_t>(query.skip));
  std::vector<CatalogueEntry> found;
  int code = statement.step();
  for (; code == SQLITE_ROW; code = statement.step()) {
    Result<ipc::store::ModelRecord> record = ipc::store::decode_record(statement.text(0), file_.string());
    if (!record) return fail(record.error());
    found.push_back({std::move(*record), statement.number(1) != 0});
  }
  if (code != SQLITE_DONE) return failure();
  return found;
}

Result<std::uint64_t> Catalogue::number(const char* text, const std::string* argument) const {
  Statement statement(database_.get(), text);
  if (argument != nullptr) statement.bind(*argument);
  if (statement.step() != SQLITE_ROW) return failure();
  return static_cast<std::uint64_t>(statement.number(0));
}

Result<std::uint64_t> Catalogue::bytes_of(const std::string& who) const {
  return number("SELECT COALESCE(SUM(bytes), 0) FROM models WHERE who = ?", &who);
}

Result<std::uint64_t> Catalogue::count() const { return number("SELECT COUNT(*) FROM models", nullptr); }

}  // namespace prismesh::intake
