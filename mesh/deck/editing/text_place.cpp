#include "mesh/deck/editing/text_place.h"

#include <string_view>
#include <utility>

#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck {
namespace {

constexpr std::string_view kNothingWritten = "; nothing was written";

}  // namespace

std::string place_of(const Deck& deck, std::uint32_t file, std::size_t offset) {
  return deck.files[file].path.string() + ":" + std::to_string(line_number(deck.files[file].bytes.text(), offset));
}

Error error_at(const Deck& deck, std::uint32_t file, std::size_t offset, std::string message) {
  const SourceFile& source = deck.files[file];
  return Error{source.path.string(), line_number(source.bytes.text(), offset), std::move(message)};
}

Error refusal_at(const Deck& deck, std::uint32_t file, std::size_t offset, const std::string& message) {
  return error_at(deck, file, offset, message + std::string(kNothingWritten));
}

Error refusal(const Deck& deck, const std::string& message) {
  return Error{deck.files[0].path.string(), 0, message + std::string(kNothingWritten)};
}

std::string reason_of(const Error& refusal) {
  std::string reason = refusal.text();
  if (reason.ends_with(kNothingWritten)) reason.resize(reason.size() - kNothingWritten.size());
  return reason;
}

Result<void> as_refusal(Result<void> checked) {
  if (!checked) checked.error().message += kNothingWritten;
  return checked;
}

}  // namespace prismesh::mesh::deck
