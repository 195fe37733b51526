// Which shells the contacts of a deck see, and how thick they are there. Rules: docs/contact.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "mesh/contact/contact_thickness.h"
#include "mesh/model/contact_cards.h"
#include "mesh/model/model.h"
#include "mesh/model/node_set.h"
#include "mesh/model/references.h"

namespace prismesh::mesh::contact {

/// Cheap to ask; both the model and the cards must outlive it.
class DeckContacts {
 public:
  /// Finds the shells of both sides of each contact that keeps surfaces apart. `references`: of the deck, for the members of sets.
  DeckContacts(const Model& model, const ContactCards& cards, const References& references);

  bool empty() const { return sides_.empty(); }
  /// The greatest thickness that a contact gives each shell, with its rules and offsets. Shells that no contact sees have that of their
  /// section, and no offset unless every shell has.
  ContactThickness thickness() const;
  /// The first contact, in the deck's order, that keeps the shells apart; null: none does.
  const ContactCard* between(ShellIndex a, ShellIndex b) const;

 private:
  struct Side {
    bool everything = false;
    std::vector<std::uint8_t> parts;  ///< by PartIndex; empty: none
    ShellSet shells;                  ///< ascending
    const ContactSide* card = nullptr;
  };
  struct Sides {
    const ContactCard* card = nullptr;
    Side a;
    std::optional<Side> b;
    double least = 0;  ///< of a card with a gap: its min, or what the main surface gives
  };
  Side find(const ContactSide& side, const References& references) const;
  bool sees(const Side& side, ShellIndex shell) const;
  double least_of_gap(const Sides& sides, const std::vector<double>& own) const;
  GapRule rule_in(const Sides& sides, ShellIndex shell, double own) const;
  void offset(ShellIndex shell, double own, ContactThickness& thickness) const;
  double thickness_in(const ContactCard& card, const ContactSide& side, ShellIndex shell, double own) const;

  const Model& model_;
  const ContactCards& cards_;
  std::vector<Sides> sides_;
};

}  // namespace prismesh::mesh::contact
