#include "daemon/intake/access/audit_log.h"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>

#include "base/json/write.h"

namespace prismesh::intake {

namespace {

constexpr std::size_t kHashDigits = 64;
constexpr std::size_t kMaxAuditBytes = std::size_t{256} << 20;

/// "HASH {..}": the hash is of the hash before and of the object.
std::string chained_hash(std::string_view before, std::string_view object) {
  ipc::store::Sha256 hash;
  hash.add(before);
  hash.add(object);
  return hash.hash().hex();
}

}  // namespace

Result<AuditChain> check_audit(std::string_view text, const std::string& file) {
  AuditChain chain;
  for (std::size_t end = text.find('\n'); end != std::string_view::npos; end = text.find('\n', chain.whole_bytes)) {
    const std::string_view line = text.substr(chain.whole_bytes, end - chain.whole_bytes);
    const auto number = static_cast<long>(chain.lines + 1);
    if (line.size() <= kHashDigits || line[kHashDigits] != ' ' ||
        line.substr(0, kHashDigits) != chained_hash(chain.last, line.substr(kHashDigits + 1)))
      return fail(file, number, "the audit log was changed: this line, or one before it, isn't as it was written");
    chain.last = line.substr(0, kHashDigits);
    ++chain.lines;
    chain.whole_bytes = end + 1;
  }
  return chain;
}

Result<AuditLog> AuditLog::open(const ipc::store::Folder& folder, const std::string& name, std::string& note) {
  Result<ipc::Descriptor> file = folder.has(name) ? folder.read_and_write(name) : folder.create(name, 0600);
  if (!file) return fail(file.error());
  AuditLog log(std::move(*file), folder.path() / name);
  const Result<std::string> text = folder.content(name, kMaxAuditBytes);
  if (!text) return fail(text.error());
  const Result<AuditChain> chain = check_audit(*text, log.shown_.string());
  if (!chain) return fail(chain.error());
  log.size_ = chain->whole_bytes;
  log.count_ = chain->lines;
  log.last_ = chain->last;
  if (chain->whole_bytes < text->size()) {
    if (::ftruncate(log.file_.get(), static_cast<off_t>(chain->whole_bytes)) != 0)
      return fail(log.shown_.string(), std::generic_category().message(errno));
    note = log.shown_.string() + ": the last line was cut off and is gone";
  }
  if (const Result<void> flushed = folder.flush(); !flushed) return fail(flushed.error());
  return log;
}

Result<void> AuditLog::add(const AuditEntry& entry) {
  json::Json object = json::Json::object();
  object["when_s"] = entry.when_s;
  object["who"] = entry.who;
  object["what"] = entry.what;
  object["about"] = entry.about;
  const std::string text = json::to_line(object);
  const std::string hash = chained_hash(last_, text);
  const std::string line = hash + " " + text + "\n";
  Result<void> written = ipc::store::write_at(file_, line, size_, shown_);
  if (written) written = ipc::store::flush_file(file_, shown_);
  if (!written) return written;
  size_ += line.size();
  ++count_;
  last_ = hash;
  return {};
}

}  // namespace prismesh::intake
