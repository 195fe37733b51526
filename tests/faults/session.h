// Sessions of edits and saves on a deck in a folder of its own, as the keeper of modeld runs them, and what must be left of them.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <ostream>
#include <random>
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
using Files = std::map<std::string, std::string>;
/// The deck's files as they are on disk, by path.
Files deck_files(const Place& place);
/// Whether the decks on disk are those that were recorded. What a save elsewhere had begun to write may be there too.
bool holds(const Files& found, const Files& recorded, const Place& place);

/// The folder beside a deck that "save as" goes into.
inline constexpr const char* kSavedAs = "as";
inline constexpr const char* kOtherDeck = "other.k";
/// "save", "save as", "copy" (both to the other deck) or an edit as JSON. Errors: refused.
Result<void> run_step(DocumentKeeper& keeper, const std::string& step);
Result<void> open_deck(DocumentKeeper& keeper, const Place& place);
/// What was open in the last life; the place's deck, if nothing was.
Result<void> reopen_deck(DocumentKeeper& keeper, const Place& place);

/// Reads the other deck, if it is there, as any program that only reads does. Errors: it can't be read; it may be of two saves.
Result<void> read_other_deck(const Place& place);

struct Session {
  std::string name;
  std::function<std::filesystem::path(const std::filesystem::path&)> write_deck;  ///< into a folder; the main file
  std::vector<std::string> steps;
  bool by_chance = false;  ///< steps that are refused are left out
};
inline void PrintTo(const Session& session, std::ostream* out) { *out << session.name; }
/// Edits of all kinds; decks of one file, of several in folders of their own, packed; a repair; saves under another name, also over another
/// deck.
const std::vector<Session>& sessions();
/// Another one of the same kinds of steps on one of these decks.
Session session_by_chance(std::mt19937_64& random);

}  // namespace prismesh::modeld::faults
