// Cards made from the card before: = (the same field), == (all that follow), *(x) (raised by x), =(n) (n more of the same).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "mesh/deck/nastran/card.h"

namespace prismesh::mesh::deck::nastran {

class Replication {
 public:
  /// The card that replications refer to from here on.
  void set_template(const Card& card);
  bool has_template() const { return has_template_; }
  void clear() { has_template_ = false; }

  /// What a card beginning with an equals sign asks for: copies of the template, each raised once more; 1 unless it begins with =(n).
  /// 0: it isn't understood.
  std::size_t read(const Card& card);
  /// The next copy, which becomes the template.
  void make(Card& copy);

  static constexpr std::size_t kMaxCopies = 100000;

 private:
  struct Field {
    std::string text;
    std::string raise;  ///< by how much, each time; empty: it stays
  };
  std::string name_;
  Layout layout_ = Layout::small;
  std::vector<Field> fields_;
  bool has_template_ = false;
  bool raised_ = false;  ///< the fields know by how much
};

}  // namespace prismesh::mesh::deck::nastran
