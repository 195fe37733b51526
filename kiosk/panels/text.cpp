#include "kiosk/panels/text.h"

#include <algorithm>
#include <cmath>
#include <system_error>

#include <fmt/format.h>

#include "base/readable_number.h"

namespace prismesh::kiosk::panels {
namespace {

constexpr std::string_view kNoBreakSpace = "\u00a0";
constexpr std::string_view kEllipsis = "\u2026";

/// Length of the UTF-8 character at the beginning of the bytes; 0 if there is no valid one.
std::size_t utf8_length(std::string_view bytes) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(bytes[i]); };
  const unsigned char first = byte(0);
  const std::size_t length = first < 0x80                    ? 1
                             : first >= 0xc2 && first < 0xe0 ? 2
                             : first >= 0xe0 && first < 0xf0 ? 3
                             : first >= 0xf0 && first < 0xf5 ? 4
                                                             : 0;
  if (length == 0 || length > bytes.size()) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte(i) & 0xc0u) != 0x80u) return 0;
  const bool overlong = (first == 0xe0 && byte(1) < 0xa0) || (first == 0xf0 && byte(1) < 0x90);
  const bool impossible = (first == 0xed && byte(1) >= 0xa0) || (first == 0xf4 && byte(1) >= 0x90);
  return overlong || impossible ? 0 : length;
}

std::vector<std::string_view> characters(std::string_view text) {
  std::vector<std::string_view> out;
  while (!text.empty()) {
    const std::size_t length = std::max<std::size_t>(1, utf8_length(text));
    out.push_back(text.substr(0, length));
    text.remove_prefix(length);
  }
  return out;
}

}  // namespace

std::string grouped(std::uint64_t number) {
  const std::string digits = std::to_string(number);
  std::string out;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) out += kNoBreakSpace;
    out += digits[i];
  }
  return out;
}

std::string metric_words(const std::string& name) {
  std::string words = name;
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

std::string length_text(double length, std::string_view unit) { return fmt::format("{}{}{}", readable(length, 4), kNoBreakSpace, unit); }

std::string printable(std::string_view bytes) {
  std::string out;
  while (!bytes.empty()) {
    const std::size_t length = utf8_length(bytes);
    const auto first = static_cast<unsigned char>(bytes[0]);
    if (length == 0 || first < 0x20 || first == 0x7f) {
      out += fmt::format("\\x{:02x}", first);
      bytes.remove_prefix(1);
    } else {
      out += bytes.substr(0, length);
      bytes.remove_prefix(length);
    }
  }
  return out;
}

std::string printable_lines(std::string_view bytes) {
  std::string out;
  for (std::size_t end = bytes.find('\n'); end != std::string_view::npos; end = bytes.find('\n')) {
    out += printable(bytes.substr(0, end)) + '\n';
    bytes.remove_prefix(end + 1);
  }
  return out + printable(bytes);
}

std::string elide_middle(const std::string& text, double available, const std::function<double(std::string_view)>& width) {
  if (text.empty() || width(text) <= available) return text;
  const std::vector<std::string_view> all = characters(text);
  const auto kept = [&](std::size_t count) {
    const std::size_t tail = (count + 1) / 2, head = count - tail;  // the end of a file name says more than its beginning
    std::string out;
    for (std::size_t i = 0; i < head; ++i) out += all[i];
    out += kEllipsis;
    for (std::size_t i = all.size() - tail; i < all.size(); ++i) out += all[i];
    return out;
  };
  std::size_t low = 0, high = all.size() - 1;
  while (low < high) {
    const std::size_t middle = (low + high + 1) / 2;
    if (width(kept(middle)) <= available)
      low = middle;
    else
      high = middle - 1;
  }
  return kept(low);
}

std::string break_at_spaces(std::string_view text, double available, const std::function<double(std::string_view)>& width) {
  std::string out(text);
  std::size_t line = 0, space = std::string::npos;
  for (std::size_t i = 0; i <= out.size(); ++i) {
    if (i < out.size() && out[i] != ' ' && out[i] != '\n') continue;
    if (space != std::string::npos && width(std::string_view(out).substr(line, i - line)) > available) {
      out[space] = '\n';
      line = space + 1;
    }
    space = i;
    if (i < out.size() && out[i] == '\n') {
      line = i + 1;
      space = std::string::npos;
    }
  }
  return out;
}

std::vector<std::string> completions(const std::string& typed, std::size_t limit) {
  const std::size_t slash = typed.rfind('/');
  const std::string folder = slash == std::string::npos ? "" : typed.substr(0, slash + 1);
  const std::string piece = slash == std::string::npos ? typed : typed.substr(slash + 1);
  std::vector<std::string> out;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder.empty() ? "." : folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (!name.starts_with(piece) || (name.starts_with('.') && !piece.starts_with('.'))) continue;
    std::error_code unreadable;
    out.push_back(folder + name + (entry->is_directory(unreadable) ? "/" : ""));
  }
  std::sort(out.begin(), out.end());
  if (out.size() > limit) out.resize(limit);
  return out;
}

std::string common_beginning(const std::vector<std::string>& texts) {
  if (texts.empty()) return {};
  std::string common = texts.front();
  for (const std::string& text : texts)
    common.resize(static_cast<std::size_t>(std::mismatch(common.begin(), common.end(), text.begin(), text.end()).first - common.begin()));
  return common;
}

}  // namespace prismesh::kiosk::panels
