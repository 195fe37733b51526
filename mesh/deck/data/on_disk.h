// What is known of a deck's files on disk, kept up to date when they are saved over.
#pragma once

#include <mutex>
#include <vector>

#include "base/file.h"
#include "base/hash.h"

namespace prismesh::mesh::deck {

/// Shared by all who hold the deck; locked while it is saved.
struct OnDisk {
  struct File {
    FileIdentity identity;
    Hash128 content;
    bool as_read = true;  ///< false: it was saved over, so it isn't what Deck::files holds any more
  };
  std::mutex mutex;
  std::vector<File> files;  ///< as Deck::files
};

}  // namespace prismesh::mesh::deck
