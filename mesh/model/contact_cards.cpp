#include "mesh/model/contact_cards.h"

#include <string_view>

namespace prismesh::mesh {

std::string ContactCard::name() const {
  std::string text = keyword;
  for (const std::string_view option : {"_ID", "_TITLE", "_MPP"})
    if (text.ends_with(option)) text.resize(text.size() - option.size());
  if (id > 0) text += " " + std::to_string(id);
  if (!title.empty()) text += " " + title;
  return text;
}

}  // namespace prismesh::mesh
