// Sends the files of a model to a station and publishes them: in chunks with checksums, by tus 1.0.0, going on where a cut line left off.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/progress.h"
#include "ipc/remote/remote_station.h"
#include "ipc/store/local_files.h"

namespace prismesh::ipc::remote {

using store::LocalFile;

struct PushOptions {
  RemoteOptions remote;
  std::string name;  ///< for people; empty: that of the main file
  std::size_t chunk_bytes = std::size_t{4} << 20;
  Progress progress;
};

struct Pushed {
  ListedModel model;
  bool was_there = false;        ///< the station had the model already, and nothing was sent
  std::uint64_t sent_bytes = 0;  ///< of files, chunks that were sent twice included
};

/// `main`: the path of the main file, one of `files`. Uploads that were begun are noted in the book, and go on when it is called again.
/// Errors: a file can't be read, or changed meanwhile; a path that a model can't have; the line stays cut; the station refuses.
Result<Pushed> push(const StationBook& book, const PairedStation& station, const std::vector<LocalFile>& files, const std::string& main,
                    const PushOptions& options);

}  // namespace prismesh::ipc::remote
