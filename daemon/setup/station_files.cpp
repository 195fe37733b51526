#include "daemon/setup/station_files.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <optional>
#include <set>
#include <sstream>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/file.h"
#include "drivers/display/profile.h"
#include "drivers/settings/choose_profile.h"
#include "drivers/settings/settings.h"
#include "drivers/settings/string_setting.h"
#include "ipc/setup/checks.h"

namespace prismesh::setup {
namespace {

constexpr std::string_view kSettings = "etc/prismesh/prismesh.toml";
/// Before the image's own 70-wired.network: the first file that fits counts.
constexpr std::string_view kNetwork = "etc/systemd/network/70-prismesh-setup.network";
/// What the image's own file stands in for at a start, where settings didn't work. It goes before all others.
constexpr std::string_view kFallback = "run/systemd/network/00-prismesh.network";
constexpr std::string_view kNameServers = "etc/resolv.conf";
constexpr std::string_view kOwnNameServers = "# Of the station's set-up: a fixed address.\n";
/// Holds the page on which the first set-up goes on. The first boot makes it.
constexpr std::string_view kDue = "etc/prismesh/set-up-due";
constexpr std::string_view kZones = "usr/share/zoneinfo";
constexpr std::string_view kUsualListen = "0.0.0.0:7443";

std::string text_of(const std::filesystem::path& path) {
  const Result<FileBytes> bytes = read_file(path);
  return bytes ? std::string(bytes->text()) : std::string();
}

std::string_view first_line(std::string_view text) { return text.substr(0, text.find('\n')); }

Result<void> write_whole(const std::filesystem::path& path, const std::string& text) {
  const std::array<PendingFile, 1> files{{{path, {text}}}};
  return replace_files(files);
}

Result<void> remove_whole(const std::filesystem::path& path) {
  if (::unlink(path.c_str()) != 0) return errno == ENOENT ? Result<void>() : fail(path.string(), std::strerror(errno));
  return flush_folder(folder_of(path));
}

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

/// The zones that people choose from, as the list of the time zone data has them.
std::vector<std::string> zones_in(const std::filesystem::path& folder) {
  std::set<std::string> zones{"UTC"};
  std::istringstream in(text_of(folder / "zone1970.tab"));
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with('#')) continue;
    std::istringstream columns(line);
    std::string countries, place, zone;
    std::error_code none;
    if (columns >> countries >> place >> zone && ipc::check_zone(zone) && std::filesystem::is_regular_file(folder / zone, none))
      zones.insert(zone);
  }
  return {zones.begin(), zones.end()};
}

/// Behind ".. zoneinfo/" of the link; UTC without one.
std::string zone_of(const std::filesystem::path& link) {
  std::error_code none;
  const std::string target = std::filesystem::read_symlink(link, none).string();
  const std::string_view marker = "zoneinfo/";
  const std::size_t at = target.find(marker);
  const std::string zone = at == std::string::npos ? "UTC" : target.substr(at + marker.size());
  return zone == "Etc/UTC" ? "UTC" : zone;
}

Result<drivers::settings::StationSettings> settings_of(const std::string& text, const std::filesystem::path& file) {
  return drivers::settings::parse_settings_part(text, file);
}

}  // namespace

std::string network_text(const ipc::SetNetwork& network) {
  std::string text = "# Written by the station's set-up.\n[Match]\nType=ether\n\n[Network]\n";
  if (network.dhcp) return text + "DHCP=yes\nLinkLocalAddressing=yes\n";
  text += "DHCP=no\nLinkLocalAddressing=ipv6\nAddress=" + network.address + "\n";
  if (!network.gateway.empty()) text += "Gateway=" + network.gateway + "\n";
  for (const std::string& server : network.dns) text += "DNS=" + server + "\n";
  return text;
}

ipc::SetNetwork network_of(std::string_view text) {
  ipc::SetNetwork network;
  std::istringstream in{std::string(text)};
  for (std::string line; std::getline(in, line);) {
    const std::size_t equals = line.find('=');
    if (equals == std::string::npos || line.starts_with('#')) continue;
    const std::string key = line.substr(0, equals), value = line.substr(equals + 1);
    if (key == "Address") {
      network.dhcp = false;
      network.address = value;
    } else if (key == "Gateway") {
      network.gateway = value;
    } else if (key == "DNS") {
      for (std::string& server : words_of(value)) network.dns.push_back(std::move(server));
    }
  }
  if (network.dhcp || !ipc::check_network(network)) return {};
  return network;
}

std::string hosts_text(std::string_view before, const std::string& name) {
  std::istringstream in{std::string(before)};
  std::string text;
  bool named = false;
  for (std::string line; std::getline(in, line);) {
    const bool own = words_of(line).size() > 1 && words_of(line).front() == "127.0.1.1";
    if (own && std::exchange(named, true)) continue;
    text += (own ? "127.0.1.1 " + name : line) + "\n";
  }
  if (text.empty()) text = "127.0.0.1 localhost\n::1 localhost\n";
  return named ? text : text + "127.0.1.1 " + name + "\n";
}

