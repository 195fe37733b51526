#include "ipc/store/manifest.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <optional>

#include "ipc/store/utf8.h"

namespace prismesh::ipc::store {

namespace {

constexpr std::string_view kFirstLine = "prismesh-set 1";
constexpr std::string_view kMainWord = "main ";
constexpr std::uint64_t kMaxSetBytes = std::numeric_limits<std::int64_t>::max();

tl::unexpected<Error> wrong_line(long line, std::string message) { return fail("manifest", line, std::move(message)); }

/// A number without sign or leading zeros.
std::optional<std::uint64_t> whole_number(std::string_view text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || text.empty() || (text.size() > 1 && text[0] == '0')) return std::nullopt;
  return value;
}

/// "HASH SIZE PATH"
std::optional<SetFile> parse_set_file(std::string_view line) {
  const std::size_t first = line.find(' ');
  if (first == std::string_view::npos) return std::nullopt;
  const std::size_t second = line.find(' ', first + 1);
  if (second == std::string_view::npos) return std::nullopt;
  const std::optional<ContentHash> hash = parse_content_hash(line.substr(0, first));
  const std::optional<std::uint64_t> bytes = whole_number(line.substr(first + 1, second - first - 1));
  if (!hash || !bytes) return std::nullopt;
  return SetFile{*hash, *bytes, std::string(line.substr(second + 1))};
}

/// A path as a folder on the way to another stands anywhere before it ("a", "a-b", "a/c").
std::optional<std::string> folder_among(const std::vector<SetFile>& files, const std::string& path) {
  for (std::size_t slash = path.find('/'); slash != std::string::npos; slash = path.find('/', slash + 1)) {
    const std::string folder = path.substr(0, slash);
    const auto found =
        std::lower_bound(files.begin(), files.end(), folder, [](const SetFile& a, const std::string& b) { return a.path < b; });
    if (found != files.end() && found->path == folder) return folder;
  }
  return std::nullopt;
}

/// Takes the next line off the text; nothing: the text has no further whole line.
std::optional<std::string_view> take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  if (end == std::string_view::npos) return std::nullopt;
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end + 1);
  return line;
}

Result<void> add_set_file(std::string_view line, long number, Manifest& manifest, std::uint64_t& bytes) {
  std::optional<SetFile> file = parse_set_file(line);
  if (!file) return wrong_line(number, "must be a SHA-256, a size and a path, with one blank between them");
  if (const std::string fault = path_fault(file->path); !fault.empty()) return wrong_line(number, "the path " + fault);
  if (!manifest.files.empty() && !(manifest.files.back().path < file->path))
    return wrong_line(number, "paths must ascend, and none may come twice");
  if (const auto folder = folder_among(manifest.files, file->path)) return wrong_line(number, "'" + *folder + "' is a file and a folder");
  if (file->bytes > kMaxSetBytes - bytes) return wrong_line(number, "the files are too large");
  if (manifest.files.size() == kMaxSetFiles) return wrong_line(number, "there are more than " + std::to_string(kMaxSetFiles) + " files");
  bytes += file->bytes;
  manifest.files.push_back(std::move(*file));
  return {};
}

}  // namespace

std::uint64_t Manifest::bytes() const {
  std::uint64_t sum = 0;
  for (const SetFile& file : files) sum += file.bytes;
  return sum;
}

std::string path_fault(std::string_view path) {
  if (path.empty()) return "is empty";
  if (path.size() > kMaxSetPath) return "is longer than " + std::to_string(kMaxSetPath) + " bytes";
  if (path.front() == '/') return "is absolute";
  if (!is_plain_utf8(path)) return "isn't UTF-8 text without control characters";
  if (path.find('\\') != std::string_view::npos) return "has a backslash";
  std::size_t depth = 0;
  for (std::size_t begin = 0; begin <= path.size(); ++depth) {
    const std::size_t end = std::min(path.find('/', begin), path.size());
    const std::string_view part = path.substr(begin, end - begin);
    if (part.empty()) return "has an empty part";
    if (part == "." || part == "..") return "has the part '" + std::string(part) + "'";
    if (part.size() > 255) return "has a part of more than 255 bytes";
    begin = end + 1;
  }
  if (depth > kMaxSetDepth) return "has more than " + std::to_string(kMaxSetDepth) + " parts";
  return {};
}

std::string encode_manifest(const Manifest& manifest) {
  std::string text = std::string(kFirstLine) + "\n" + std::string(kMainWord) + manifest.main + "\n";
  for (const SetFile& file : manifest.files) text += file.hash.hex() + " " + std::to_string(file.bytes) + " " + file.path + "\n";
  return text;
}

Result<Manifest> decode_manifest(std::string_view text) {
  if (text.size() > kMaxManifestBytes) return fail("manifest", "is longer than " + std::to_string(kMaxManifestBytes) + " bytes");
  if (take_line(text) != kFirstLine) return wrong_line(1, "must be '" + std::string(kFirstLine) + "'");
  const std::optional<std::string_view> main = take_line(text);
  if (!main || !main->starts_with(kMainWord)) return wrong_line(2, "must be 'main' and the path of the main file");
  Manifest manifest;
  manifest.main = main->substr(kMainWord.size());
  std::uint64_t bytes = 0;
  long number = 2;
  while (!text.empty()) {
    ++number;
    const std::optional<std::string_view> line = take_line(text);
    if (!line) return wrong_line(number, "the line has no end");
    if (const Result<void> added = add_set_file(*line, number, manifest, bytes); !added) return fail(added.error());
  }
  const bool main_is_there =
      std::any_of(manifest.files.begin(), manifest.files.end(), [&](const SetFile& file) { return file.path == manifest.main; });
  if (!main_is_there) return wrong_line(2, "the main file isn't one of the files");
  return manifest;
}

ContentHash model_hash(std::string_view manifest_text) { return sha256(manifest_text); }

}  // namespace prismesh::ipc::store
