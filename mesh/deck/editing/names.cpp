#include "mesh/deck/editing/names.h"

#include <algorithm>
#include <set>
#include <tuple>

#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck {
namespace {

std::string relative_place(const Deck& deck, std::uint32_t file, std::size_t offset) {
  const SourceFile& source = deck.files[file];
  return source.relative.generic_string() + ":" + std::to_string(line_number(source.bytes.text(), offset));
}

}  // namespace

std::string node_name(const Model& model, NodeIndex node) { return "node " + std::to_string(model.node_ids[node.value]); }

std::string shell_name(const Model& model, ShellIndex shell) { return "shell " + std::to_string(model.shell_ids[shell.value]); }

std::string keyword_name(Format format, const std::string& keyword) {
  const bool star = (format == Format::ls_dyna || format == Format::abaqus) && keyword.substr(0, 1) != "*";
  return (star ? "*" : "") + keyword;
}

std::string card_name(Format format, const Referrer& card) {
  const std::string keyword = keyword_name(format, card.keyword);
  return card.id > 0 ? keyword + " " + std::to_string(card.id) : keyword;
}

std::string unread_name(const Deck& deck, const UnreadText& unread) {
  return keyword_name(deck.format, unread.keyword) + " isn't read in this version, and may name it";
}

std::string has_parameter(std::string_view card) {
  const std::size_t begin = card.find('&');
  if (begin == std::string_view::npos) return "has numbers given by a parameter";
  return "has numbers given by the parameter " + std::string(card.substr(begin, card.find_first_of(" ,\t\r\n)+-*/", begin + 1) - begin));
}

std::vector<std::string> what_names(const Deck& deck, Referred referred, std::int64_t id, std::size_t max) {
  std::vector<Reference> naming = deck.references->naming(referred, id);
  const auto referrer = [&](const Reference& reference) -> const Referrer& { return deck.references->referrers()[reference.referrer]; };
  std::sort(naming.begin(), naming.end(), [&](const Reference& a, const Reference& b) {
    return std::tuple(referrer(a).file, a.card, a.referrer) < std::tuple(referrer(b).file, b.card, b.referrer);
  });
  std::vector<std::string> names;
  std::set<std::uint32_t> named;
  std::size_t more = 0;
  for (const Reference& reference : naming) {
    if (!named.insert(reference.referrer).second) continue;
    const Referrer& card = referrer(reference);
    if (names.size() < max)
      names.push_back(card_name(deck.format, card) + " (" + relative_place(deck, card.file, reference.card) + ")");
    else
      ++more;
  }
  if (more > 0) names.push_back("and " + std::to_string(more) + " more");
  return names;
}

}  // namespace prismesh::mesh::deck