ipc::StationSetup StationFiles::read() const {
  ipc::StationSetup station;
  std::error_code none;
  station.due = std::filesystem::exists(at(kDue), none);
  const std::string page(first_line(text_of(at(kDue))));
  if (ipc::check_setup(ipc::KeepPage{page})) station.page = page;
  station.name = first_line(text_of(at("etc/hostname")));
  station.network = network_of(text_of(at(kNetwork)));
  if (const auto settings = settings_of(text_of(at(kSettings)), at(kSettings))) {
    station.profile = settings->display.profile;
    station.pairing = !settings->remote.address.empty();
  }
  station.zone = zone_of(at("etc/localtime"));
  station.zones = zones_in(at(kZones));
  // An older name of a zone isn't in the list; it stays chosen all the same.
  if (ipc::check_zone(station.zone) && !std::ranges::binary_search(station.zones, station.zone))
    station.zones.insert(std::ranges::upper_bound(station.zones, station.zone), station.zone);
  station.clock_is_kept = std::filesystem::exists(at("run/systemd/timesync/synchronized"), none);
  ::setenv("TZ", (":" + at("etc/localtime").string()).c_str(), 1);  // NOLINT(concurrency-mt-unsafe): the program has one thread
  ::tzset();
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  ::localtime_r(&now, &local);
  station.date = fmt::format("{:04}-{:02}-{:02}", local.tm_year + 1900, local.tm_mon + 1, local.tm_mday);
  station.time = fmt::format("{:02}:{:02}", local.tm_hour, local.tm_min);
  return station;
}

Result<void> StationFiles::set_name(const std::string& name) const {
  // The hosts first: a station that has the name finds itself by it.
  const std::string hosts = hosts_text(text_of(at("etc/hosts")), name), line = name + "\n";
  const std::array<PendingFile, 2> files{{{at("etc/hosts"), {hosts}}, {at("etc/hostname"), {line}}}};
  return replace_files(files);
}

Result<void> StationFiles::set_network(const ipc::SetNetwork& network) const {
  // Nothing but the C library asks name servers, and it reads that file. Another's, such as a link, is left alone.
  const std::filesystem::path servers = at(kNameServers);
  std::error_code none;
  const auto status = std::filesystem::symlink_status(servers, none);
  const bool own =
      !std::filesystem::exists(status) || (std::filesystem::is_regular_file(status) && text_of(servers).starts_with(kOwnNameServers));
  if (own && network.dns.empty()) {
    if (Result<void> removed = remove_whole(servers); !removed) return removed;
  } else if (own) {
    std::string text(kOwnNameServers);
    for (const std::string& server : network.dns) text += "nameserver " + server + "\n";
    if (Result<void> written = write_whole(servers, text); !written) return written;
  }
  ::unlink(at(kFallback).c_str());                      // new settings are tried anew
  if (network.dhcp) return remove_whole(at(kNetwork));  // then the image's own file counts
  return write_whole(at(kNetwork), network_text(network));
}

Result<void> StationFiles::set_profile(const std::string& profile) const {
  return drivers::settings::choose_profile(at(kSettings), profile);
}

Result<void> StationFiles::set_calibration(const std::string& profile) const {
  const Result<drivers::display::Profile> read = drivers::display::parse_profile(profile, "calibration");
  if (!read) return fail(read.error());
  const std::filesystem::path name = std::filesystem::path("displays") / (read->name + ".toml");
  if (Result<void> written = drivers::display::write_profile(at(kSettings).parent_path() / name, *read); !written) return written;
  return drivers::settings::choose_profile(at(kSettings), name);
}

Result<void> StationFiles::set_pairing(bool on) const {
  const std::filesystem::path file = at(kSettings);
  const std::string before = text_of(file);
  const auto settings = settings_of(before, file);
  if (!settings) return fail(settings.error());
  if (on == !settings->remote.address.empty()) return {};  // another address that somebody has set stays
  const drivers::settings::StringSetting setting{"remote", "listen", on ? std::string(kUsualListen) : std::string(),
                                                 "where models come in from the network"};
  const Result<std::string> changed = drivers::settings::with_string(before, file.string(), setting);
  if (!changed) return fail(changed.error());
  const auto read = settings_of(*changed, file);
  if (!read) return fail(read.error());
  if (on == read->remote.address.empty()) return drivers::settings::not_changed_safely(file.string(), setting);
  return write_whole(file, *changed);
}

Result<void> StationFiles::set_zone(const std::string& zone) const {
  std::error_code none;
  const std::filesystem::path file = at(kZones) / zone;
  if (!std::filesystem::is_regular_file(file, none)) return fail("zone", "there is no such zone: choose one of the list");
  const std::filesystem::path link = at("etc/localtime"), beside = at("etc/.localtime.new");
  ::unlink(beside.c_str());
  if (::symlink(("../usr/share/zoneinfo/" + zone).c_str(), beside.c_str()) != 0) return fail(beside.string(), std::strerror(errno));
  if (::rename(beside.c_str(), link.c_str()) != 0) {
    const int why = errno;
    ::unlink(beside.c_str());
    return fail(link.string(), std::strerror(why));
  }
  return flush_folder(at("etc"));
}

Result<void> StationFiles::keep_page(const std::string& page) const {
  std::error_code none;
  if (!std::filesystem::exists(at(kDue), none)) return {};
  return write_whole(at(kDue), page + "\n");
}

Result<void> StationFiles::finish() const { return remove_whole(at(kDue)); }

}  // namespace prismesh::setup
