// Lists of tools by what they can do.
#pragma once

#include <tuple>
#include <vector>

#include "kiosk/toolkit/tool.h"

namespace prismesh::kiosk::toolkit {

template <class... Abilities>
class AbilityLists {
 public:
  /// Adds the tool to the lists of its abilities.
  void add(Tool& tool) { (add_to<Abilities>(tool), ...); }
  /// The tools with an ability, in the order in which they were added.
  template <class Ability>
  const std::vector<Ability*>& with() const {
    return std::get<std::vector<Ability*>>(lists_);
  }

 private:
  template <class Ability>
  void add_to(Tool& tool) {
    if (auto* able = dynamic_cast<Ability*>(&tool); able != nullptr) std::get<std::vector<Ability*>>(lists_).push_back(able);
  }

  std::tuple<std::vector<Abilities*>...> lists_;
};

}  // namespace prismesh::kiosk::toolkit
