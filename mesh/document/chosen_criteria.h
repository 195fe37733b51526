// Reads criteria that the user chooses, together with their text. Private to mesh/document.
#pragma once

#include <filesystem>
#include <string>

#include "base/error.h"
#include "mesh/document/judging.h"

namespace prismesh::mesh::document {

/// Reads built-in criteria or a file, as quality::load_criteria does. `time_step_scale`: TSSFAC of the deck. Errors: those of
/// load_criteria.
Result<ChosenCriteria> load_chosen_criteria(const std::string& name, double time_step_scale);
/// The same from a text that is already read; `name` is what the user gave for it. Errors: as above; a text that is too long.
Result<ChosenCriteria> read_chosen_criteria(const std::string& name, std::string text, double time_step_scale);
/// The built-in default, which nobody chose.
ChosenCriteria default_choice(double time_step_scale);

/// Whether both have the same name and text.
bool is_same_choice(const ChosenCriteria& a, const ChosenCriteria& b);
/// `chosen`, or the same choice if `judging` has it already: parts that share criteria are judged alike.
ChosenCriteria shared_choice(const Judging& judging, ChosenCriteria chosen);

/// Where an edit or a settings file finds criteria: built-in ones by their name, a file relative to `folder`.
std::string criteria_place(const std::string& name, const std::filesystem::path& folder);

}  // namespace prismesh::mesh::document
