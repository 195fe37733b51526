// Finds entries that name grid points, elements or properties, besides the elements themselves.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/deck/nastran/card.h"
#include "mesh/deck/nastran/elements.h"
#include "mesh/model/references.h"

namespace prismesh::mesh::deck::nastran {

/// Where a card stands.
struct CardPlace {
  std::uint32_t file = 0;
  std::size_t offset = 0;
  std::size_t end = 0;  ///< one past its last line's last character
};

/// The data field at which the list of ids of such a card begins. Precondition: it has one.
std::size_t list_field(std::string_view name);

/// Collects what the cards of a piece of text name. Consecutive cards with the same name and set are one referrer; each list is one of its
/// own, since ids may be added to it.
class ReferenceReader {
 public:
  /// What an element names besides its own nodes, and all nodes of rigid elements.
  void read_element(const Card& card, const ElementForm& form, const std::vector<std::int64_t>& nodes, const CardPlace& place);
  /// False: it isn't known what the card names.
  bool read(const Card& card, const CardPlace& place);
  void read_unread(std::string_view name, const CardPlace& place);
  /// Reads SET commands of case control, in `text` from `begin` to `end`. The commands that use a set tell whether it holds grid points or
  /// elements.
  void read_case_control(std::string_view text, std::uint32_t file, std::size_t begin, std::size_t end);
  References finish();

 private:
  void begin_card(std::string_view keyword, std::int64_t id, bool alone, const CardPlace& place);
  void flush();
  void add(Referred referred, ReferenceRole role, std::int64_t first, std::int64_t last, std::int64_t step = 1);
  void add_one(Referred referred, const Card& card, std::size_t field);
  void add_list(const std::vector<std::string_view>& words, Referred referred, bool both);
  void add_list(const Card& card, std::size_t begin, Referred referred, bool both = false);
  void add_pattern(const Card& card, std::string_view pattern);
  bool read_special(const Card& card, const CardPlace& place);
  void read_case_command(const std::string& statement, const CardPlace& place);
  void read_case_set(const std::string& statement, const CardPlace& place);

  References references_;
  bool open_ = false;  ///< `referrer_` is being collected
  bool alone_ = false;
  Referrer referrer_;
  UnreadText unread_;  ///< being collected; empty keyword: none
  std::size_t line_ = 0;
  std::vector<std::pair<std::string, CardPlace>> case_sets_;
  std::map<std::int64_t, std::set<Referred>> case_uses_;  ///< what a set holds, by the commands that use it
};

}  // namespace prismesh::mesh::deck::nastran
