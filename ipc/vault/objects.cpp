#include "ipc/vault/objects.h"

#include <array>
#include <charconv>
#include <chrono>

#include "ipc/store/choosing.h"
#include "ipc/store/utf8.h"

namespace prismesh::ipc::vault {

namespace {

constexpr std::string_view kPieces = "pieces/", kLists = "lists/";
constexpr std::string_view kListLine = "prismesh-pieces 1\n";
constexpr std::size_t kHashDigits = 64;
constexpr std::size_t kDigitsOfPart = 200;
static_assert(2 * store::kMaxNameBytes <= 2 * kDigitsOfPart);
constexpr std::chrono::seconds kClocksApart = std::chrono::minutes(30);  // a store takes clocks that are 15 min apart from its own

std::string hex_of(std::string_view text) {
  constexpr std::string_view kHexDigits = "0123456789abcdef";
  std::string digits;
  for (const char c : text) {
    digits += kHexDigits[static_cast<unsigned char>(c) >> 4];
    digits += kHexDigits[static_cast<unsigned char>(c) & 15];
  }
  return digits;
}

std::optional<std::string> text_of_hex(std::string_view digits) {
  std::string text;
  if (digits.size() % 2 != 0) return std::nullopt;
  for (std::size_t i = 0; i < digits.size(); i += 2) {
    unsigned value = 0;
    const auto [end, failed] = std::from_chars(digits.data() + i, digits.data() + i + 2, value, 16);
    if (failed != std::errc{} || end != digits.data() + i + 2) return std::nullopt;
    text += static_cast<char>(value);
  }
  return text;
}

/// A number that ends at the next `-`, which is taken off too.
template <class T>
bool take_number(std::string_view& text, T& number) {
  const std::size_t end = text.find('-');
  if (end == std::string_view::npos) return false;
  const auto [stop, failed] = std::from_chars(text.data(), text.data() + end, number);
  if (failed != std::errc{} || stop != text.data() + end) return false;
  text.remove_prefix(end + 1);
  return true;
}

}  // namespace

std::string piece_object(const store::ContentHash& piece) { return std::string(kPieces) + piece.hex(); }
std::string list_object(const store::ContentHash& file) { return std::string(kLists) + file.hex(); }
std::string model_object(const store::ContentHash& model) { return std::string(kModels) + model.hex(); }

std::optional<store::ContentHash> model_of_object(std::string_view object) {
  if (!object.starts_with(kModels)) return std::nullopt;
  return store::parse_content_hash(object.substr(kModels.size()));
}

bool is_model_name(std::string_view text) {
  return !text.empty() && text.size() <= store::kMaxNameBytes && store::is_plain_utf8(text) && !store::may_be_hash(text);
}

std::string name_object(const store::ModelRecord& record) {
  std::string digits = hex_of(record.name);
  if (digits.size() > kDigitsOfPart) digits.insert(kDigitsOfPart, "/");
  return std::string(kNames) + record.model.hex() + "/" + std::to_string(record.when_s) + "-" + std::to_string(record.bytes) + "-" +
         std::to_string(record.files) + "-" + digits;
}

std::optional<store::ModelRecord> record_of_object(std::string_view object) {
  const std::string_view whole = object;
  store::ModelRecord record;
  if (!object.starts_with(kNames)) return std::nullopt;
  object.remove_prefix(kNames.size());
  const auto model = store::parse_content_hash(object.substr(0, kHashDigits));
  if (!model || object.size() <= kHashDigits || object[kHashDigits] != '/') return std::nullopt;
  record.model = *model;
  object.remove_prefix(kHashDigits + 1);
  if (!take_number(object, record.when_s) || !take_number(object, record.bytes) || !take_number(object, record.files)) return std::nullopt;
  std::string digits(object);
  if (digits.size() > kDigitsOfPart && digits[kDigitsOfPart] == '/') digits.erase(kDigitsOfPart, 1);
  const std::optional<std::string> name = text_of_hex(digits);
  if (!name || !is_model_name(*name)) return std::nullopt;
  record.name = *name;
  return name_object(record) == whole ? std::optional(record) : std::nullopt;
}

std::int64_t name_time(const store::ModelRecord& name, std::int64_t now_s) {
  return name.when_s - now_s > kClocksApart.count() ? 0 : name.when_s;
}

bool is_newer_name(const store::ModelRecord& a, const store::ModelRecord& b, std::int64_t now_s) {
  const std::int64_t of_a = name_time(a, now_s), of_b = name_time(b, now_s);
  return of_a != of_b ? of_a > of_b : a.name > b.name;
}

std::uint64_t piece_count(std::uint64_t file_bytes) { return file_bytes / kPieceBytes + (file_bytes % kPieceBytes != 0 ? 1 : 0); }

std::string encode_pieces(std::span<const store::ContentHash> pieces) {
  std::string text(kListLine);
  for (const store::ContentHash& piece : pieces) text += piece.hex() + "\n";
  return text;
}

Result<std::vector<store::ContentHash>> decode_pieces(std::string_view text, std::uint64_t file_bytes) {
  std::vector<store::ContentHash> pieces;
  const std::uint64_t count = piece_count(file_bytes);
  const bool has_size = text.starts_with(kListLine) && (text.size() - kListLine.size()) / (kHashDigits + 1) == count &&
                        (text.size() - kListLine.size()) % (kHashDigits + 1) == 0;
  if (!has_size) return fail("", "the list of its pieces isn't one of " + std::to_string(count));
  for (std::size_t at = kListLine.size(); at < text.size(); at += kHashDigits + 1) {
    const auto piece = store::parse_content_hash(text.substr(at, kHashDigits));
    if (!piece || text[at + kHashDigits] != '\n') return fail("", "the list of its pieces has a line that is no hash");
    pieces.push_back(*piece);
  }
  return pieces;
}

}  // namespace prismesh::ipc::vault
