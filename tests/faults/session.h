// Sessions of edits and saves on a deck in a folder of its own, as the keeper of modeld runs them, and what must be left of them.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "daemon/modeld/document_keeper.h"

namespace prismesh::modeld::faults {

/// A temporary folder, in memory where the machine has one: `disk` is what calls are recorded of.
class Root {
 public:
  Root();
  ~Root();
  Root(const Root&) = delete;
  Root& operator=(const Root&) = delete;
  std::filesystem::path disk() const { return path_ / "disk"; }
  std::filesystem::path log() const { return path_ / "calls"; }
  std::filesystem::path copy() const { return path_ / "copy"; }

 private:
  std::filesystem::path path_;
};

/// A folder with a deck and a state folder.
struct Place {
  std::filesystem::path root;
  std::filesystem::path deck;
  std::filesystem::path state() const { return root / "state"; }
  DocumentKeeper keeper() const { return DocumentKeeper(StateFolder(state())); }
};

/// What a document is, in a form that can be compared: positions to a ten-thousandth, structure, selection, the parts' states.
std::string fingerprint(const DocumentKeeper& keeper);
/// The deck's files as they are on disk, by path.
std::map<std::string, std::string> deck_files(const Place& place);

/// "save", "undo" or an edit as JSON. Errors: refused.
Result<void> run_step(DocumentKeeper& keeper, const std::string& step);
Result<void> open_deck(DocumentKeeper& keeper, const Place& place);

struct Session {
  std::string name;
  std::function<std::filesystem::path(const std::filesystem::path&)> write_deck;  ///< into a folder; the main file
  std::vector<std::string> steps;
};
inline void PrintTo(const Session& session, std::ostream* out) { *out << session.name; }
/// Edits of all kinds; decks of one file, of several in folders of their own, packed; a repair.
const std::vector<Session>& sessions();

}  // namespace prismesh::modeld::faults
