#include "kiosk/tools/files/shelf.h"

#include <algorithm>
#include <chrono>
#include <string>
#include <system_error>

#include <fmt/format.h>

#include "base/counted.h"
#include "ipc/intake/client.h"
#include "ipc/store/reading.h"
#include "kiosk/link/wanted_deck.h"

namespace prismesh::kiosk::tools::files {

namespace {

constexpr std::size_t kMostModels = 50;
/// The kiosk stands still meanwhile. systemd listens for an intake that can't start, and nobody answers there.
constexpr std::chrono::milliseconds kPatience{300};

std::string age_words(std::int64_t seconds) {
  if (seconds < 60) return "just now";
  if (seconds < 3600) return counted(static_cast<std::size_t>(seconds / 60), "minute") + " ago";
  if (seconds < 86'400) return counted(static_cast<std::size_t>(seconds / 3600), "hour") + " ago";
  return counted(static_cast<std::size_t>(seconds / 86'400), "day") + " ago";
}

std::string size_of(const ipc::store::ModelRecord& record) {
  if (record.figures) return counted(record.figures->elements, "element");
  return record.bytes < 1'000'000 ? fmt::format("{} kB", (record.bytes + 999) / 1000) : fmt::format("{} MB", record.bytes / 1'000'000);
}

}  // namespace

std::vector<BrowseRow> shelf_of(std::span<const ipc::store::ModelRecord> records, std::int64_t now_s) {
  std::vector<BrowseRow> rows;
  for (const ipc::store::ModelRecord& record : records) {
    BrowseRow row{link::stored_name(record.model.hex()), record.name + "   from " + record.who, "", false};
    if (record.derived_from) {
      const auto origin = std::ranges::find(records, *record.derived_from, &ipc::store::ModelRecord::model);
      row.words += origin != records.end() ? ", edited from that of " + origin->who : ", edited";
    }
    row.detail = size_of(record) + ", " + age_words(now_s - record.when_s);
    rows.push_back(std::move(row));
  }
  return rows;
}

std::vector<BrowseRow> read_shelf(const std::filesystem::path& intake_socket) {
  std::error_code missing;
  if (intake_socket.empty() || !std::filesystem::exists(intake_socket, missing)) return {};
  Result<ipc::IntakeClient> intake = ipc::IntakeClient::connect(intake_socket, "prismesh-kiosk", kPatience);
  if (!intake) return {};
  const Result<ipc::IntakeAnswer> answer = intake->call(ipc::GetIntake{}, kPatience);
  const auto* info = answer ? std::get_if<ipc::IntakeInfo>(&*answer) : nullptr;
  if (info == nullptr) return {};
  const Result<ipc::store::Reader> store = ipc::store::Reader::open(info->store);
  if (!store) return {};
  const Result<std::vector<ipc::store::ModelRecord>> records = store->records(kMostModels);
  if (!records) return {};
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  std::vector<BrowseRow> rows = shelf_of(*records, std::chrono::duration_cast<std::chrono::seconds>(now).count());
  rows.push_back({std::string(kPairName), "Pair a computer or a browser with this station", "shows a code", false});
  return rows;
}

std::vector<std::string> pairing_words(const ipc::MadePairingCode& made, const ipc::IntakeInfo& info) {
  std::string fingerprint;
  for (std::size_t i = 0; i < info.fingerprint.size(); ++i)
    fingerprint += (i > 0 && i % 4 == 0 ? " " : "") + std::string(1, info.fingerprint[i]);
  return {"Code: " + made.code,
          fmt::format("Good for one computer and {}. There: prismesh pair STATION CODE, or a browser at https://STATION:{}/",
                      counted(static_cast<std::size_t>(made.lifetime_s / 60), "minute"), info.address.substr(info.address.rfind(':') + 1)),
          "In a browser compare first: the SHA-256 of its certificate must be", fingerprint};
}

std::vector<std::string> ask_for_pairing(const std::filesystem::path& intake_socket) {
  const auto refused = [](const Error& error) { return std::vector{"No pairing code: " + error.text()}; };
  Result<ipc::IntakeClient> intake = ipc::IntakeClient::connect(intake_socket, "prismesh-kiosk", kPatience);
  if (!intake) return refused(intake.error());
  const Result<ipc::IntakeAnswer> told = intake->call(ipc::GetIntake{}, kPatience);
  if (!told) return refused(told.error());
  const Result<ipc::IntakeAnswer> answer = intake->call(ipc::MakePairingCode{"", {"read", "upload"}}, kPatience);
  if (!answer) return refused(answer.error());
  const auto* info = std::get_if<ipc::IntakeInfo>(&*told);
  const auto* made = std::get_if<ipc::MadePairingCode>(&*answer);
  if (info == nullptr || made == nullptr) return refused({"prismesh-intake", 0, "answered something else"});
  return pairing_words(*made, *info);
}

}  // namespace prismesh::kiosk::tools::files
