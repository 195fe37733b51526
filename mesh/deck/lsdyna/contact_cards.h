// Reads *CONTACT, *CONTROL_CONTACT, CNTCO of *CONTROL_SHELL and the contact card of *PART_CONTACT (LS-DYNA keyword manual, volume I), as
// far as they say which shells see each other, how thick they are and where their surfaces lie.
#pragma once

#include <cstdint>
#include <string_view>

#include "mesh/deck/lsdyna/card.h"
#include "mesh/deck/lsdyna/includes.h"
#include "mesh/deck/lsdyna/keyword.h"
#include "mesh/deck/lsdyna/parameters.h"
#include "mesh/model/contact_cards.h"

namespace prismesh::mesh::deck::lsdyna {

class ContactReader {
 public:
  /// Reads the block if it is *CONTACT, *CONTROL_CONTACT or *CONTROL_SHELL; false: it isn't. Contacts whose cards have another form (2D,
  /// with rigid surfaces, drawbeads, ...) are passed over. `context`: of the include it stands in; ids and lengths become the model's.
  bool read(std::string_view text, const Block& block, const Parameters& parameters, const IncludeContext& context);
  /// The contact card of a part.
  void read_part(std::int64_t part, const Card& card, const Parameters& parameters, const IncludeContext& context);
  /// The second card of a *SECTION_SHELL.
  void read_section(std::int64_t section, const Card& card, const Parameters& parameters);
  /// What was read; the controls of the deck count for all contacts, wherever they stand.
  ContactCards cards() const;

 private:
  struct Read {
    ContactCard card;
    bool has_own_thickness_rule = true;     ///< thickness is considered whatever the controls say
    std::int64_t thickness_considered = 0;  ///< SHLTHK of its own; 0: that of the controls
  };
  void read_contact(std::string_view text, const Block& block, const Parameters& parameters, const IncludeContext& context);
  void read_shell_control(std::string_view text, const Block& block, const Parameters& parameters);
  void read_control(std::string_view text, const Block& block, const Parameters& parameters, const IncludeContext& context);

  std::vector<Read> read_;
  std::map<std::int64_t, PartContact> of_part_;
  // *CONTROL_CONTACT.
  std::int64_t thickness_considered_ = 0;  ///< SHLTHK
  std::int64_t actual_thickness_ = 0;      ///< SSTHK
  double thickness_ = 0;                   ///< TH
  std::map<std::int64_t, double> offset_of_section_;
  std::int64_t offsets_ = 0;  ///< CNTCO of *CONTROL_SHELL
};

}  // namespace prismesh::mesh::deck::lsdyna
