// Reads /INTER/TYPE7 and /INTER/TYPE19, as far as they say which shells see each other and at which distance, with the groups that are
// their sides. Source: Radioss Reference Guide, "/INTER/TYPE7", "/INTER/TYPE19"; OpenRadioss, hm_read_inter_type07 and definter.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "mesh/deck/radioss/block.h"
#include "mesh/deck/radioss/definitions.h"
#include "mesh/model/contact_cards.h"

namespace prismesh::mesh::deck::radioss {

class ContactReader {
 public:
  /// Takes the block if it is an interface or a group that may be its side. The block must outlive this.
  void take(const Block& block, const Keyword& keyword, const DeckTables& tables);
  /// The interfaces whose sides are known: of parts, nodes, shells, segments, or of groups of these.
  ContactCards cards(const DeckTables& tables) const;

 private:
  struct Taken {
    const Block* block = nullptr;
    Keyword keyword;
  };
  using GroupName = std::pair<std::string, std::int64_t>;  ///< "GRNOD", 18
  struct Followed {
    std::set<std::pair<GroupName, bool>> groups;  ///< with whether they are taken away: each is followed once
    int depth = 0;
  };
  bool add_members(const GroupName& name, const DeckTables& tables, bool away, Followed& followed, ContactSide& side) const;
  bool add_members_of(const Taken& group, const DeckTables& tables, bool away, Followed& followed, ContactSide& side) const;
  std::optional<ContactCard> read(const Taken& interface, const DeckTables& tables) const;

  std::vector<Taken> interfaces_;
  std::map<GroupName, Taken> groups_;
};

}  // namespace prismesh::mesh::deck::radioss
