#include "kiosk/tools/contact/contact_words.h"

#include <fmt/format.h>

#include "kiosk/panels/text.h"

namespace prismesh::kiosk::tools::contact {

std::string part_words(const std::string& part, const std::string& name) {
  if (part.empty()) return "no part";
  const std::size_t colon = part.find(':');
  const std::string id = colon == std::string::npos ? part : part.substr(colon + 1);
  return name.empty() ? id : id + " " + panels::printable(name);
}

std::string depth_words(const ipc::ContactRegion& region, const std::string& unit) {
  if (!region.max_depth) return "half through";
  return panels::length_text(*region.max_depth, unit) + (region.kind == "clearance" ? " short of the gap" : " deep");
}

std::string region_words(const ipc::ContactRegion& region, const std::string& unit) {
  const char* kind = region.kind == "perforation" ? "cross" : region.kind == "penetration" ? "too close" : "gap";
  return fmt::format("{}, {}: {} and {}{}", kind, depth_words(region, unit), part_words(region.a, region.name_a),
                     part_words(region.b, region.name_b), region.joined ? ", joined" : "");
}

std::string row_words(const ipc::ContactRegion& region, const std::string& unit) {
  return fmt::format("{}: {}, {}{}", region.max_depth ? panels::length_text(*region.max_depth, unit) : "half through",
                     part_words(region.a, region.name_a), part_words(region.b, region.name_b), region.joined ? ", joined" : "");
}

std::string count_words(const ipc::Contacts& contacts) {
  std::string words;
  const auto add = [&](std::uint64_t count, const char* what) {
    if (count > 0) words += fmt::format("{}{} {}", words.empty() ? "" : ", ", panels::grouped(count), what);
  };
  add(contacts.perforations, "cross");
  add(contacts.penetrations, "too close");
  add(contacts.clearances, "within the gap");
  return words.empty() ? "nothing crosses or is too close" : words;
}

}  // namespace prismesh::kiosk::tools::contact
