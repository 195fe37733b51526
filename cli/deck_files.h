// The files of a deck as those of a stored model. Inner to cli.
#pragma once

#include <string>
#include <vector>

#include "base/error.h"
#include "ipc/remote/push.h"
#include "mesh/deck/data/deck.h"

namespace prismesh::cli {

struct DeckFiles {
  std::vector<ipc::remote::LocalFile> files;
  std::string main;            ///< the path of the main file in the model
  bool leaves_folder = false;  ///< some files lie outside the main file's folder
};

/// All files that the deck was read from, and its companions, as they lie to each other. Where some lie outside the main file's folder, the
/// model begins at the folder that holds all. Errors: a file lies above all folders.
Result<DeckFiles> files_of(const mesh::deck::Deck& deck);

}  // namespace prismesh::cli
