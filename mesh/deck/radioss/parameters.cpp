#include "mesh/deck/radioss/parameters.h"

#include <cmath>

#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::radioss {

bool Parameters::read(std::span<const SourceFile> files, const Block& block, const Keyword& keyword) {
  const std::string_view type = keyword.word(2);
  if (type == "TEXT") return true;
  BlockLines lines(files, block);
  Line line;
  if (!lines.next(line) || !lines.next(line)) return true;  // the title, then the parameter
  const std::string_view card = trim(line.text);
  const std::size_t end = std::min(card.find_first_of(" \t"), card.size());
  if (end == 0) return true;
  double value = 0;
  const std::string_view number = trim(card.substr(end));
  if ((type != "REAL" && type != "INTEGER") || number.empty() || !parse_real(number, value)) return false;
  values_[{keyword.word(1) == "LOCAL" ? block.context : 0, std::string(card.substr(0, end))}] = value;
  return true;
}

std::optional<double> Parameters::real(std::string_view field, std::span<const Context> contexts, std::uint32_t context) const {
  field = trim(field);
  double value = 0;
  if (parse_real(field, value)) return value;
  const bool negative = field.front() == '-';
  if (negative) field.remove_prefix(1);
  if (field.empty() || field.front() != '&') return std::nullopt;
  const std::string name(field.substr(1));
  for (;;) {
    if (const auto at = values_.find({context, name}); at != values_.end()) return negative ? -at->second : at->second;
    if (context == 0) return std::nullopt;
    context = contexts[context].parent;
  }
}

std::optional<std::int64_t> Parameters::integer(std::string_view field, std::span<const Context> contexts, std::uint32_t context) const {
  std::int64_t value = 0;
  if (parse_integer(trim(field), value)) return value;
  const std::optional<double> named = real(field, contexts, context);
  if (!named || *named != std::floor(*named) || std::abs(*named) >= 1e18) return std::nullopt;
  return static_cast<std::int64_t>(*named);
}

}  // namespace prismesh::mesh::deck::radioss
