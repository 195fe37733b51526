// The state of a deck's files on disk. Saving in place updates it.
#pragma once

#include <mutex>
#include <vector>

#include "base/file.h"
#include "base/hash.h"

namespace prismesh::mesh::deck {

/// Shared by all copies of the deck; locked during a save.
struct OnDisk {
  struct File {
    FileIdentity identity;
    Hash128 content;
    bool as_read = true;  ///< false: it was overwritten by a save, so Deck::files holds older content
  };
  std::mutex mutex;
  std::vector<File> files;  ///< as Deck::files
};

}  // namespace prismesh::mesh::deck
