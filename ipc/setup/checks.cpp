#include "ipc/setup/checks.h"

#include <arpa/inet.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <optional>
#include <utility>

#include "drivers/display/profile.h"

namespace prismesh::ipc {
namespace {

constexpr std::size_t kMaxLabel = 63;
constexpr std::size_t kMaxNameServers = 3;
constexpr std::size_t kMaxZone = 60, kMaxPage = 20, kMaxText = 80;

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// IPv4 or IPv6, in the order of the network.
struct Address {
  std::array<std::uint8_t, 16> bytes{};
  int bits = 32;
  bool operator==(const Address&) const = default;
  bool is_four() const { return bits == 32; }
};

std::optional<Address> parse_address(std::string_view text) {
  const std::string ended(text);
  if (ended.find('\0') != std::string::npos) return std::nullopt;  // inet_pton would not see what follows
  Address address;
  if (::inet_pton(AF_INET, ended.c_str(), address.bytes.data()) == 1) return address;
  address.bits = 128;
  if (::inet_pton(AF_INET6, ended.c_str(), address.bytes.data()) == 1) return address;
  return std::nullopt;
}

/// Nothing: it isn't a number of one to three digits.
std::optional<int> parse_small_number(std::string_view text) {
  int value = 0;
  if (text.empty() || text.size() > 3 || !std::ranges::all_of(text, is_digit)) return std::nullopt;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

bool bit_of(const Address& address, int at) {
  const auto byte = address.bytes[static_cast<std::size_t>(at / 8)];
  return ((byte >> (7 - at % 8)) & 1) != 0;
}

bool same_network(const Address& a, const Address& b, int prefix) {
  if (a.bits != b.bits) return false;
  for (int at = 0; at < prefix; ++at)
    if (bit_of(a, at) != bit_of(b, at)) return false;
  return true;
}

bool host_bits_are_all(const Address& address, int prefix, bool value) {
  for (int at = prefix; at < address.bits; ++at)
    if (bit_of(address, at) != value) return false;
  return true;
}

bool is_link_local_six(const Address& address) {
  return !address.is_four() && address.bytes[0] == 0xfe && (address.bytes[1] & 0xc0) == 0x80;
}

/// Why no machine of a network can have it; empty: one can.
std::string_view unusable(const Address& address) {
  if (address.is_four()) {
    if (address.bytes[0] == 0) return "addresses that begin with 0 are none of a machine";
    if (address.bytes[0] == 127) return "addresses that begin with 127 stay in their machine";
    if (address.bytes[0] >= 224) return "addresses from 224 on are of groups, not of a machine";
    return {};
  }
  if (address.bytes[0] == 0xff) return "addresses that begin with ff are of groups, not of a machine";
  if (address == Address{{}, 128}) return ":: is no address of a machine";
  Address loop{{}, 128};
  loop.bytes[15] = 1;
  if (address == loop) return "::1 stays in its machine";
  return {};
}

struct Prefixed {
  Address address;
  int prefix = 0;
};

Result<Prefixed> parse_prefixed(const std::string& text) {
  const auto wrong = [](std::string_view why) { return fail("address", std::string(why)); };
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos)
    return wrong(parse_address(text) ? "the prefix is missing: write /24 behind it for the mask 255.255.255.0"
                                     : "write it like 192.168.1.20/24 or fd00::20/64");
  const std::optional<Address> address = parse_address(std::string_view(text).substr(0, slash));
  if (!address) return wrong("write it like 192.168.1.20/24 or fd00::20/64");
  const std::optional<int> prefix = parse_small_number(std::string_view(text).substr(slash + 1));
  if (!prefix || *prefix < 1 || *prefix > address->bits)
    return wrong(address->is_four() ? "the prefix behind the / is a number from 1 to 32"
                                    : "the prefix behind the / is a number from 1 to 128");
  if (const std::string_view why = unusable(*address); !why.empty()) return wrong(why);
  if (address->is_four() && *prefix <= 30) {
    if (host_bits_are_all(*address, *prefix, false)) return wrong("that is the network's own address: a machine has another end");
    if (host_bits_are_all(*address, *prefix, true)) return wrong("that is the address of all machines of the network: one has another end");
  }
  return Prefixed{*address, *prefix};
}

Result<void> check_gateway(const std::string& text, const Prefixed& own) {
  if (text.empty()) return {};
  const std::optional<Address> gateway = parse_address(text);
  if (!gateway) return fail("gateway", "write it like 192.168.1.1, or leave it empty");
  if (gateway->bits != own.address.bits) return fail("gateway", "it isn't of the same kind as the address: one is IPv4, the other IPv6");
  if (const std::string_view why = unusable(*gateway); !why.empty()) return fail("gateway", std::string(why));
  if (*gateway == own.address) return fail("gateway", "that is this station's own address");
  if (is_link_local_six(*gateway)) return {};
  if (!same_network(*gateway, own.address, own.prefix))
    return fail("gateway", "it doesn't lie in the network of the address: compare both, and the prefix behind the /");
  if (own.address.is_four() && own.prefix <= 30 &&
      (host_bits_are_all(*gateway, own.prefix, false) || host_bits_are_all(*gateway, own.prefix, true)))
    return fail("gateway", "that is the address of the network or of all its machines, not of one");
  return {};
}

int days_of_month(int year, int month) {
  constexpr std::array kDays{31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  const bool leap = (year % 4 == 0 && year % 100 != 0) || year % 400 == 0;
  return kDays[static_cast<std::size_t>(month - 1)] + (month == 2 && leap ? 1 : 0);
}

/// Digits where the pattern has a d, its other signs where they stand.
bool has_shape(std::string_view text, std::string_view pattern) {
  return std::equal(text.begin(), text.end(), pattern.begin(), pattern.end(),
                    [](char c, char p) { return p == 'd' ? is_digit(c) : c == p; });
}

int number_at(std::string_view text, std::size_t at, std::size_t digits) {
  int value = 0;
  std::from_chars(text.data() + at, text.data() + at + digits, value);
  return value;
}

Result<void> check_page(std::string_view page) {
  const bool word = !page.empty() && page.size() <= kMaxPage && std::ranges::all_of(page, [](char c) { return c >= 'a' && c <= 'z'; });
  return word ? Result<void>() : fail("page", "a page's name is a word of small letters");
}

}  // namespace

Result<void> check_name(std::string_view name) {
  const auto wrong = [](const char* why) { return fail("name", why); };
  if (name.empty()) return wrong("a station needs a name");
  if (name.find('.') != std::string_view::npos) return wrong("write the name without the domain: letters, digits and hyphens, no points");
  if (!std::ranges::all_of(name, [](char c) { return is_letter(c) || is_digit(c) || c == '-'; }))
    return wrong("a name has letters from a to z, digits and hyphens only");
  if (name.size() > kMaxLabel) return wrong("a name has at most 63 letters");
  if (name.front() == '-' || name.back() == '-') return wrong("a name begins and ends with a letter or a digit");
  if (std::ranges::all_of(name, is_digit)) return wrong("a name has at least one letter: digits alone are taken for an address");
  std::string small(name);
  std::ranges::transform(small, small.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  if (small == "localhost") return wrong("localhost is the name by which every machine calls itself");
  return {};
}

Result<void> check_network(const SetNetwork& network) {
  if (network.dhcp) {
    if (!network.address.empty() || !network.gateway.empty() || !network.dns.empty())
      return fail("address", "with DHCP the network gives the addresses: none is set");
    return {};
  }
  const Result<Prefixed> own = parse_prefixed(network.address);
  if (!own) return fail(own.error());
  if (Result<void> gateway = check_gateway(network.gateway, *own); !gateway) return gateway;
  if (network.dns.size() > kMaxNameServers) return fail("dns", "at most three name servers are asked");
  for (const std::string& text : network.dns) {
    const std::optional<Address> server = parse_address(text);
    if (!server) return fail("dns", "write addresses like 192.168.1.1, with a blank between two, or leave it empty");
    if (const std::string_view why = unusable(*server); !why.empty()) return fail("dns", std::string(why));
  }
  return {};
}

Result<void> check_profile(std::string_view profile) {
  const auto known = drivers::display::built_in_profiles();
  const bool is_known = std::ranges::any_of(known, [&](const drivers::display::Profile& each) { return each.name == profile; });
  return is_known ? Result<void>() : fail("profile", "there is no such display profile");
}

Result<void> check_calibration(const std::string& profile) {
  const Result<drivers::display::Profile> read = drivers::display::parse_profile(profile, "calibration");
  if (!read) return fail("calibration", read.error().message);
  const bool file_name = !read->name.empty() && read->name.size() <= kMaxText &&
                         std::ranges::all_of(read->name, [](char c) { return is_letter(c) || is_digit(c) || c == '-'; });
  if (!file_name) return fail("calibration", "a profile that becomes a file has a name of letters, digits and hyphens");
  if (check_profile(read->name)) return fail("calibration", "it has the name of a built-in profile");
  return {};
}

Result<void> check_zone(std::string_view zone) {
  const auto wrong = [] { return fail("zone", "a zone is written like Europe/Berlin, or UTC"); };
  if (zone.empty() || zone.size() > kMaxZone) return wrong();
  for (std::size_t start = 0; start <= zone.size();) {
    const std::size_t end = std::min(zone.find('/', start), zone.size());
    const std::string_view word = zone.substr(start, end - start);
    if (word.empty() || !is_letter(word.front())) return wrong();
    if (!std::ranges::all_of(word, [](char c) { return is_letter(c) || is_digit(c) || c == '_' || c == '-' || c == '+'; })) return wrong();
    start = end + 1;
  }
  return {};
}

Result<void> check_clock(const SetClock& clock) {
  if (!has_shape(clock.date, "dddd-dd-dd")) return fail("date", "write the day like 2026-11-28");
  const int year = number_at(clock.date, 0, 4), month = number_at(clock.date, 5, 2), day = number_at(clock.date, 8, 2);
  if (year < 2020 || year > 2099) return fail("date", "the year must lie between 2020 and 2099");
  if (month < 1 || month > 12) return fail("date", "the month must lie between 01 and 12");
  if (day < 1 || day > days_of_month(year, month)) return fail("date", "that month has no such day");
  if (!has_shape(clock.time, "dd:dd")) return fail("time", "write the time like 16:05");
  if (number_at(clock.time, 0, 2) > 23 || number_at(clock.time, 3, 2) > 59)
    return fail("time", "the time must lie between 00:00 and 23:59");
  return {};
}

Result<void> check_setup(const SetupRequest& request) {
  struct Check {
    Result<void> operator()(const GetSetup&) const { return {}; }
    Result<void> operator()(const SetName& m) const { return check_name(m.name); }
    Result<void> operator()(const SetNetwork& m) const { return check_network(m); }
    Result<void> operator()(const SetProfile& m) const { return check_profile(m.profile); }
    Result<void> operator()(const SetCalibration& m) const { return check_calibration(m.profile); }
    Result<void> operator()(const SetPairing&) const { return {}; }
    Result<void> operator()(const SetZone& m) const { return check_zone(m.zone); }
    Result<void> operator()(const SetClock& m) const { return check_clock(m); }
    Result<void> operator()(const KeepPage& m) const { return check_page(m.page); }
    Result<void> operator()(const FinishSetup&) const { return {}; }
  };
  return std::visit(Check{}, request);
}

}  // namespace prismesh::ipc
