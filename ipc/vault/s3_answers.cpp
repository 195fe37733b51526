#include "ipc/vault/s3_answers.h"

#include <charconv>

#include <pugixml.hpp>

#include "ipc/store/utf8.h"

namespace prismesh::ipc::vault {

namespace {

constexpr std::size_t kMaxCode = 100, kMaxMessage = 500;
constexpr std::size_t kMaxToken = 4096;  // it goes into an address

/// Only texts, and the references that XML itself defines.
bool read_xml(pugi::xml_document& document, std::string_view body) {
  constexpr unsigned kOptions = pugi::parse_cdata | pugi::parse_escapes | pugi::parse_eol;
  return document.load_buffer(body.data(), body.size(), kOptions, pugi::encoding_utf8).status == pugi::status_ok;
}

tl::unexpected<Error> no_list() { return fail("", "its answer is no list of objects; is it an S3 store?"); }

std::string shown(const char* text, std::size_t max_bytes) {
  const std::string_view view(text);
  return view.size() <= max_bytes && store::is_plain_utf8(view) ? std::string(view) : std::string();
}

}  // namespace

Result<ObjectList> parse_object_list(std::string_view body) {
  pugi::xml_document document;
  if (!read_xml(document, body)) return no_list();
  const pugi::xml_node root = document.child("ListBucketResult");
  if (!root) return no_list();
  ObjectList list;
  for (const pugi::xml_node each : root.children("Contents")) {
    const std::string_view bytes(each.child_value("Size"));
    ListedObject object{each.child_value("Key"), 0};
    const auto [end, failed] = std::from_chars(bytes.data(), bytes.data() + bytes.size(), object.bytes);
    if (object.key.empty() || bytes.empty() || failed != std::errc{} || end != bytes.data() + bytes.size()) return no_list();
    list.objects.push_back(std::move(object));
  }
  const std::string_view goes_on(root.child_value("IsTruncated"));
  if (goes_on != "true" && goes_on != "false") return no_list();
  if (goes_on == "true") list.next = root.child_value("NextContinuationToken");
  if (goes_on == "true" && list.next.empty()) return no_list();
  if (list.next.size() > kMaxToken) return fail("", "says in more than " + std::to_string(kMaxToken) + " bytes where its list goes on");
  return list;
}

S3Refusal parse_refusal(std::string_view body) {
  pugi::xml_document document;
  if (!read_xml(document, body)) return {};
  const pugi::xml_node root = document.child("Error");
  S3Refusal refusal{shown(root.child_value("Code"), kMaxCode), shown(root.child_value("Message"), kMaxMessage),
                    shown(root.child_value("Endpoint"), kMaxCode)};
  if (refusal.code.empty()) return {};
  return refusal;
}

}  // namespace prismesh::ipc::vault
