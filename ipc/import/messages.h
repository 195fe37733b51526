// What prismesh-import is asked, and what it answers. One request on a connection. docs/protocol.md lists the messages.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "ipc/wire/answers.h"

namespace prismesh::ipc {

inline constexpr int kImportProtocol = 2;

/// What a process that reads a deck may use, and what is read of the deck, at most.
struct ImportLimits {
  std::uint64_t memory_bytes = std::uint64_t{8} << 30;  ///< address space, threads' stacks included
  std::uint64_t cpu_s = 300;                            ///< processor time, of all threads
  std::uint64_t files = 2000;
  std::uint64_t text_bytes = std::uint64_t{4} << 30;  ///< of all files, unpacked
  std::uint64_t nodes = 20'000'000;
  std::uint64_t elements = 20'000'000;
};

/// A file that is read in place of another one of the deck. Both are names in the main file's folder.
struct StandIn {
  std::string of;
  std::string file;
};

/// Reads one deck. Its descriptor: the folder of the main file.
struct Import {
  int protocol = 0;
  std::string main;          ///< the main file's name in the folder
  std::string shown_folder;  ///< stands for the folder in messages and in the deck's paths
  ImportLimits limits;
  std::vector<StandIn> stand_ins{};
};

/// Reads the deck once more and makes the text that an edited model of it needs. Its descriptors: the folder of the main file; what the
/// edits changed, in sealed memory (ipc/import/model_change.h).
struct Rewrite : Import {
  std::string content;  ///< Deck::content in hexadecimal digits: that of the deck that was edited
};

/// Its descriptor: the new text in sealed memory (ipc/import/text_hand_over.h).
struct Rewritten {
  std::vector<std::string> unguarded;  ///< as Imported::unguarded
};

/// Its descriptor: the deck in sealed memory (ipc/import/hand_over.h).
struct Imported {
  std::vector<std::string> unguarded;  ///< what this kernel can't forbid, as sentences; empty: nothing
};

/// Comes now and then before the answer.
struct ImportProgress {
  double fraction = 0;  ///< 0..1
};

using ImportRequest = std::variant<Import, Rewrite>;
using ImportAnswer = std::variant<Imported, Rewritten, Failed>;
using ImportEvent = std::variant<ImportProgress>;

}  // namespace prismesh::ipc
