#include "mesh/deck/lsdyna/block_lines.h"

#include <cstring>
#include <optional>

namespace prismesh::mesh::deck::lsdyna {
namespace {

std::optional<EncryptedPart> next_encrypted_part(std::string_view text, std::size_t begin, std::size_t end) {
  while (begin < end) {
    const void* found = ::memmem(text.data() + begin, end - begin, kEncryptedBegin.data(), kEncryptedBegin.size());
    if (!found) return std::nullopt;
    const auto at = static_cast<std::size_t>(static_cast<const char*>(found) - text.data());
    if (at == 0 || text[at - 1] == '\n') {
      const std::size_t last = text.substr(0, end).find(kEncryptedEnd, at);
      const std::size_t line = last == std::string_view::npos ? last : text.find('\n', last);
      return EncryptedPart{at, line == std::string_view::npos || line >= end ? end : line + 1};
    }
    begin = at + 1;
  }
  return std::nullopt;
}

}  // namespace

std::vector<EncryptedPart> encrypted_parts(std::string_view text, std::size_t begin, std::size_t end) {
  std::vector<EncryptedPart> parts;
  for (auto part = next_encrypted_part(text, begin, end); part; part = next_encrypted_part(text, part->end, end)) parts.push_back(*part);
  return parts;
}

bool BlockLines::next(Line& line) {
  while (!lines_.next(line)) {
    if (passed_ == encrypted_->size()) return false;
    const std::size_t begin = (*encrypted_)[passed_++].end;
    lines_ = Lines(text_, begin, passed_ < encrypted_->size() ? (*encrypted_)[passed_].begin : end_);
  }
  return true;
}

}  // namespace prismesh::mesh::deck::lsdyna
