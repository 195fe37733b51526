// The files of a deck as those of a stored model. Inner to cli.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/error.h"
#include "cli/commands.h"
#include "ipc/store/local_files.h"
#include "mesh/deck/data/deck.h"

namespace prismesh::cli {

struct DeckFiles {
  std::vector<ipc::store::LocalFile> files;
  std::string main;            ///< the path of the main file in the model
  bool leaves_folder = false;  ///< some files lie outside the main file's folder
  /// Files that lie outside the main file's folder, by the names in the deck or by links in them.
  std::vector<std::filesystem::path> outside;
};

/// All files that the deck was read from, and its companions, as they lie to each other. Where some lie outside the main file's folder, the
/// model begins at the folder that holds all. Errors: a file lies above all folders.
Result<DeckFiles> files_of(const mesh::deck::Deck& deck);

/// Opens the deck, tells of missing includes, and names its files. Errors: as open_deck and files_of.
Result<DeckFiles> files_of_deck(const std::filesystem::path& path, const Common& common, const Context& context);

}  // namespace prismesh::cli
