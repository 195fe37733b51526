// Cards made from the card before: = (the same field), == (all that follow), *(x) (raised by x), =(n) (n more of the same). A card with a
// name of its own may take single fields from the card before.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "mesh/deck/nastran/card.h"

namespace prismesh::mesh::deck::nastran {

/// Whether the card, a grid point or an element, takes fields from the card before.
bool takes_fields(const Card& card);

/// The card at `offset` of a text.
Card card_at(std::string_view text, std::size_t offset);

/// Whether the card at `offset` is a replication or is replicated: its text then makes more than one card. So does text that takes fields
/// from the card before. Precondition: offset < text.size().
bool is_replicated(std::string_view text, std::size_t offset);

class Replication {
 public:
  /// The card that replications refer to from here on.
  void set_template(const Card& card);
  bool has_template() const { return has_template_; }
  void clear() { has_template_ = false; }

  /// Reads a card that begins with an equals sign. Returns the number of copies of the template, each raised once more: 1 unless it begins
  /// with =(n); 0: it isn't understood.
  std::size_t read(const Card& card);
  /// Makes the next copy, which becomes the template.
  void make(Card& copy);
  /// Puts the template's fields into a card that takes some of them. False: the template is another entry, or a field isn't understood; the
  /// card is as before.
  bool fill(Card& card) const;

  static constexpr std::size_t kMaxCopies = 100000;

 private:
  struct Field {
    std::string text;
    std::string raise;  ///< what each copy adds; empty: nothing
  };
  std::string name_;
  Layout layout_ = Layout::small;
  std::vector<Field> fields_;
  bool has_template_ = false;
  bool raised_ = false;  ///< `raise` of the fields is set
};

}  // namespace prismesh::mesh::deck::nastran
