// A deck of one file with a bit of everything.
#pragma once

#include <filesystem>
#include <fstream>
#include <random>
#include <utility>

#include "mesh/deck/open.h"

namespace prismesh::ipc {

inline constexpr const char* kSmallDeck =
    "*KEYWORD\n*NODE\n"
    "       1             0.0             0.0             0.0\n"
    "       2             1.0             0.0             0.0\n"
    "       3             1.0             1.0             0.0\n"
    "       4             0.0             1.0             0.0\n"
    "*ELEMENT_SHELL\n       1       7       1       2       3       4\n       2       7       1       2       3       9\n"
    "*ELEMENT_BEAM\n       5       8       1       2\n"
    "*SET_NODE_LIST\n         5\n         1         2\n"
    "*CONTACT_AUTOMATIC_SINGLE_SURFACE\n         0\n\n\n"
    "*PART\nplate\n         7         3         2\n*SECTION_SHELL\n         3         2\n       1.2       1.2       1.2       1.2\n*END\n";

inline mesh::deck::OpenedDeck open_small_deck() {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("prismesh-hand-over-" + std::to_string(std::random_device{}()));
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "main.k") << kSmallDeck;
  auto opened = mesh::deck::open(folder / "main.k");
  std::filesystem::remove_all(folder);
  return std::move(opened.value());
}

}  // namespace prismesh::ipc
