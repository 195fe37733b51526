// The settings file beside a deck, DECK.prismesh.toml: what its parts are judged by. Keys: docs/quality/criteria.md.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "mesh/document/document.h"
#include "mesh/document/generation.h"
#include "mesh/document/judging_rules.h"

namespace prismesh::mesh::document {

/// The settings file of a deck, by the deck's main file: its whole name with ".prismesh.toml" behind it, in the same folder.
std::filesystem::path deck_settings_path(const std::filesystem::path& deck);

/// Reads the rules of a settings file; none if there is no file. A criteria file is relative to the folder of `file`. Errors: those of
/// parse_deck_settings, the disk's.
Result<std::vector<JudgingRule>> read_deck_settings(const std::filesystem::path& file);
/// The same from text. Errors, with file and line: text that isn't TOML, an unknown key (with the nearest known one), a value of the wrong
/// type, a target size that is none.
Result<std::vector<JudgingRule>> parse_deck_settings(std::string_view text, const std::filesystem::path& file);

/// What the user chose, as the text of the settings file `file`. Reading it gives the same choices.
std::string deck_settings_text(const Generation& generation, const std::filesystem::path& file);
/// Whether the user chose anything: a target size or criteria of all parts or of some.
bool has_choices(const Generation& generation);
/// Writes the settings file of a deck that the document was saved as, if the document has such a file or an edit chose target sizes or
/// criteria.
/// Errors: the disk's.
Result<void> keep_deck_settings(const Document& document, const std::filesystem::path& saved_as);
/// Writes the settings file of a deck, whole or not at all. Without choices it is written only in place of another. Errors: the disk's.
Result<void> write_deck_settings(const Generation& generation, const std::filesystem::path& deck);

}  // namespace prismesh::mesh::document
