#include "ipc/remote/station_book.h"

#include <algorithm>
#include <cstdlib>

#include <sys/stat.h>

#include "base/json/read.h"
#include "base/json/write.h"
#include "ipc/store/record_definition.h"
#include "ipc/wire/server.h"

namespace prismesh::ipc::remote {

namespace {

constexpr const char* kBookFile = "stations.json";
constexpr const char* kBookTemporary = "stations.json.new";
constexpr std::size_t kMaxBookBytes = std::size_t{1} << 20;
constexpr std::size_t kMaxUploadPath = 200;

struct BookContent {
  std::vector<PairedStation> stations;
};

}  // namespace

}  // namespace prismesh::ipc::remote

namespace prismesh::json {

PRISMESH_JSON_OBJECT(ipc::remote::PairedStation, f.required("name", m.name), f.required("host", m.address.host),
                     f.required("port", m.address.port), f.required("fingerprint", m.fingerprint), f.required("token", m.token),
                     f("token_name", m.token_name), f("scopes", m.scopes), f("expires_s", m.expires_s));
PRISMESH_JSON_OBJECT(ipc::remote::BookContent, f.required("stations", m.stations));

}  // namespace prismesh::json

namespace prismesh::ipc::remote {

namespace {

Result<std::filesystem::path> book_folder(const std::optional<std::filesystem::path>& override) {
  if (override) return *override;
  if (const char* config = std::getenv("XDG_CONFIG_HOME"); config != nullptr && *config == '/')
    return std::filesystem::path(config) / "prismesh/stations";
  if (const char* home = std::getenv("HOME"); home != nullptr && *home == '/')
    return std::filesystem::path(home) / ".config/prismesh/stations";
  return fail("", "there is no place for the tokens of stations: set HOME or XDG_CONFIG_HOME");
}

std::string upload_name(const store::ContentHash& what) { return "upload-" + what.hex(); }

}  // namespace

Result<StationBook> StationBook::open(const std::optional<std::filesystem::path>& override) {
  const Result<std::filesystem::path> path = book_folder(override);
  if (!path) return fail(path.error());
  if (const Result<void> made = make_private_folder(*path, false); !made) return fail(made.error());
  Result<store::Folder> folder = store::Folder::open(*path);
  if (!folder) return fail(folder.error());
  return StationBook(std::move(*folder));
}

Result<std::vector<PairedStation>> StationBook::stations() const {
  if (!folder_.has(kBookFile)) return std::vector<PairedStation>();
  const std::filesystem::path path = folder_.path() / kBookFile;
  struct stat status {};
  if (::stat(path.c_str(), &status) == 0 && (status.st_mode & 0077) != 0)
    return fail(path.string(), "others may read the tokens in it; make it private (chmod 600), and pair anew if somebody may have read it");
  const Result<std::string> text = folder_.content(kBookFile, kMaxBookBytes);
  if (!text) return fail(text.error());
  BookContent content;
  const json::Json read = json::Json::parse(*text, nullptr, false);
  if (read.is_discarded()) return fail(path.string(), "is damaged; remove it, and pair with the stations anew");
  if (const json::Problem problem = json::read(read, content, json::Author::program)) return fail(path.string(), *problem);
  return std::move(content.stations);
}

Result<PairedStation> StationBook::find(const std::string& wanted) const {
  Result<std::vector<PairedStation>> known = stations();
  if (!known) return fail(known.error());
  if (known->empty()) return fail("", "this computer is paired with no station; pair it: prismesh pair STATION CODE");
  if (wanted.empty() && known->size() == 1) return std::move(known->front());
  std::string names;
  for (const PairedStation& station : *known) names += (names.empty() ? "" : ", ") + station.name;
  if (wanted.empty()) return fail("", "this computer is paired with several stations; say which: --station with one of " + names);
  const Result<StationAddress> address = parse_station_address(wanted);
  if (!address) return fail(address.error());
  for (PairedStation& station : *known)
    if (station.name == address->text()) return std::move(station);
  return fail(wanted, "this computer isn't paired with it, only with " + names + "; pair it: prismesh pair " + wanted + " CODE");
}

Result<void> StationBook::write(const std::vector<PairedStation>& stations) const {
  (void)folder_.remove(kBookTemporary);
  return folder_.replace(kBookFile, json::to_json(BookContent{stations}).dump(1) + "\n", kBookTemporary, 0600);
}

Result<void> StationBook::keep(const PairedStation& station) const {
  const Result<Descriptor> lock = lock_folder(folder_.path(), "lock", "another prismesh that pairs");
  if (!lock) return fail(lock.error());
  Result<std::vector<PairedStation>> known = stations();
  if (!known) return fail(known.error());
  std::erase_if(*known, [&](const PairedStation& each) { return each.name == station.name; });
  known->push_back(station);
  std::sort(known->begin(), known->end(), [](const PairedStation& a, const PairedStation& b) { return a.name < b.name; });
  return write(*known);
}

Result<void> StationBook::forget(const std::string& name) const {
  const Result<Descriptor> lock = lock_folder(folder_.path(), "lock", "another prismesh that pairs");
  if (!lock) return fail(lock.error());
  const Result<PairedStation> found = find(name);
  if (!found) return fail(found.error());
  Result<std::vector<PairedStation>> known = stations();
  if (!known) return fail(known.error());
  std::erase_if(*known, [&](const PairedStation& each) { return each.name == found->name; });
  return write(*known);
}

std::optional<std::string> StationBook::upload(const store::ContentHash& what) const {
  if (!folder_.has(upload_name(what))) return std::nullopt;
  const Result<std::string> path = folder_.content(upload_name(what), kMaxUploadPath);
  return path ? std::optional(*path) : std::nullopt;
}

Result<void> StationBook::keep_upload(const store::ContentHash& what, const std::string& path) const {
  const std::string temporary = upload_name(what) + ".new";
  (void)folder_.remove(temporary);
  return folder_.replace(upload_name(what), path, temporary, 0600);
}

void StationBook::forget_upload(const store::ContentHash& what) const { (void)folder_.remove(upload_name(what)); }

}  // namespace prismesh::ipc::remote
