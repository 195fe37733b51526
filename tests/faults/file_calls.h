// Records file calls below a folder with the data that they write, and makes chosen calls fail. The functions replace the C library's
// of the same name: linked into a test, or loaded into a whole program (file_calls_preload.cpp).
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace prismesh::test {

/// One call that changed something below the folder.
struct FileCall {
  enum class Kind : std::uint8_t {
    make,         ///< `path` came to be: a file with nothing in it
    make_folder,  ///< `path`
    write,        ///< `data` at `offset` of the file `inode`
    truncate,     ///< the file `inode` to `offset` bytes
    sync,         ///< the file `inode`
    sync_folder,  ///< `path`
    sync_all,
    rename,  ///< `path` to `other`
    link,    ///< `other` is the same file as `path`
    remove,  ///< `path`
    mark,    ///< of the test: `offset` is its number
  };
  Kind kind = Kind::mark;
  std::uint64_t inode = 0;
  std::uint64_t offset = 0;
  std::string path, other, data;
};

/// How a call fails. Calls are counted from 1, those that only read aside.
struct Failure {
  std::uint64_t at = 0;    ///< 0: none
  int error = 5;           ///< EIO
  bool for_ever = false;   ///< all that follow fail as well
  bool cut_short = false;  ///< the first write first writes half
};

/// Begins to record the calls below `folder` into a file of its own, and to let them fail.
void record_file_calls(const std::filesystem::path& folder, const std::filesystem::path& log, const Failure& failure = {});
void mark_file_calls(std::uint64_t number);
/// Calls that count, so far.
std::uint64_t counted_file_calls();
/// Ends the recording.
void stop_recording_file_calls();

/// Where PRISMESH_HANG_IN names this call, and the file PRISMESH_HANG_MARK is there, removes that file and never returns.
void hang_where_told(const char* call);

/// What a log holds. Errors end the test program: a log is the test's own.
std::vector<FileCall> read_file_calls(const std::filesystem::path& log);

}  // namespace prismesh::test
