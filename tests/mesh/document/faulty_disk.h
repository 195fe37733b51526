// The disk of these tests: calls go through it, so that each can be made to fail.
#pragma once

#include <atomic>

namespace prismesh::mesh::document {

/// Errors are errno's; 0: the call goes on to the system.
struct FaultyDisk {
  std::atomic<int> writes_left{-1};  ///< of whole pwrite calls before one fails; -1: none fails
  std::atomic<int> write_error{0};
  std::atomic<bool> short_write{false};   ///< the failing call first writes half
  std::atomic<int> read_error{0};         ///< of pread
  std::atomic<bool> ends_early{false};    ///< pread finds the end of the file
  std::atomic<int> sync_error{0};         ///< of fdatasync
  std::atomic<int> folder_sync_error{0};  ///< of fsync: new files and folders
  std::atomic<int> truncate_error{0};
  std::atomic<int> lock_error{0};
  std::atomic<int> link_error{0};
  std::atomic<int> rename_error{0};       ///< of rename, which replaces
  std::atomic<int> rename_new_error{0};   ///< of renameat2, which doesn't
  std::atomic<int> status_error{0};       ///< of fstat
  std::atomic<bool> other_device{false};  ///< fstat names another device than stat
  void mend();
};
extern FaultyDisk disk;

}  // namespace prismesh::mesh::document
